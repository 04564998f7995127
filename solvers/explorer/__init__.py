"""A page that opens from disk: the scene's law as WebAssembly, a map of outcomes and the moving doublet."""
