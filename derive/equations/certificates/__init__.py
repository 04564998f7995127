"""Stick certificates: margins that exclude separation, by attraction, by strings, by the orbital momentum."""
