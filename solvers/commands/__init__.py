"""The commands, one a file: each checks its options first, and imports what it needs when it runs."""
