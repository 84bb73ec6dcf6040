"""Row 2: rays to points. Knows no picture and no robot."""
