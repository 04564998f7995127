"""Margins that prove a stick: by attraction, by strings, by the orbital angular momentum."""
