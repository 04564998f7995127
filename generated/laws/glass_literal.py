# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 cbe29fa6b784a9433b151f8a5c6c8a7a624f3bd19d59c86ae0f66c0c4662e956
"""glass law `literal`: 3 mu a |u|/x^2 as published: can fire at initial contact.

Source: Donahue et al., J. Fluid Mech. 650, 479 (2010); derived from the film pressure.
"""

from __future__ import annotations

from typing import Any

from casadi import sqrt


def pressure(gap: Any, approach: Any) -> Any:
    """Film pressure on the axis over 3 mu a v0/x0^2.

    Total operations: 2
    """
    return approach/gap**2


def reach(approach: Any, glass_number: Any) -> Any:
    """Gap at which this approach speed meets the criterion.

    Total operations: 5
    """
    return sqrt(approach)/sqrt(glass_number)
