"""What nature does: mechanics, laws, partners, forces and scaling, and which of them make a structure."""
