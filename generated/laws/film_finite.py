# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 86292dc2d3ab7eaf695949e7c560a4b034ffe87a63955fef301acdb07da38acb
"""film law `finite`: Reynolds film of finite thickness, the same on approach and rebound (no cavitation).

Source: Kantak & Davis, Powder Technol. 168, 42 (2006); derived: pressure integrated over the disc h < x0.
"""

from __future__ import annotations

from typing import Any

from casadi import log


def resistance(gap: Any) -> Any:
    """Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1).

    Total operations: 3
    """
    return (gap - 1)**2/gap


def stopping(gap: Any) -> Any:
    """Velocity, over v0/St, that the film takes from a doublet opening from this gap to x0.

    Total operations: 8
    """
    return 2*gap - gap**2/2 - log(gap) - 1.5


def braking(gap: Any) -> Any:
    """Velocity, over v0/St, that the film takes from an approach from x0 to this gap.

    Total operations: 8
    """
    return 2*gap - gap**2/2 - log(gap) - 1.5
