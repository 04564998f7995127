# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 ac88d96cd2ec641649c695e6fa476d3387b10301055990231d35cbf4f32d8935
"""film law `infinite`: no film correction: the pressure of an unbounded film, which ends where the surfaces
leave it, x = x0.

Source: Davis, Rager & Good, J. Fluid Mech. 468, 107 (2002); derived: the limit x0 -> infinity of `finite`.
"""

from __future__ import annotations

from typing import Any


def resistance(gap: Any) -> Any:
    """Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1).

    Total operations: 1
    """
    return 1/gap
