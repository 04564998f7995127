"""What a run is asked to do, apart from the scene: the tolerance and the engine."""

from __future__ import annotations

from .errors import InputError, did_you_mean
from .scene.schema import Field, Range

ENGINES = ("cvodes", "rosenbrock", "taylor")
RTOL = 1e-9  # unless something else is asked for
# What one collision may cost: steps of whichever engine, in one attempt. What they have not decided is an error that
# says where they were spent.
STEPS = 100_000
CALL = 25  # steps that a call of an integrator counts for at least: chatter is many short ones
FEW = 100  # collisions that are not worth a compiler
_TOLERANCE = Field("rtol", "a relative tolerance", "1e-9", Range("from 1e-13 to 1e-3", lambda v: 1e-13 <= v <= 1e-3))


def check_rtol(rtol: object, label: str = "rtol") -> float:
    """Return the relative tolerance; InputError naming `label` unless it is 1e-13 to 1e-3."""
    return _TOLERANCE.number(rtol, label=label)


def check_engine(engine: object, label: str = "engine") -> str | None:
    """Return the engine, None for the best there is; InputError naming `label` if there is no such engine."""
    if engine is None:
        return None
    if not isinstance(engine, str) or engine not in ENGINES:
        raise InputError(label, engine, ", ".join(ENGINES), "is not known" + did_you_mean(engine, ENGINES))
    return engine


def check_plugin(engine: object, label: str = "engine") -> str | None:
    """As `check_engine`, for what needs an integrator that CasADi can differentiate as a whole."""
    found = check_engine(engine, label)
    if found == "taylor":
        raise InputError(label, found, ", ".join(ENGINES[:2]), "has no derivatives of this kind")
    return found
