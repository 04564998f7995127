"""Exact derivatives of a collision's results through its events, of its boundaries, and what is drawn from them."""
