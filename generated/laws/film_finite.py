# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 9b66da56ca31df20e0735dd2715e9031e78a2c8b43f45ddec99f1e1031fbb191
"""film law `finite`: Reynolds film of finite thickness, the same on approach and rebound (no cavitation).

Source: Kantak & Davis, Powder Technol. 168, 42 (2006); derived: pressure integrated over the disc h < x0.
"""

from __future__ import annotations

from typing import Any


def resistance(gap: Any) -> Any:
    """Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1).

    Total operations: 3
    """
    return (gap - 1)**2/gap
