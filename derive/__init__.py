"""Symbolic derivation: from the Lagrangian of the doublet to nondimensional equations, and their emission as CasADi.

Pure sympy. Rooms: `quantities` (the vocabulary), `dimensions` (homogeneity walker), `mechanics` (Lagrangian),
`laws` (one law a file), `structure` (what a scene needs), `scaling` (groups), `forces`, `intermediates`, `rates`,
`events` and `observables` (the parts of its equations), `model` (all of them together), `checks` (what must hold),
`emit` (source text).
"""
