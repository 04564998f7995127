"""Symbolic derivation: from the Lagrangian of the doublet to nondimensional equations, and their emission as CasADi.

Pure sympy. Rooms: `quantities` (the vocabulary), `dimensions` (homogeneity walker), `mechanics` (Lagrangian),
`laws` (one law a file), `structure` and `model` (what a scene needs, and its equations), `scaling` (groups),
`checks` (what must hold), `emit` (source text).
"""
