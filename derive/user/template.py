"""The template of a model file, itself a valid model."""

TEMPLATE = '''\
"""A bridge with a yield stress: Willett's closed form, and a stress that acts over the neck of the bridge.

Change it, then: wetdoublet generate THIS.py --out DIR; wetdoublet collide granulation --model DIR
"""

from wetdoublet.derive.user import *

# A quantity that scenes may fill:  [custom]  yield_stress = "50 Pa"   or  --set custom.yield_stress="50 Pa"
stress = quantity(
    "yield_stress", r"\\tau_y", unit="Pa", default="20 Pa", bounds=">= 0", meaning="yield stress of the liquid"
)

# SI symbols: x gap, a = R/2, R, r = 4a + x, m, mu, sigma, x0, u, v0, ...; V = volume/R^3, phi contact angle.
# `let` gives a part a name, which emitted code and printed equations keep.
S = let("scaled_gap", x / R / sqrt(V), latex="S")
capillary_force = pi * R * sigma * 2 * cos(phi) / (1 + 1.05 * S + 2.5 * S**2)
neck = pi * R**2 * sqrt(V)

# A slot takes a law: its functions in SI, or without dimension in the slot's own arguments (h = x/R, gap = x/x0).
law(
    "bridge",
    "yielding",
    meaning="willett-simple and a yield stress over the neck of the bridge",
    source="illustration: not a published law",
    force=capillary_force + stress * neck * exp(-S),
)
'''
