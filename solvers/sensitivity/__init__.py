"""Exact derivatives of a collision's results and of boundaries; uncertainty and global sensitivity based on them."""
