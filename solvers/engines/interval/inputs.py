"""Boxes of inputs: the quantities of a scene as ranges, from its entries and how far each may be off."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ...errors import InputError
from ...host.arguments import check_mapping
from ...model.model import select_model
from ...scene.groups import si_values
from ...scene.scene import Scene
from ...scene.user_model import fields
from .build import Engine, NotProvable, engine
from .call import Range

Within = float | Mapping[str, float | tuple[float | str, float | str]]
MOST = 6  # entries of a box
_ACCEPTED = "LO and HI of one unit, LO below HI, or a relative uncertainty such as 1e-4"


@dataclass(frozen=True)
class Inputs:
    """What a proof is about.

    Arguments:
        ranges: low and high of each quantity, SI; the same number twice where it is exact.
        moving: the quantities that are not exact.
    """

    scene: Scene
    ranges: Mapping[str, Range]
    moving: tuple[str, ...]

    @classmethod
    def of(cls, scene: Scene, within: Within | None = None) -> Inputs:
        """The stored numbers of a scene, or the box around them.

        Arguments:
            within: relative uncertainty of the impact (Stokes number or speed, and angle), or by entry: a relative
                uncertainty, or both ends.

        Raises:
            InputError: an entry that is no number, an end that is not admissible, an empty or reversed range.
        """
        speed, angle = scene.need_impact()
        values = dict(si_values(scene, speed, angle))
        entry = scene.impact.stokes
        if entry is not None and scene.speed_of(entry) == speed:  # as it was given, without rounding the speed
            values["stokes"] = entry
        first = "stokes" if "stokes" in values else "speed"
        ranges = {name: (value, value) for name, value in values.items()}
        if within is None:
            return cls(scene, ranges, ())
        if isinstance(within, Mapping):
            check_mapping(within, "within", "ranges by dotted name")
            moved = dict(cls._range(scene, name, width, values) for name, width in within.items())
        else:
            part = _relative(within, "within")
            moved = {name: _around(values[name], part) for name in (first, "angle") if values[name]}
            if moved.get("angle", (0.0, 0.0))[1] >= math.pi / 2:
                raise InputError("within", within, "an uncertainty that keeps the angle below 90 deg")
        if len(moved) > MOST:
            raise InputError("within", len(moved), f"at most {MOST} entries")
        return cls(scene, ranges | moved, tuple(name for name, (low, high) in moved.items() if low < high))

    @staticmethod
    def _range(scene: Scene, name: str, width: object, values: Mapping[str, float]) -> tuple[str, Range]:
        known = fields(scene.package)
        if name not in known:
            raise InputError("within", name, "entries of a scene file by dotted name", "is not an entry")
        field, label = known[name], f"within {name}"
        quantity = {"impact.stokes": "stokes"}.get(name, field.quantity)
        if not quantity:
            raise InputError(label, width, "an entry that is a number by itself", "is no range of numbers")
        absent = {"speed"} if "stokes" in values else set()
        absent |= set() if scene.pair else {"impact_partner_spin"}
        if quantity not in values or quantity in absent:
            raise InputError(label, width, "an entry that this scene has", "is not there")

        def at(end: float) -> dict[str, float]:
            try:
                changed = scene.with_entries({name: end / field.factor})
            except InputError:
                raise InputError(label, width, "an entry that this scene has", "is not there") from None
            return {quantity: end, **si_values(changed, *changed.need_impact())}

        times = round(at(values[quantity])[quantity] / values[quantity]) if values[quantity] else 1  # 2 beside a wall
        if isinstance(width, tuple) and len(width) == 2:
            low, high = (field.number(end, label=label) * field.factor * times for end in width)
            if not low < high:
                raise InputError(label, list(width), _ACCEPTED, "is empty or reversed")
        else:
            low, high = _around(values[quantity], _relative(width, label))
            for end in (low, high):
                field.number(end / field.factor / times, label=label)
        for end in (low, high):
            moved = at(end / times)
            known_others = values.keys() & moved.keys() - {quantity, *absent}
            others = sorted(each for each in known_others if moved[each] != values[each])
            if others or not math.isclose(moved[quantity], end, rel_tol=1e-12):
                problem = f"decides {others[0]} as well" if others else f"is not {quantity} alone"
                raise InputError(label, width, "an entry that decides nothing else", problem)
        return quantity, (low, high)

    def engine(self) -> Engine:
        """The engine that encloses these collisions.

        Raises:
            NotProvable: there is none for this scene here.
        """
        if len({low > 0 for low in (self.ranges["angle"])}) > 1 and not self.scene.wall:
            raise NotProvable("the box holds head-on and oblique impacts")
        if self.scene.pendulum is not None:
            raise NotProvable("pendulum strings are not enclosed")
        spins = (self.ranges.get(name, (0.0, 0.0)) for name in ("impact_spin", "impact_partner_spin"))
        sideways = self.ranges["angle"][1] > 0 or any(spin != (0.0, 0.0) for spin in spins)
        oblique = sideways and not self.scene.wall  # beside a wall the gap moves as head-on (derive/checks/partners.py)
        if oblique and self.scene.particles.friction is not None:
            raise NotProvable("friction of the dry contact is not enclosed")
        own = self.scene.bridge is not None and self.scene.bridge.rupture == "own"
        return engine(select_model(self.scene, oblique, fold=True), own, len(self.moving))


def _relative(width: object, label: str) -> float:
    if isinstance(width, bool) or not isinstance(width, (int, float)) or not 0 < width < 1:
        raise InputError(label, width, _ACCEPTED, "is empty or reversed" if width == 0 else "is no range")
    return float(width)


def _around(value: float, part: float) -> Range:
    away = abs(value) * part
    return math.nextafter(value - away, -math.inf), math.nextafter(value + away, math.inf)
