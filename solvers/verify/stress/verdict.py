"""Data of one case of the stress test: scene, results of the engines, issues."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...engines.taylor.undecided import CHATTERS, CREEPS, RESTS, REVERSED, ROUNDED
from ...scene.items import item
from ...scene.origin import Record
from ...scene.scene import Scene

RTOL = 1e-9
FAST = "taylor"  # the engine under test, which is that of `collide_many`
DISAGREEMENTS = ("outcome", "restitution", "spin", "side", "ledger", "drift", "certificate", "boundary")
_REASONS = {  # physical explanations of engine failures, by pattern of the message
    REVERSED: "turns within a rounding error of x0",
    ROUNDED: "an angular momentum within rounding of its parts: a separation at less than 1e-14 of the speeds",
    CREEPS: "creeps, or is beside a separatrix, beyond the budget of steps",
    RESTS: "turns in resting contact, whose force hardly changes, beyond the budget of steps",
    CHATTERS: "an attraction closes the gap after every rebound or dip into the film, beyond any count: a cycle",
}


class Case(Record):
    """A scene with its impact."""

    name: str
    scene: Scene
    kind: str = item(
        '"sampled", "beside" a boundary, or "lines" at `angles` (rad) along which boundaries are traced',
        default="sampled",
    )
    distance: float | None = item("relative distance in St from the boundary; None if none is known", default=None)
    expected: str | None = item("outcome on this side of the boundary, according to its tracing", default=None)
    change: str = item("kind of the boundary, as in `changes.Change.kind`", default="")
    angles: tuple[float, ...] = ()


@dataclass
class Result:
    """Result of an engine: outcome or failure, e_n, and the final spins over the initial motion."""

    outcome: str = ""
    restitution: float = 0.0
    certified: bool = False
    failure: str = ""
    more: dict[str, float] = field(default_factory=dict)
    spins: tuple[float, ...] = ()

    @property
    def numbers(self) -> str:
        return " ".join(f"{value:.12g}" for value in (self.restitution, *self.spins))

    def apart(self, other: Result) -> float:
        """The largest difference of e_n and the final spins."""
        pairs = [(self.restitution, other.restitution), *zip(self.spins, other.spins, strict=False)]
        return max(abs(own - its) for own, its in pairs)


class Issue(Record):
    """A disagreement or failure."""

    kind: str = item('one of DISAGREEMENTS, or "failure"')
    between: tuple[str, ...] = item("the engines concerned")
    message: str = item("description")
    explained: str = item("the explanation; empty if there is none", default="")


@dataclass(frozen=True)
class Verdict:
    """A case with its results and issues."""

    case: Case
    results: dict[str, Result]
    issues: tuple[Issue, ...]
    error: float | None  # largest difference in e_n between engines that agree on the outcome
    conditioning: float | None  # |d e_n/d ln St|, at least 1
    remarks: tuple[str, ...] = ()  # laws used outside their range of validity


def physical_reason(failure: str) -> str:
    """The physical explanation of an engine's failure message; empty if there is none."""
    return next((reason for words, reason in _REASONS.items() if words in failure), "")
