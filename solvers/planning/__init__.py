"""Where the next impacts should be to learn most about a scene's entries."""
