"""Guided teach-in of servos, motors and encoders: the same lessons at a terminal and on the page."""
