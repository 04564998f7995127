"""All checks, in the order of the derivation, as proofs that are yet to be made."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from ..emit.provenance import digest, law_digest
from ..equations.certificates.table import CERTIFICATES
from ..laws import LAWS, Law
from ..vocabulary.quantities import gap
from . import conservation, dissipation
from . import laws as law_limits
from .admission import DEFAULTS, certificates
from .attraction_certificate import force_falls
from .base import Check, checks_of, once


@dataclass(frozen=True)
class Proof:
    """A function that gives one or several checks, and the laws or gaps that it is asked about."""

    function: Callable[..., Check | Iterable[Check]]
    arguments: tuple[Any, ...] = ()

    def checks(self) -> tuple[Check, ...]:
        """The checks, computed."""
        if not self.arguments:
            return once(self.function)
        result = self.function(*self.arguments)
        return (result,) if isinstance(result, Check) else tuple(result)

    @property
    def digest(self) -> str:
        """Digest of the function's name and of the mathematics of what it is asked about."""
        return digest(self.function.__module__, self.function.__qualname__, _identity(self.arguments))


def _identity(argument: object) -> str:
    if isinstance(argument, tuple):
        return f"({', '.join(map(_identity, argument))})"
    return law_digest(argument) if isinstance(argument, Law) else str(argument)


def proofs(laws: Mapping[str, Law] | None = None) -> Iterator[Proof]:
    """The proofs of every check.

    Arguments:
        laws: slot -> law of the scene in question; checks that depend on a law are restricted to it, and for all of
            the library's laws in a slot that is left out.
    """
    chosen = laws or {}
    film, shear, arm, strings = (
        [chosen[slot]] if slot in chosen else list(LAWS[slot].values()) for slot in ("film", "shear", "arm", "strings")
    )
    # these structures do not have a rim that depends on the gap; `laws.resistances` covers it
    rimmed = [law for law in film if law["resistance"].arguments == (gap,)]
    yield from (Proof(conservation.strings_are_conservative, ((law,),)) for law in strings)
    yield from _of("dimensions", "conservation", "emitted")
    for lever in arm:
        yield Proof(dissipation.angular_momentum, (lever,))
        yield from (Proof(dissipation.shear_dissipates, (law, lever)) for law in shear)
    yield from (Proof(dissipation.film_dissipates, (law,)) for law in rimmed)
    yield from _of("dissipation", "limits")
    yield from (Proof(law_limits.head_on_closed_form, ((law,),)) for law in rimmed)
    yield from (Proof(law_limits.film_ends, ((law,), ())) for law in rimmed)
    yield from (Proof(law_limits.film_ends, ((), (law,))) for law in shear)
    yield from (Proof(law_limits.long_strings_vanish, ((law,),)) for law in strings)
    yield from (Proof(force_falls, ((law,), 1)) for law in (*film, *shear))  # inside the film
    proved = [name for row in CERTIFICATES for name in row.checks]
    yield from _of(*dict.fromkeys(("laws", "restitution", *proved, "slow_manifold", "enclosure", "partners", "space")))
    yield Proof(certificates, tuple(chosen[slot] for slot in DEFAULTS if slot in chosen))


def _of(*modules: str) -> Iterator[Proof]:
    yield from map(Proof, checks_of(*(import_module(f".{name}", __package__).__name__ for name in modules)))
