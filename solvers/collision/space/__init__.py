"""Collisions in space: any velocities and spins of two spheres, or of a sphere and a wall."""
