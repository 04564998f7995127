"""The commands. Each checks its options first and imports what it needs only when it runs."""
