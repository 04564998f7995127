"""The stick certificate: its energy is the least there is at fixed angular momentum, and its slope that energy's."""

from __future__ import annotations

import sympy as sp

from ..model import derive
from ..quantities import aspect, gap, obliquity, opening, orbit, spin
from ..structure import structures
from .base import Check, vanishing
from .closed import slope_along


def least_energy() -> Check:
    """The certificate's energy is L^2/(2 I) (and U_s), and its slope that energy's, at fixed L, and the bridge's."""
    left = []
    for structure in structures():
        model = derive(structure)
        if "effective_potential" not in [function.name for function in model.functions]:
            continue
        outputs = dict(model["effective_potential"].outputs)
        value, slope = model.expanded(outputs["energy"]), model.expanded(outputs["slope"])
        momentum = sp.Symbol("L", positive=True)  # over m a^2 omega0
        inertia = (4 + aspect * gap) ** 2 + sp.Rational(32, 5)
        expected: sp.Expr = sp.Integer(0)
        change: sp.Expr = sp.Integer(0)
        if structure.oblique:
            own = orbit + sp.Rational(32, 5) * spin if not structure.reduced else (4 + aspect) ** 2
            fixed = momentum**2 * obliquity**2 / (32 * inertia)  # omega0 = v0 tan(theta0)/(4a)
            expected += fixed.subs(momentum, own)
            change += fixed.diff(gap).subs(momentum, own)
        if structure.strings:
            stored = model.expanded(dict(model["energies"].outputs)["strings"])
            expected += stored
            change += slope_along(stored, gap)
        if structure.bridge:
            work = dict(model["energy_rates"].outputs)["capillary"]
            change += model.expanded(work) / opening
        left += [value - expected, slope - change]
    return vanishing("stick certificate", "slope = d/dx [L^2/(2 I(x)) + U_s(x) + W_c(x)] at fixed L", left)
