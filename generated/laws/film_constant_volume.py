# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 a430aabd969769af724920fcf170876eeca85525172622c2053e36559a66508f
"""film law `constant-volume`: the rim follows the bridge's liquid, H = sqrt(x^2 + V_b/(pi a)) in place of x0, at
any gap.

Source: Pitois, Moucheront & Chateau, J. Colloid Interface Sci. 231, 26 (2000); derived: a disc of that
volume.
"""

from __future__ import annotations

from typing import Any

from casadi import pi, sqrt


def resistance(gap: Any, aspect: Any, volume: Any) -> Any:
    """Normal film force over 6 pi mu a^2 u/x0.

    Total operations: 13
    """
    rim = sqrt(gap**2 + 8*volume/(pi*aspect**2))
    return (gap - rim)**2/(gap*rim**2)
