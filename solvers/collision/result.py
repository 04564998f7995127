"""The result of one collision: immutable; prints as a table, converts to the JSON object, draws a figure."""

from dataclasses import dataclass, fields

from ..host.pictures import Drawn
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

    def __repr__(self) -> str:
        names = [each.name for each in fields(self) if each.repr and each.name != "events"]
        shown = {name: repr(getattr(self, name)) for name in names}
        first, last = (", ".join(map(repr, part)) for part in (self.events[:_ENDS], self.events[-_ENDS:]))
        hidden = len(self.events) - 2 * _ENDS
        shown["events"] = f"({first}, ... {hidden} more ..., {last})" if hidden > 0 else repr(self.events)
        return f"{type(self).__name__}({', '.join(f'{name}={text}' for name, text in shown.items())})"

    def __str__(self) -> str:
        from .text import table

        return table(self)

    def _repr_html_(self) -> str:
        from .notebook import html

        return html(self)
