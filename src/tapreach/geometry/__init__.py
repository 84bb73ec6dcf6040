"""Poses, cameras, rays, planar motion, arm kinematics. Imports numpy, scipy and the errors, nothing else."""
