# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 932d19c493e9d982f26d99d8f6939d55c88bf99d269728fe7bec067c2c6916ba
"""film law `infinite`: no film correction: the pressure of an unbounded film, which ends where the surfaces
leave it, x = x0.

Source: Davis, Rager & Good, J. Fluid Mech. 468, 107 (2002); derived: the limit x0 -> infinity of `finite`.
"""

from __future__ import annotations

from typing import Any

from casadi import log


def resistance(gap: Any) -> Any:
    """Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1).

    Total operations: 1
    """
    return 1/gap


def stopping(gap: Any) -> Any:
    """Velocity, over v0/St, that the film takes from a doublet opening from this gap to x0.

    Total operations: 2
    """
    return -log(gap)


def braking(gap: Any) -> Any:
    """Velocity, over v0/St, that the film takes from an approach from x0 to this gap.

    Total operations: 2
    """
    return -log(gap)
