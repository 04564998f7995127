"""A small model file that tests share."""

# A law in fewer than thirty lines: Mikami's, written as the library has it, and a yield stress over the neck.
LAW = '''"""Mikami's bridge whose liquid yields."""
from wetdoublet.derive.user import *

stress = quantity("yield_stress", r"\\tau_y", unit="Pa", default="0 Pa", bounds=">= 0", meaning="yield stress")
K = let("logarithm", log(V))
A = let("slope", -1.1 * V**-0.53)
B = let("rise", (-0.34 * K - 0.96) * phi**2 - 0.019 * K + 0.48)
C = let("rest", 0.0042 * K + 0.078)
mikami = pi * R * sigma * (exp(A * h + B) + C)
law("bridge", "yielding", force=mikami + stress * pi * R**2 * sqrt(V) * exp(-h / sqrt(V)), source="a test")
law("bridge", "plain", force=exp(A * h + B) + C, source="Mikami, Kamiya & Horio (1998)")
'''
