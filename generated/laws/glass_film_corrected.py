# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 0eb0ed7fc79702e35e06792ae3efca545a87893bc918b87d0bb0c447b1fc176e
"""glass law `film-corrected`: with the film's rim, 1/x^2 - 1/x0^2: zero at first touch.

Source: Donahue et al., J. Fluid Mech. 650, 479 (2010); derived from the film pressure.
"""

from __future__ import annotations

from typing import Any


def pressure(gap: Any, approach: Any) -> Any:
    """Film pressure on the axis over 3 mu a v0/x0^2.

    Total operations: 7
    """
    return -approach*(gap - 1)*(gap + 1)/gap**2
