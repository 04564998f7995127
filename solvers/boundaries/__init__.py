"""Where an outcome changes: brackets on lines, slopes, curves and atlases; and outcomes that are proved around them."""
