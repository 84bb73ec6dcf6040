"""Guided teach-in of a real robot's servos, motors and encoders."""
