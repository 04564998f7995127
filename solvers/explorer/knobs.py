"""The quantities of a scene that a visitor of its page sets: names, units, intervals, and the law's numbers behind."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ..export.law.material import Number
from ..scene.fields import Range
from ..scene.items import item
from ..scene.origin import Record
from ..scene.scene import Scene
from ..scene.schema import SPEEDS
from ..scene.units import is_number

_LABELS = {
    "particles.radius": "Diameter",
    "particles.density": "Density",
    "particles.roughness": "Roughness",
    "particles.dry_restitution": "Dry restitution",
    "particles.friction": "Friction",
    "particles.contact_tangential_restitution": "Dry tangential restitution",
    "particles.youngs_modulus": "Young's modulus",
    "particles.poisson_ratio": "Poisson's ratio",
    "liquid.viscosity": "Viscosity",
    "liquid.film_thickness": "Film thickness",
    "liquid.coating_thickness": "Coating thickness",
    "liquid.glass_transition_pressure": "Glass-transition pressure",
    "bridge.surface_tension": "Surface tension",
    "bridge.volume": "Bridge volume, V/R³",
    "bridge.coating_fraction": "Coating that flows into the bridge",
    "bridge.contact_angle": "Contact angle",
    "attraction.hamaker": "Hamaker constant",
    "partner.radius": "Partner's diameter",
    "partner.density": "Partner's density",
    "partner.coating_thickness": "Partner's coating thickness",
    "pendulum.length": "String length",
    "pendulum.gravity": "Gravity",
}
_HINTS = {
    "impact.angle": "0 is head-on, 90 grazing",
    "impact.spin": "before; positive is counterclockwise",
    "particles.roughness": "gap at which the solids touch",
    "particles.dry_restitution": "of the solids without liquid",
    "particles.friction": "of the solids",
    "liquid.film_thickness": "gap at which the films touch",
    "liquid.coating_thickness": "liquid on a particle",
    "liquid.glass_transition_pressure": "at which the liquid turns solid",
    "bridge.volume": "liquid between the particles",
    "bridge.contact_angle": "0 is perfect wetting",
    "attraction.hamaker": "of van der Waals attraction",
}
"""What a word means, for those who meet it first."""
_FIRST = (
    "liquid.viscosity", "liquid.film_thickness", "liquid.coating_thickness", "bridge.surface_tension", "bridge.volume",
    "particles.radius", "particles.roughness", "particles.dry_restitution", "particles.friction",
)  # fmt: skip
"""What is shown at once, in this order; the rest opens."""
_UNITS = {"m": ("um", 1e-6), "kg/m^3": ("kg/m^3", 1.0), "rad": ("deg", math.pi / 180), "Pa": ("MPa", 1e6)}
"""Units of entries that the scene gives otherwise, or not at all."""
_ALIKE = {
    "particles.radius": ("particles.diameter", "particles.reduced_radius"),
    "partner.radius": ("partner.diameter",),
}
"""Entries in whose unit a diameter is shown."""
_NEVER = 1e50  # from here on a limit is never met
_STEEPEST = 85.0  # deg, on sliders; number fields take all below 90


class Knob(Record):
    """A quantity that is set.

    Attributes:
        low, high: of the slider, in the unit.
    """

    name: str = item("of the scene's entry; in the page's address too")
    label: str
    unit: str = item("empty for a plain number")
    factor: float = item("SI per unit")
    value: float | None = item("the scene's, in the unit; None for a limit that is never met")
    low: float
    high: float
    logarithmic: bool = item("whether the slider is")
    members: tuple[str, ...] = item("numbers of the law that it sets; empty if it is of the impact", default=())
    never: float | None = item("the law's number for a limit that is never met; None if there is none", default=None)
    first: bool = item("shown at once", default=True)


def knobs(scene: Scene, entries: Sequence[Number], impact: Sequence[Number]) -> list[dict[str, Any]]:
    """The knobs of a scene, as the page reads them; those of the impact first."""
    knobs = {
        item.name.replace("_", ".", 1): _of_entry(scene, item) for item in entries if item.name != "liquid_density"
    }
    if scene.partner is None:  # equal spheres have one size, one density and one coating
        for name in [knob for knob in knobs if knob.startswith("partner.")]:
            twin = name.replace("partner.coating", "liquid.coating").replace("partner.", "particles.")
            own, partner = knobs[twin], knobs.pop(name)
            knobs[twin] = replace(own, members=(*own.members, *partner.members))
    first = [knobs.pop(name) for name in _FIRST if name in knobs]
    rest = [replace(knob, first=False) for knob in knobs.values()]
    return [
        knob.to_dict() | {"hint": _HINTS.get(knob.name, "")} for knob in (*_of_impact(scene, impact), *first, *rest)
    ]


def _of_entry(scene: Scene, number: Number) -> Knob:
    name = number.name.replace("_", ".", 1)
    unit, factor = _unit(scene, name, number.unit)
    radius = name in ("particles.radius", "partner.radius")
    label = _LABELS.get(name, name.partition(".")[2].replace("_", " ").capitalize())
    if name == "bridge.volume" and scene.ways.volume == "absolute":
        label, unit, factor = "Bridge volume", "mm^3", 1e-9
    factor = factor / 2 if radius else factor
    never = number.most if number.most > _NEVER else None
    value = None if never and number.value >= _NEVER else number.value / factor
    low, high, logarithmic = _interval(value, number.range, factor)
    return Knob(name, label, unit, factor, value, low, high, logarithmic, (number.name,), never)


def _unit(scene: Scene, name: str, si: str) -> tuple[str, float]:
    """The unit in which the scene's file gives an entry, or its size's, and how much it is in SI."""
    given = dict(scene.given)
    for key in (name, *_ALIKE.get(name, ())):
        raw = given.get(key)
        number, _, unit = raw.partition(" ") if isinstance(raw, str) else ("", "", "")
        if unit and is_number(number) and scene.fields[key].unit:  # and no liquid by its name
            return unit, scene.fields[key].number(f"1 {unit}")
    return ("", 1.0) if si == "1" else _UNITS.get(si, (si, 1.0))


def _interval(value: float | None, accepted: Range, factor: float) -> tuple[float, float, bool]:
    """Ends of a slider, and whether it is logarithmic: all that is accepted, or a decade and more around the value."""
    if math.isfinite(accepted.low) and math.isfinite(accepted.high):
        return max(accepted.low, 0.0) / factor, accepted.high / factor, False
    if not value:
        return (1.0, 1e6, True) if value is None else (0.0, 1.0, False)
    return _rounded(value / 20), _rounded(value * 20), True


def _rounded(value: float) -> float:
    return float(f"{value:.0e}")


def _of_impact(scene: Scene, impact: Sequence[Number]) -> list[Knob]:
    speed, angle = scene.need_impact()
    entry = next(name for name in SPEEDS if name in dict(scene.given))
    unit, factor = _unit(scene, entry, "1" if entry.endswith("stokes") else "m/s")
    value = float(scene.entries[entry]) / factor
    low, high, logarithmic = _rounded(value / 50), _rounded(value * 50), True
    knobs = [
        Knob("impact.speed", "Speed", unit, factor, value, low, high, logarithmic),
        Knob("impact.angle", "Impact angle", "deg", math.pi / 180, math.degrees(angle), 0.0, _STEEPEST, False),
    ]
    most = _rounded(8 * speed / (2 * scene.particles.reduced_radius))
    material = scene.material
    for name, label in (("spin", "Spin"), ("partner_spin", "Partner's spin")):
        number = next(item for item in impact if item.name == name)
        if number.range.high > 0:
            value = float(material.get(f"impact_{name}", 0.0))
            knobs.append(Knob(f"impact.{name}", label, "rad/s", 1.0, value, -most, most, False))
    return knobs
