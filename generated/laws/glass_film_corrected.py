# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 36672a25b05cedaf9402710ddff628c5d822f6dfebbc6669f339bce1e845eb3b
"""glass law `film-corrected`: with the film's rim, 1/x^2 - 1/x0^2: zero at initial contact.

Source: Donahue et al., J. Fluid Mech. 650, 479 (2010); derived from the film pressure.
"""

from __future__ import annotations

from typing import Any

from casadi import sqrt


def pressure(gap: Any, approach: Any) -> Any:
    """Film pressure on the axis over 3 mu a v0/x0^2.

    Total operations: 7
    """
    return -approach*(gap - 1)*(gap + 1)/gap**2


def reach(approach: Any, glass_number: Any) -> Any:
    """Gap at which this approach speed meets the criterion.

    Total operations: 6
    """
    return sqrt(approach)/sqrt(approach + glass_number)
