# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 65965dd50dc370d4842c75fd5a6ccbc44f4efc56a9a0e6d664ea511b5dbe2c49
"""attraction law `van-der-waals`: van der Waals attraction of nearly touching spheres, neither retarded nor cut
off.

Source: Hamaker, Physica 4, 1058 (1937); Derjaguin, Kolloid-Z. 69, 155 (1934).
"""

from __future__ import annotations

from typing import Any


FALLS = True


def force(gap: Any) -> Any:
    """Attraction over A a/(6 x0^2).

    Total operations: 2
    """
    return 1/gap**2


def potential(gap: Any) -> Any:
    """Potential energy over A a/(6 x0), zero far away.

    Total operations: 2
    """
    return -1/gap
