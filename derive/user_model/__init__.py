"""A user's own laws and quantities, and the structures that include them."""
