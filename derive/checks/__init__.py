"""Checks of the derivation: dimensions, conservation laws, signs of losses, limits, groups, and certificates.

Every check works symbolically on the expressions that are emitted, or on the SI equations they derive from: a check
that passes holds for all values. `symbolic_checks` runs them all.
"""

from collections.abc import Iterator, Mapping
from importlib import import_module

from ..equations.certificates.table import CERTIFICATES
from ..laws import LAWS, Law
from ..vocabulary.quantities import gap
from . import conservation, dissipation
from . import laws as law_limits
from .admission import Admission, certificate, certificates
from .attraction_certificate import force_falls
from .base import Check, checks_of, once

__all__ = ["Admission", "Check", "certificate", "symbolic_checks"]


def _of(*modules: str) -> Iterator[Check]:
    for name in modules:
        module = import_module(f".{name}", __package__)
        for check in checks_of(module.__name__):
            yield from once(check)


def symbolic_checks(laws: Mapping[str, Law] | None = None) -> Iterator[Check]:
    """Every check, in the order of the derivation, computed lazily.

    Arguments:
        laws: slot -> law of the scene in question; checks that depend on a law are restricted to it, and for all of
            the library's laws in a slot that is left out.
    """
    chosen = {slot: [law] for slot, law in (laws or {}).items()}
    film, shear, arm, strings = (chosen.get(s) or list(LAWS[s].values()) for s in ("film", "shear", "arm", "strings"))
    # these structures do not have a rim that depends on the gap; `laws.resistances` covers it
    rimmed = [law for law in film if law["resistance"].arguments == (gap,)]
    yield from conservation.strings_are_conservative(strings)
    yield from _of("dimensions", "conservation", "emitted")
    yield from dissipation.arms(arm, shear)
    yield from map(dissipation.film_dissipates, rimmed)
    yield from _of("dissipation", "limits")
    yield from law_limits.head_on_closed_form(rimmed)
    yield from law_limits.film_ends(rimmed, shear)
    yield from law_limits.long_strings_vanish(strings)
    yield from force_falls([*film, *shear], last=1)  # inside the film
    proved = [name for row in CERTIFICATES for name in row.checks]
    yield from _of(*dict.fromkeys(("laws", "restitution", *proved, "slow_manifold", "enclosure", "partners", "space")))
    yield from certificates(laws)
