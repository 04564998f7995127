"""The result of one collision: immutable; prints as a table, converts to the JSON object, draws a figure."""

from dataclasses import dataclass, fields

from ..formatting.notebook import view
from ..host.pictures import Drawn
from ..results import DEFINITIONS, OF_SEPARATION
from .budget import Budget
from .outcome import Outcome

_ENDS = 20  # events that `repr` shows at each end of a longer list


@dataclass(frozen=True, kw_only=True)
class Collision(Outcome, Drawn):
    """One collision, as `collide` returns it; its attributes are those of `Outcome`.

    `plot` draws gap and velocity, the rotation, and the doublet at a few instants; ValueError if the collision was
    computed without `trajectory=True`.

    Example:
        >>> from wetdoublet.solvers import collide
        >>> one = collide("granulation", stokes=0.3, angle="20 deg")
        >>> one.outcome, one.reversal, [event.kind for event in one.events]
        ('bounce', 'glass', ['glass', 'rupture'])
    """

    _picture = "collision.plot.figure.draw"

    @property
    def budget(self) -> Budget | None:
        """Pairs of a term and its share of the initial normal energy, which sum to e_n^2 - 1.

        Empty for a stick, which has no e_n. None where the collision was computed with `ledger=False`.
        """
        return None if self.energy is None else Budget(self)

    def __repr__(self) -> str:
        names = [entry.name for entry in fields(self) if entry.repr and entry.name != "events"]
        values = {name: repr(getattr(self, name)) for name in names}
        first, last = (", ".join(map(repr, events)) for events in (self.events[:_ENDS], self.events[-_ENDS:]))
        hidden = len(self.events) - 2 * _ENDS
        values["events"] = f"({first}, ... {hidden} more ..., {last})" if hidden > 0 else repr(self.events)
        return f"{type(self).__name__}({', '.join(f'{name}={text}' for name, text in values.items())})"

    def __str__(self) -> str:
        from .text import table

        return table(self)

    def _repr_html_(self) -> str:
        """Outcome and why, results with units, events, and what the model warns of."""
        from .text import assumed, degrees, name_of, plain, quantity, reason, with_unit

        rows = [
            ("outcome", self.outcome, reason(self)),
            (
                "impact",
                f"St {plain(self.stokes)}, {degrees(self.angle)}",
                f"normal speed {quantity(self.speed, 'm/s')}",
            ),
        ]
        defined = (DEFINITIONS[name] for name in OF_SEPARATION if getattr(self, name) is not None)
        rows += [(row.label, with_unit(getattr(self, row.name), row.unit), "") for row in defined]
        if self.events:
            happened = [f"{event.kind} at {quantity(event.time, 's')}" for event in self.events[:6]]
            more = [f"{len(self.events) - 6} more"] if len(self.events) > 6 else []
            rows.append(("events", "; ".join([*happened, *more]), ""))
        if self.energy is not None:
            end = f"{quantity(self.energy.final, 'J')} at the end; residual {self.energy.residual:.1e} J"
            rows.append(("energy", f"{quantity(self.energy.initial, 'J')} at contact", end))
        engine = f"{self.engine}, {self.steps} steps"
        return view(
            name_of(self.scene),
            rows,
            notes=[*self.validity, *filter(None, [self.long_contact]), *assumed(self.scene), engine],
        )
