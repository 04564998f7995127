"""One case of the stress test, what engines answered, and what is said of it."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...scene.scene import Scene
from ...settings import ENGINES

RTOL = 1e-9
FAST = "taylor" if "taylor" in ENGINES else "rosenbrock"
CHATTER = "the doublet rebounds again and again"
_REASONS = {  # what an engine may say, and the physics behind it
    "the rotation reverses the approach": "turns within a rounding error of x0",
    CHATTER: "an attraction closes the gap again after every rebound, beyond any count: a cycle of the model",
}


@dataclass(frozen=True)
class Case:
    """A scene with its impact.

    Arguments:
        kind: "sampled", "beside" a boundary, or "lines" at `angles` (rad) along which boundaries are traced.
        distance: relative distance in St from the boundary; None where none is known.
        expected: outcome on this side of it, as the tracing of the boundary has it.
        change: what happens at the boundary, as `changes.Change.kind`.
    """

    name: str
    scene: Scene
    kind: str = "sampled"
    distance: float | None = None
    expected: str | None = None
    change: str = ""
    angles: tuple[float, ...] = ()


@dataclass
class Found:
    """What an engine found: outcome or failure, e_n, CPU seconds."""

    outcome: str = ""
    restitution: float = 0.0
    certified: bool = False
    failure: str = ""
    cpu: float = 0.0
    more: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Issue:
    """Something that does not go together.

    Arguments:
        kind: "outcome", "restitution", "side", "ledger", "drift", "certificate", "boundary" or "failure".
        between: the engines it is about.
        said: in words.
        explained: the reason it may be so; empty if there is none.
    """

    kind: str
    between: tuple[str, ...]
    said: str
    explained: str = ""


@dataclass(frozen=True)
class Verdict:
    """A case with all that was found of it."""

    case: Case
    found: dict[str, Found]
    issues: tuple[Issue, ...]
    error: float | None  # largest difference in e_n between engines, where they agree on the outcome
    conditioning: float | None  # |d e_n/d ln St|, at least 1
    remarks: tuple[str, ...] = ()  # where the scene leaves the range of a law


def physical_reason(failure: str) -> str:
    """The physics behind what an engine says of a failure; empty if there is none."""
    return next((reason for words, reason in _REASONS.items() if words in failure), "")
