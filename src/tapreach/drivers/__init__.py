"""What moves: one package for each kind of robot."""
