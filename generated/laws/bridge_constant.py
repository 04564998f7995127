# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 988fad14ceb4ba2b64e33003ca6e9c5bdce6a9c48e4b863af76eba9f944427a2
"""bridge law `constant`: gap-independent upper bound, the force at contact.

Source: Derjaguin, Kolloid-Z. 69, 155 (1934): 2 cos(phi), the limit at h = 0.
"""

from __future__ import annotations

from typing import Any

from casadi import cos


FALLS = True


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 2
    """
    return 2*cos(contact_angle)
