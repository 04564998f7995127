"""The budget of e_n^2 - 1: what the motion along the line of centres is given, and what is taken from it.

The kinetic energy is m u^2/2 + L^2/(2 I(x)) + K: of the motion along the line of centres, of rigid rotation with the
angular momentum L, I(x) = m r^2 + I_1 + I_2, and of the slip of the spheres on each other. With the losses and works of
the ledger, and all in units of the initial normal energy m v0^2/2,

    e_n^2 - 1 = [L^2/(2 I)]_0 - [L^2/(2 I)]_f + K_0 - K_f - losses - works

so that e_n > 1 where more energy of rotation is released, as I(x) grows, than is lost. Beside a wall no line of centres
turns: there the energy of sliding and rolling takes the place of the two terms.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import STICK
from ..host.pictures import Drawn
from ..results import DEFINITIONS
from ..scene.scene import Scene
from .outcome import Outcome

if TYPE_CHECKING:
    import xarray

_OVER = "/(m v0^2)"
FORMULAS = {
    "rigid_rotation": f"[L0^2/I(x0) - L^2/I(x_f)]{_OVER}, I(x) = m r^2 + I_1 + I_2",
    "slip": f"2 [K(0) - K(t_f)]{_OVER}, K = T - m u^2/2 - L^2/(2 I)",
    "sliding": f"2 [K(0) - K(t_f)]{_OVER}, K = m V^2/2 + I_1 xi^2/2",
    "normal_lubrication": f"-2 int F_n u dt{_OVER}",
    "tangential_lubrication": f"-2 int F_t s dt{_OVER}, s the slip of the surfaces",
    "dry_contact": "-sum of (1 - e_dry^2) u^2/v0^2 at the rebounds",
    "dry_friction": f"-2 D{_OVER}, D lost by friction of the solids",
    "capillary": f"-2 int F_c u dt{_OVER}",
    "attraction": f"-2 int F_a u dt{_OVER}",
    "strings": f"-2 [U_s(t_f) - U_s(0)]{_OVER}",
    "own_events": f"-2 D{_OVER}, D taken by their jumps",
    "own_terms": f"-2 [E(t_f) - E(0)]{_OVER} - 2 int P dt{_OVER}, P taken by the forces",
    "residual": "the error of the integration",
}
_TURNING = {"rigid_rotation": "rigid rotation", "slip": "slip", "sliding": "sliding and rolling"}
NONE = "no budget of e_n^2 - 1: a stick never separates, so that it has no e_n"
_LABEL = 24


class Budget(tuple[tuple[str, float], ...], Drawn):
    """Pairs of a term and its share of the initial normal energy, which sum to e_n^2 - 1; empty for a stick.

    `str` is the table of `collide --why`; `plot` draws L and the terms over time, of a collision with its trajectory.
    """

    _picture = "collision.plot.budget.draw"

    collision: Outcome

    def __new__(cls, collision: Outcome) -> Budget:
        """The budget of a collision that has its ledger."""
        pairs = () if collision.outcome == STICK else _shares(collision)
        budget = super().__new__(cls, pairs)
        budget.collision = collision
        return budget

    def __reduce__(self) -> tuple[Any, ...]:
        return Budget, (self.collision,)

    def __str__(self) -> str:
        if not self:
            return NONE
        from .text import quantity

        unit = quantity(self.collision.scene.reduced_mass * self.collision.speed**2 / 2, "J")
        total = self.collision.restitution**2 - 1
        lines = [f"why e_n^2 - 1 = {total:.4g}, in the initial normal energy m v0^2/2 = {unit}"]
        for name, share in self:
            digits = 1 if name == "residual" else 4
            lines.append(f"  {label_of(name):<{_LABEL - 2}}{share:>11.{digits}g}  {FORMULAS[name]}")
        given, taken = (math.fsum(share for _, share in self[:-1] if share * sign > 0) for sign in (1, -1))
        why = f"e_n {'>' if total > 0 else '<'} 1: {given:.4g} given, {-taken:.4g} taken"
        return "\n".join([*lines, f"  {'sum':<{_LABEL - 2}}{total:>11.4g}  {why}"])


def label_of(name: str) -> str:
    """A term in words."""
    return _TURNING.get(name) or DEFINITIONS[f"energy.{name}"].short


def _shares(collision: Outcome) -> Iterable[tuple[str, float]]:
    energy, scene = collision.energy, collision.scene
    assert energy is not None
    unit = scene.reduced_mass * collision.speed**2 / 2
    spent = {name: value for name, value in collision.terms.items() if name in FORMULAS}
    turning = energy.initial - energy.final - unit * (1 - collision.restitution**2)
    if scene.turns(collision.angle):
        spins = collision.final_spin or 0.0, collision.final_spin_partner
        assert collision.final_gap is not None
        last = rigid_energy(scene, collision.final_gap, collision.final_rotation_rate or 0.0, *spins)
        yield from _of_turning(scene, turning / unit, (_first_rigid(collision) - last) / unit)
    else:
        del spent["tangential_lubrication"]
    yield from ((name, 0.0 - spent[name] / unit) for name in FORMULAS if name in spent)


def _of_turning(scene: Scene, turning: Any, rigid: Any) -> Iterable[tuple[str, Any]]:
    return (("sliding", turning),) if scene.wall else (("rigid_rotation", rigid), ("slip", turning - rigid))


def angular_momentum(scene: Scene, gap: Any, rate: Any, spin: Any, partner: Any = None) -> tuple[Any, Any]:
    """L and I(x) of two spheres (SI) with these gap, rotation rate and spins; a `partner` of None spins alike."""
    radius, mass = 2 * scene.particles.reduced_radius, 2 * scene.particles.reduced_mass
    sizes, weights = scene.radius_ratio or 0.0, scene.mass_ratio or 0.0  # of a wall, which has no L, any
    spheres = 0.4 * mass * radius**2, 0.4 * weights * mass * (sizes * radius) ** 2
    orbital = scene.reduced_mass * (radius * (1 + sizes) + gap) ** 2
    momentum = orbital * rate + spheres[0] * spin + spheres[1] * (spin if partner is None else partner)
    return momentum, orbital + sum(spheres)


def rigid_energy(scene: Scene, gap: Any, rate: Any, spin: Any, partner: Any = None) -> Any:
    """L^2/(2 I(x)), J."""
    momentum, inertia = angular_momentum(scene, gap, rate, spin, partner)
    return momentum**2 / (2 * inertia)


def _first_rigid(collision: Outcome) -> float:
    scene, material = collision.scene, collision.scene.material
    centres = 2 * scene.particles.reduced_radius * (1 + (scene.radius_ratio or 0.0))
    rate = collision.speed * math.tan(collision.angle) / centres
    spins = material["impact_spin"], material.get("impact_partner_spin")
    return float(rigid_energy(scene, scene.liquid.film_thickness, rate, *spins))


def over_time(collision: Outcome, data: xarray.Dataset) -> Mapping[str, np.ndarray]:
    """The shares that the terms have reached along a trajectory with its ledger; their sum is u^2/v0^2 - 1.

    `dry_contact` is all that the solids take, `own_events` the jumps at the times of declared events.
    """
    assert collision.energy is not None
    scene, unit = collision.scene, collision.scene.reduced_mass * collision.speed**2 / 2
    kinetic, velocity = data["kinetic"].values / unit, data["normal_velocity"].values / collision.speed
    result: dict[str, np.ndarray] = {}
    if scene.turns(collision.angle):
        rigid = rigid_energy(
            scene, *(data[name].values for name in ("gap", "rotation_rate", "spin", "spin_partner") if name in data)
        )
        turning = collision.energy.initial / unit - 1 - kinetic + velocity**2
        result |= _of_turning(scene, turning, (_first_rigid(collision) - rigid) / unit)
    absent = set() if scene.turns(collision.angle) else {"tangential_lubrication"}
    taken = [name for name in FORMULAS if name in data and name not in absent]
    result |= {name: (data[name].values[0] - data[name].values) / unit for name in taken}
    jumps = velocity**2 - 1 - sum(result.values())
    if collision.energy.own_events is not None:
        time, words = data["time"].values, scene.package.words if scene.package else ()
        at = np.isin(time, [event.time for event in collision.events if event.kind in words])
        result["own_events"] = np.cumsum(np.diff(jumps, prepend=0.0) * (at & (np.diff(time, prepend=0.0) == 0)))
    result["dry_contact"] = jumps - result.get("own_events", 0.0)
    return {name: result[name] for name in FORMULAS if name in result}
