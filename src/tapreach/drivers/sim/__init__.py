"""The simulated robot: MuJoCo physics, a board like the real one, a camera with honest faults."""
