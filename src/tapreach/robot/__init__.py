"""Row 2: what a robot is: interfaces, values, clock, robot file."""
