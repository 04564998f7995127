# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 8d9c64ecb385998c2c8e00fa79beaf31b68745051a17bab0aeff4e213f05290a
"""film law `constant-volume`: the rim follows the bridge's liquid, H = sqrt(x^2 + V_b/(pi a)) in place of x0, at
any gap.

Source: Pitois, Moucheront & Chateau, J. Colloid Interface Sci. 231, 26 (2000); derived: a disc of that
volume.
"""

from __future__ import annotations

from typing import Any

from casadi import log, pi, sqrt


def resistance(gap: Any, aspect: Any, volume: Any) -> Any:
    """Normal film force over 6 pi mu a^2 u/x0.

    Total operations: 13
    """
    rim = sqrt(gap**2 + 8*volume/(pi*aspect**2))
    return (gap - rim)**2/(gap*rim**2)


def braking(gap: Any, aspect: Any, volume: Any) -> Any:
    """Velocity, over v0/St, that the film takes from an approach from x0 to this gap.

    Total operations: 35
    """
    rim = sqrt(gap**2 + 8*volume/(pi*aspect**2))
    result = (
        - log(gap)
        - log(rim)
        + log(sqrt(1 + 8*volume/(pi*aspect**2)))
        + 2*log(gap + rim)
        - 2*log(sqrt(1 + 8*volume/(pi*aspect**2)) + 1)
    )
    return result
