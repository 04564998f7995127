"""Where the outcome changes: lines, curves and atlases."""
