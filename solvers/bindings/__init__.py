"""The collision law in other people's programs: jax and torch."""
