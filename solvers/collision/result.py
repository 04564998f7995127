"""The result of one collision: immutable; prints as a table, converts to the JSON object, draws a figure."""

from dataclasses import fields

from ..host.pictures import Drawn
from .budget import Budget
from .outcome import Outcome

_ENDS = 20  # events that `repr` shows at each end of a longer list


class Collision(Outcome, Drawn, kw_only=True):
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
