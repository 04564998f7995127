"""Eight collisions through every kind of event, and derivatives by extrapolated differences of accurate values."""

from dataclasses import dataclass, field

import numpy as np
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.sensitivity.parameters import parameters_of

GRANULATION, DRY, PENDULUM = (Scene.load(name) for name in ("granulation", "granulation-dry-bridge", "pendulum"))
STEPS = (4e-3, 2e-3, 1e-3)
IMPACT, TURNING = ("impact.speed", "impact.angle"), ("rotation", "final_spin", "final_rotation_rate")
HARD = {"liquid.glass_transition_pressure": 1e13}


@dataclass(frozen=True)
class Case:
    """A collision: scene, what is changed in it, impact; and the events it is there for."""

    name: str
    base: Scene
    stokes: float
    angle: str
    kinds: tuple[str, ...]
    changes: dict[str, object] = field(default_factory=dict)

    @property
    def scene(self) -> Scene:
        return self.base.with_entries(self.changes).with_impact(stokes=self.stokes, angle=self.angle)


CASES = (
    Case("glass", GRANULATION, 0.14, "40 deg", ("glass", "film edge", "rupture")),
    Case("turned", GRANULATION, 0.03, "65 deg", ("turned", "film edge", "rupture")),
    Case("head-on", GRANULATION, 0.125, "0 deg", ("glass", "film edge", "rupture")),
    Case("elastic", GRANULATION, 3.0, "30 deg", ("elastic", "film edge", "rupture"), HARD),
    Case(
        "rough", GRANULATION, 3.0, "30 deg", ("rough", "film edge", "rupture"),
        HARD | {"particles.roughness": "0.6 um", "particles.youngs_modulus": "7e4 GPa"}
        | {"bridge.law": "lambert", "bridge.contact_angle": "20 deg"},
    ),
    Case("no bridge, turned", DRY, 0.05, "45 deg", ("turned", "rupture"), {"model.tangential": "film"}),
    Case("strings", PENDULUM, 1.0, "60 deg", ("turned", "rupture")),
    Case("strings, glass", PENDULUM, 1.55, "35 deg", ("glass", "rupture")),
)  # fmt: skip


def elasticities(case: Case) -> dict[str, dict[str, float]]:
    """Elasticities of a case in its entries that are not zero, by extrapolated differences of the kernel's values.

    All collisions are one call at rtol 1e-13; their error is of sixth order in the step and some 1e-10.
    """
    scene, (speed, angle) = case.scene, case.scene.need_impact()
    of = ("restitution", "contact_time", "smallest_gap", *(TURNING if angle else ()))
    given = {**scene.entries, "impact.speed": speed, "impact.angle": angle}
    names = [name for name in parameters_of(scene) if name != "impact.stokes" and given[name]]
    parts = np.ravel([[h, -h] for h in STEPS])
    columns = {name: np.full((len(names), parts.size), float(given[name])) for name in names}
    for k, name in enumerate(names):
        columns[name][k] *= 1 + parts
    impact = {name.removeprefix("impact."): columns.pop(name, np.full(1, angle)).ravel() for name in IMPACT}
    vary = {name: column.ravel() for name, column in columns.items()}
    found = collide_many(scene, **impact, vary=vary, of=of, rtol=1e-13, engine="taylor")
    rows = {}
    for name in of:
        moved = np.log(np.abs(found[name].values)).reshape(len(names), len(STEPS), 2)
        coarse, middle, fine = (
            (moved[:, k, 0] - moved[:, k, 1]) / np.log((1 + h) / (1 - h)) for k, h in enumerate(STEPS)
        )
        rows[name] = dict(zip(names, ((64 * fine - 20 * middle + coarse) / 45).tolist()))
    return rows


def apart(one: dict[str, float | None], other: dict[str, float | None]) -> float:
    """Largest difference of two rows of elasticities, over the largest elasticity."""
    largest = max(abs(v) for v in other.values() if v is not None)
    return max(abs(one[k] - v) for k, v in other.items() if v is not None) / largest  # type: ignore[operator]  # both have it
