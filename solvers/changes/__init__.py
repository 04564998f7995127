"""Where an outcome changes along lines: brackets, roots, normals of the boundary and slopes by a scene's entries."""
