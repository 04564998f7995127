# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 7edea584b84bd0542e44786e4e9d8fab3b1b90daa8d4e420aeab9cddab86c0bc
"""strings law `exact`: strings of length l, exact geometry.

Source: Donahue, Brewer, Davis & Hrenya, J. Fluid Mech. 708, 128 (2012): vertical tension balances the weight.
"""

from __future__ import annotations

from typing import Any

from casadi import sqrt


def rise(string_ratio: Any, offset_squared: Any) -> Any:
    """Height gained by each sphere over a.

    Total operations: 6
    """
    return offset_squared/(string_ratio + sqrt(string_ratio**2 - offset_squared))


def stiffness(string_ratio: Any, offset_squared: Any) -> Any:
    """Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2).

    Total operations: 5
    """
    return 1/sqrt(string_ratio**2 - offset_squared)
