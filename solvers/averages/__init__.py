"""Collision averages: outcomes and restitution averaged over impact geometry and speeds, for each pair of sizes."""
