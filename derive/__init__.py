"""Symbolic derivation: from the Lagrangian of the doublet to nondimensional equations, and their emission as source.

Pure sympy. `vocabulary`: quantities, their dimensions and allowed values. `physics`: mechanics, laws (one a file),
partners, structures and scaling. `equations`: those of a structure, from intermediates and rates to certificates.
`user`: a user's laws and events. `checks`: what must hold of all of them. `emit`: Python with CasADi, C, and
documents.
"""
