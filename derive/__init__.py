"""Symbolic derivation: from the Lagrangian of the doublet to nondimensional equations, and their emission as source.

Pure sympy. `vocabulary`: quantities, their dimensions and allowed values. `physics`: mechanics, partners, slots,
structures and scaling. `equations`: those of a structure, from intermediates and rates to certificates. `user`: what
laws and events are declared with. `laws`: the library's. `checks`: what must hold of all of them. `emit`: Python with
CasADi, C, and documents.
"""
