"""Conservation: angular momentum and energy along the emitted equations, for all laws."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ..forces import force_laws
from ..laws import LAWS, Law, strings
from ..mechanics import F_t
from ..model import derive
from ..quantities import a, m, omega0, orbit, spin, v0, x, x0
from ..scaling import nondimensional
from ..structure import Structure, structures
from .base import Check, vanishing
from .closed import emitted_rates, filled, slope_along

_FULL = tuple(structure for structure in structures() if not structure.reduced)
_FREE_SPINNING = tuple(s for s in _FULL if s.oblique and not s.strings)  # where nothing exerts a torque


def momentum_rate(structure: Structure, laws: Mapping[str, Law]) -> sp.Expr:
    """d/dtau of orbit + (32/5) spin, the angular momentum over m a^2 omega0, along the emitted right-hand side."""
    rates = emitted_rates(derive(structure))
    return sp.factor(sp.expand(filled(rates[orbit] + sp.Rational(32, 5) * rates[spin], laws)))


def angular_momentum() -> tuple[Check, ...]:
    """Without strings the midgap arm conserves L identically; the surface arm loses x F_t."""
    arms = LAWS["arm"]
    conserved, surface = [], []
    for structure in _FREE_SPINNING:
        conserved.append(momentum_rate(structure, {"arm": arms["midgap"]}))
        for name in LAWS["shear"]:
            tangential = {"shear": LAWS["shear"][name]}
            conserved.append(momentum_rate(structure, {"arm": arms["midgap"], **tangential}))
            lost = nondimensional(-x * force_laws()[F_t] * x0 / (v0 * m * a**2 * omega0))
            found = momentum_rate(structure, {"arm": arms["surface"], **tangential})
            surface.append(found - derive(structure).expanded(filled(lost, tangential)))
    return (
        vanishing(
            "angular momentum, midgap arm", "dL/dt = 0 without strings, for every tangential and bridge law", conserved
        ),
        vanishing(
            "angular momentum, surface arm",
            "dL/dt = -x F_t without strings",
            surface,
            "dL/dt = -x F_t: a known violation of the leading-order arm",
        ),
    )


def energy_balance(structure: Structure) -> sp.Expr:
    """d/dtau of the emitted energies plus the emitted energy_rates, for any laws (and either arm)."""
    model = derive(structure)
    stored = [model.expanded(expression) for _, expression in model["energies"].outputs]
    total = sum(
        (slope_along(each, state) * rate for state, rate in emitted_rates(model).items() for each in stored),
        sp.Integer(0),
    )
    lost = sum((model.expanded(expression) for _, expression in model["energy_rates"].outputs), sp.Integer(0))
    return sp.factor(sp.expand(strings.half_angles(total + lost)))


def energy() -> tuple[Check, ...]:
    """Mechanical energy is taken by the film, the shear and the bridge, and by nothing else; strings give back."""
    return tuple(
        vanishing(
            f"energy: {structure.name}",
            "d(kinetic + strings)/dt = -(film + shear + bridge power), for all laws and both arms",
            [energy_balance(structure)],
        )
        for structure in _FULL
    )
