# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 ebf75598b18a84fc77c8ba09a4de9b0ef0b2694ece643689dca90dfdec62f8a8
"""arm law `surface`: leading-order arm R = 2a: conserves angular momentum only to O(x/4a).

Source: Donahue, Davis, Kantak & Hrenya, Phys. Rev. E 86, 021303 (2012): leading order in the gap.
"""

from __future__ import annotations

from typing import Any


def lever(distance: Any) -> Any:
    """Arm over a: the sphere radius.

    Total operations: 0
    """
    return 2
