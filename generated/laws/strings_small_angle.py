# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 729e9598df0ad609d580de2d389e5c61e218978839e940d03b65919437c8936c
"""strings law `small-angle`: linearised in the swing: sqrt(l^2 - d^2) -> l.

Source: Donahue, Brewer, Davis & Hrenya, J. Fluid Mech. 708, 128 (2012): vertical tension balances the weight.
"""

from __future__ import annotations

from typing import Any


def rise(string_ratio: Any, offset_squared: Any) -> Any:
    """Height gained by each sphere over a.

    Total operations: 2
    """
    return offset_squared/(2*string_ratio)


def stiffness(string_ratio: Any, offset_squared: Any) -> Any:
    """Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2).

    Total operations: 1
    """
    return 1/string_ratio
