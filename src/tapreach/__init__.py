"""Tap a thing in a robot's live picture and get its 3D position with an honest error bar."""
