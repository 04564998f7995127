# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 404c66e8ca8e03f9871f28116257f38724bd193d38f93f8376c5aef4a0297ee7
"""arm law `midgap`: the tangential force acts at mid-gap, arm = r/2: conserves angular momentum identically.

Source: torque balance of the film about the centre of mass.
"""

from __future__ import annotations

from typing import Any


def lever(distance: Any) -> Any:
    """Arm over a, from the centre distance r/a.

    Total operations: 1
    """
    return distance/2
