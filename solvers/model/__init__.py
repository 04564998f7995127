"""The emitted modules of a scene, its phases and its dimensionless groups."""
