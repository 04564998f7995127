"""Terms that a model file adds to the equations of motion: energies, and generalised forces on the coordinates."""

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from ..vocabulary.quantities import beta, omega, u, x, x0, xi
from . import mechanics

VELOCITIES = {"gap": u, "rotation": omega, "spin": xi}
"""The coordinates that a force may act on, and their velocities; that of the spin turns both spheres alike."""
STILL: dict[sp.Symbol, sp.Expr] = dict.fromkeys((omega, xi, beta), sp.Integer(0))
"""Head-on, nothing turns."""


@dataclass(frozen=True)
class Terms:
    """Energies and generalised forces in SI, of x, u, omega, xi, beta and of what does not vary.

    Arguments:
        kinetic: a sum of squares of u, omega and xi with factors of x and beta.
        potential: of x and beta.
        forces: on a coordinate of VELOCITIES, by virtual work: N on the gap, N m on the others.
        groups: what is in them beside the vocabulary.
    """

    kinetic: sp.Expr
    potential: sp.Expr
    forces: tuple[tuple[str, sp.Expr], ...]
    groups: tuple[sp.Symbol, ...] = ()

    @cached_property
    def parts(self) -> dict[str, tuple[sp.Expr, sp.Expr]]:
        """Inertia and force that they add to the equation of motion of each coordinate."""
        work = dict(zip(mechanics.coordinates(), (dict(self.forces).get(on, sp.S.Zero) for on in VELOCITIES)))
        return dict(zip(VELOCITIES, mechanics.added(self.kinetic - self.potential, work).values(), strict=True))

    @property
    def symbols(self) -> set[sp.Basic]:
        """The symbols of energies and forces."""
        return set().union(*(e.free_symbols for e in (self.kinetic, self.potential, *(f for _, f in self.forces))))

    @property
    def power(self) -> sp.Expr:
        """The power of the forces."""
        return sp.Add(*(force * VELOCITIES[on] for on, force in self.forces))

    @property
    def stored(self) -> sp.Expr:
        """The energies, their potential over that at initial contact."""
        return self.kinetic + self.potential - self.potential.subs({x: x0, beta: 0})

    @property
    def rotates(self) -> bool:
        """They speak of a rotation: the angular momentum is not the spheres', or not conserved."""
        return bool(self.symbols & {*STILL} or dict(self.forces).keys() - {"gap"})

    @property
    def drives(self) -> bool:
        """They turn what does not turn, so that a head-on collision does not stay one."""
        return any(sp.simplify(force.subs(STILL)) != 0 for _, force in (self.parts["rotation"], self.parts["spin"]))

    @property
    def takes(self) -> bool:
        """The forces are shown to never give energy."""
        power = sp.factor(sp.simplify(self.power))
        return bool(power == 0 or power.is_nonpositive)

    @property
    def admits_barrier(self) -> bool:
        """What remains of the energy decides which gaps can be passed, at the conserved angular momentum."""
        return not self.rotates and self.takes
