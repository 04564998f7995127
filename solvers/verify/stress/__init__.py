"""The stress run: all engines held against each other on random scenes."""
