"""A stick certificate: the structures that it covers, its margins, and the inequalities that exclude separation."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from ...physics.law import Definition
from ...physics.structure import Structure

Functions = Iterator[tuple[str, str, Mapping[str, sp.Expr]]]
"""Name, docstring and outputs of the functions that a certificate emits."""
Enclosed = tuple[sp.Expr, sp.Expr, tuple[Definition, ...]]
"""Energy that may carry a state to a larger gap, what that gap needs of it, and definitions of their own."""


@dataclass(frozen=True)
class Proof:
    """An inequality between margins of the structures, the state and `margin`, their relative error.

    The kernel has it as a function of the quantities in it. A comparison with NaN is false.
    """

    name: str
    meaning: str
    test: str


@dataclass(frozen=True)
class Certificate:
    """A row of the table of certificates, of which kernel, enclosures, checks and the page on certificates are made.

    Arguments:
        name: the kernel has NAME_MARGINS, whether its margins are compiled.
        meaning: what holds the doublet.
        proofs: its inequalities.
        checks: the modules of `derive.checks` that prove its steps.
        admits: the structures that have margins; without it, the inequalities compare what the kernel has anyway.
        definitions: named intermediates of the margins, in order.
        functions: the margins.
        premises: what of the laws, as the kernel's macros name it, has to be there besides the functions called.
        enclosed: the energies that the enclosing engine compares, where it has this certificate.
        library_only: its margins are bounds for the library's laws only.
    """

    name: str
    meaning: str
    proofs: tuple[Proof, ...]
    checks: tuple[str, ...]
    admits: Callable[[Structure], bool] = lambda _: False
    definitions: Callable[[Structure], tuple[Definition, ...]] = lambda _: ()
    functions: Callable[[Structure], Functions] = lambda _: iter(())
    premises: Callable[[Structure], tuple[str, ...]] = lambda _: ()
    enclosed: Callable[[Structure], Enclosed] | None = None
    library_only: bool = False
