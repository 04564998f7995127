"""Flags with which tests compile C."""

CALLS = "-Dalways_inline="
"""Functions of a kernel are called, not copied to where they are called: compiled in less than half the time."""
QUICK = f"-O0 {CALLS}"
"""Without optimization: the same results but for rounding."""
OPTIMIZED = "-Og -fno-inline -fno-unroll-loops"
"""Compiled in three times the time, and four times as fast: for tests of many thousand collisions by few kernels."""
