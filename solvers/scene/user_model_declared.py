"""What a user's model declares beside laws, by its entries in the manifest: quantities, events, criteria and terms."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .fields import Field, Range

if TYPE_CHECKING:
    from ...generated.automaton import Event

TABLE = "custom"


@dataclass(frozen=True)
class OwnEvent:
    """An event that a model declares, by its entry in the manifest.

    Arguments:
        row: the event as a row of the automaton's table.
        mark: name of the state that is 1 before the event and 0 after it.
        reach: signs of the guard's derivatives by the gap, and by the speed while opening and closing, where proved;
            None if they do not determine where the guard is least.
        takes: proved that its jump never adds kinetic energy.
        harmless: proved, in addition, that it leaves every energy barrier as it is.
        rotates: guard or jump contains a rotation, which is absent beside a wall.
        turns: the guard depends on rotations only, so that the event does not happen head-on.
        spins: the jump changes a rotation.
    """

    row: Event
    mark: str
    meaning: str
    reach: Mapping[str, int | None] | None
    takes: bool
    harmless: bool
    rotates: bool
    turns: bool
    spins: bool

    @classmethod
    def from_manifest(cls, entry: Mapping[str, Any]) -> OwnEvent:
        """The event that an element of the manifest's `events` describes; JSON's lists become tuples."""
        from ...generated.automaton import Event  # imported here because `generate` must run without emitted code

        fields = {name: entry[name] for name in Event._fields}
        fields |= {"where": tuple((component, value) for component, value in entry["where"])}
        fields |= {name: tuple(entry[name]) for name in ("functions", "words", "actions")}
        own_fields = ("mark", "meaning", "reach", "takes", "harmless", "rotates", "turns", "spins")
        return cls(Event(**fields), **{name: entry[name] for name in own_fields})

    @property
    def name(self) -> str:
        return self.row.name

    @property
    def word(self) -> str:
        return self.row.words[0]


@dataclass(frozen=True)
class OwnCriterion:
    """A rebound criterion that a model declares: its word in reports, and the group that is its gap."""

    word: str
    group: str
    meaning: str
    source: str

    @property
    def sentence(self) -> str:
        return f"rebounded because the gap was down to {self.meaning}"


@dataclass(frozen=True)
class Terms:
    """What a model adds to the equations of motion, by its entry in the manifest.

    Arguments:
        rotates: they speak of a rotation, so that the angular momentum of the spheres is not conserved.
        drives: they turn what does not turn.
        admits_barrier: the energy certificate holds with them.
    """

    rotates: bool
    drives: bool
    admits_barrier: bool


def field_of(quantity: Mapping[str, Any]) -> Field:
    """The entry of a scene that a quantity is, by its element of the manifest's `quantities`."""
    bounds = quantity["bounds"]
    low = -math.inf if bounds["low"] is None else bounds["low"]
    high = math.inf if bounds["high"] is None else bounds["high"]
    interval = Range(bounds["text"], low, high, bounds["low_open"], bounds["high_open"])
    unit = None if quantity["unit"] == "1" else quantity["unit"]
    default = quantity["default"]
    example = f'"{default}"' if isinstance(default, str) else "1" if default is None else str(default)
    if unit and default is None:
        example = f'"1 {unit}"'
    meaning = re.sub(r"^(an?|the) ", "", quantity["meaning"])
    what = f"the {meaning}" if unit else f"a number ({meaning})"
    return Field(f"{TABLE}.{quantity['name']}", what, example, interval, unit=unit)
