"""Boxes of inputs: the quantities of a scene as ranges, from its entries and how far each may be off."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ...errors import InputError, did_you_mean
from ...host.arguments import check_mapping
from ...model.model import select_model
from ...scene.held import impact_quantity
from ...scene.quantities import quantities
from ...scene.scene import Scene
from ...scene.schema import ALTERNATIVES
from .build import Engine, NotProvable, engine
from .call import Range

Within = float | Mapping[str, float | tuple[float | str, float | str]]
MOST = 6  # entries of a box, and quantities that they move
_ACCEPTED = "LO and HI of one unit, LO below HI, or a relative uncertainty such as 1e-4"
_READ = 2.0**-50  # above the rounding of an end that is read, relative
COMPUTED = 2.0**-48  # above that of a quantity that is computed from entries


@dataclass(frozen=True)
class Inputs:
    """What a proof is about.

    Arguments:
        box: low and high of the entries that are not exact, SI, as the scene gives them.
        ranges: low and high of each quantity, SI; the same number twice where it is exact.
        moving: the quantities that are not exact.
    """

    scene: Scene
    box: Mapping[str, Range]
    ranges: Mapping[str, Range]
    moving: tuple[str, ...]

    @classmethod
    def of(cls, scene: Scene, within: Within | None = None) -> Inputs:
        """The stored numbers of a scene, or the box around them.

        Every quantity is monotone in every entry, so that corners have its least and its largest value. The number by
        which the scene gives the impact's speed stays where the box does not name it.

        Arguments:
            within: relative uncertainty of the impact (its speed as the scene gives it, and angle), or by entry: a
                relative uncertainty, or both ends.

        Raises:
            InputError: an entry that the scene does not have or that is no number, an empty or reversed range, a corner
                that is no admissible scene.
        """
        given = impact_quantity(scene)
        entries = {**scene.entries, "impact.angle": scene.need_impact()[1]}
        if within is not None and not isinstance(within, Mapping):
            relative = _relative(within, "within")
            within = {name: relative for name in (f"impact.{given}", "impact.angle") if entries[name]}
        ends = check_mapping(within or {}, "within", "ranges by dotted name")
        box = {name: _ends(scene, name, width) for name, width in ends.items()}
        if len(box) > MOST:
            raise InputError("within", len(box), f"at most {MOST} entries")
        corners = [dict(zip(box, corner, strict=True)) for corner in itertools.product(*box.values())]
        values = [_quantities(scene, entries, corner) for corner in corners]
        ranges = {name: _hull([corner[name] for corner in values]) for name in values[0]}
        moving = tuple(name for name, (low, high) in ranges.items() if low < high)
        if scene.ways.volume == "coating" and {"volume", "radius_ratio"} <= {*moving}:
            accepted = "entries but the radii, whose volume from coatings need not be monotone"
            raise InputError("within", list(box), accepted, "moves the ratio of the radii")
        if len(moving) > MOST:
            raise InputError("within", len(moving), f"entries that move at most {MOST} quantities")
        return cls(scene, box, ranges, moving)

    def engine(self) -> Engine:
        """The engine that encloses these collisions.

        Raises:
            NotProvable: there is none for this scene here.
        """
        if self.scene.pendulum is not None:
            raise NotProvable("pendulum strings are not enclosed")
        spins = (self.ranges.get(name, (0.0, 0.0)) for name in ("impact_spin", "impact_partner_spin"))
        sideways = self.ranges["angle"][1] > 0 or any(spin != (0.0, 0.0) for spin in spins)
        oblique = sideways and not self.scene.wall  # beside a wall the gap moves as head-on (derive/checks/partners.py)
        if oblique and self.scene.particles.friction is not None:
            raise NotProvable("friction of the dry contact is not enclosed")
        own = self.scene.bridge is not None and self.scene.bridge.rupture == "own"
        return engine(select_model(self.scene, oblique, fold=True), own, len(self.moving))


def _quantities(scene: Scene, entries: Mapping[str, float | str], corner: Mapping[str, float]) -> dict[str, float]:
    """The quantities at a corner, whose scene must be admissible; of an impact by Stokes number that, and no speed."""
    try:
        if corner:
            scene.with_si(corner, hold=impact_quantity(scene))
    except InputError as error:
        problem = f"{error.problem}, at a corner of the box"
        raise InputError(f"within {error.field}", error.value, error.accepted, problem) from None
    entries = {**entries, **corner}
    values = quantities(entries, scene.ways)
    if "impact.stokes" in entries:
        values["stokes"] = entries["impact.stokes"]
        del values["speed"]
    return values


def _ends(scene: Scene, name: str, width: object) -> Range:
    """Low and high of an entry, SI, as the scene gives it; what reading them rounds is outward."""
    fields, label = scene.fields, f"within {name}"
    if name not in fields:
        problem = "is not an entry" + did_you_mean(name, fields)
        raise InputError("within", name, "entries of a scene file by dotted name", problem)
    field, tables = fields[name], {entry.partition(".")[0] for entry in scene.entries}
    value = scene.entries.get(name, field.default if name.partition(".")[0] in tables else None)
    if isinstance(value, str) or not field.numeric:
        raise InputError(label, width, "an entry that this scene gives as a number", "is no range of numbers")
    if value is None:
        same = [other for ways in ALTERNATIVES if name in ways for other in ways if other in scene.entries]
        accepted = "an entry that this scene has" + "".join(f": {other}" for other in same)
        raise InputError(label, width, accepted, "is not there")
    if isinstance(width, tuple) and len(width) == 2:
        low, high = (scene.si_number(name, end, label) for end in width)
        if not low < high:
            raise InputError(label, list(width), _ACCEPTED, "is empty or reversed")
    else:
        away = abs(value) * _relative(width, label)
        low, high = value - away, value + away
        if not low < high or not (field.range.holds(low) and field.range.holds(high)):
            raise InputError(label, width, f"{field.accepts}, at both ends", "is no range around " + repr(value))
    low, high = outward(low, high, _READ)
    return max(low, field.range.low), min(high, field.range.high)


def outward(low: float, high: float, relative: float) -> Range:
    """The ends moved outward by a part of them; zero, which nothing rounds, stays."""
    below, above = low - abs(low) * relative, high + abs(high) * relative
    return low and math.nextafter(below, -math.inf), high and math.nextafter(above, math.inf)


def _hull(values: Sequence[float]) -> Range:
    """The range of a quantity with these values at the corners."""
    low, high = min(values), max(values)
    return (low, high) if low == high else outward(low, high, COMPUTED)


def _relative(width: object, label: str) -> float:
    if isinstance(width, bool) or not isinstance(width, (int, float)) or not 0 < width < 1:
        raise InputError(label, width, _ACCEPTED, "is empty or reversed" if width == 0 else "is no range")
    return float(width)
