# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 6b3272e96508125119537f053c024f8c88a4bcdc8de03051a220f4a29a137b9f
"""film law `cavitating`: `finite` on approach; on rebound the liquid sustains no suction and cavitates, which
leaves no force.

Source: Barnocky & Davis, Phys. Fluids 31, 1324 (1988); derived: the pressure cut off at ambient.
"""

from __future__ import annotations

from typing import Any


def resistance(gap: Any) -> Any:
    """Normal film force over 6 pi mu a^2 u/x0 while closing, for a gap inside the film (gap < 1).

    Total operations: 3
    """
    return (gap - 1)**2/gap


def suction(gap: Any) -> Any:
    """What of the resistance is left while opening.

    Total operations: 0
    """
    return 0
