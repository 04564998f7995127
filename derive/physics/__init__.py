"""The physics: mechanics, laws, partners, forces and scaling, and the structures that combine them."""
