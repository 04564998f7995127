"""A user's own laws and quantities, and the structures that they make."""
