# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 6d11af5a4eb759126b87121372f56726cdbf140445c2d2fb878fdfaea4ffa230
"""glass law `literal`: 3 mu a |u|/x^2 as published: can fire at first touch.

Source: Donahue et al., J. Fluid Mech. 650, 479 (2010); derived from the film pressure.
"""

from __future__ import annotations

from typing import Any


def pressure(gap: Any, approach: Any) -> Any:
    """Film pressure on the axis over 3 mu a v0/x0^2.

    Total operations: 2
    """
    return approach/gap**2
