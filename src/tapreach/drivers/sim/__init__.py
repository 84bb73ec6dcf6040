"""The simulated robot: MuJoCo physics and rendering in a process of its own."""
