"""Row 4: what the robot does by itself: locate, the guided two-tap, the floor guess."""
