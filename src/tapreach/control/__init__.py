"""Row 3: who may move the robot, and how fast."""
