# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 6f2ed032119240a2f997e30e5132098d6c65deec3cc8f3c5b34927356fdc80eb
"""film law `cavitating`: `finite` on approach; on rebound the liquid sustains no suction and cavitates, which
leaves no force.

Source: Barnocky & Davis, Phys. Fluids 31, 1324 (1988); derived: the pressure cut off at ambient.
"""

from __future__ import annotations

from typing import Any

from casadi import log


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


def braking(gap: Any) -> Any:
    """Velocity, over v0/St, that the film takes from an approach from x0 to this gap.

    Total operations: 8
    """
    return 2*gap - gap**2/2 - log(gap) - 1.5
