"""Checks of the derivation: dimensions, conservation laws, signs of losses, limits, groups, and certificates.

Every check works symbolically on the expressions that are emitted, or on the SI equations they derive from: a check
that passes holds for all values. `symbolic` runs them all.
"""
