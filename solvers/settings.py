"""Numerical settings of a run: relative tolerance, engine and step budget."""

from __future__ import annotations

from .errors import InputError, did_you_mean
from .scene.schema import Field, Range

CASADI_ENGINES = ("cvodes", "rosenbrock")  # plugins of CasADi's `integrator`
ENGINES = (*CASADI_ENGINES, "taylor")
RTOL = 1e-9  # default
# Most steps of one collision in one attempt, for every engine; beyond it a ComputationError names the phase and state.
STEPS = 100_000
CALL = 25  # least number of steps that an integrator call counts for; bounds chatter, which makes many short calls
FEW = 100  # up to this many collisions, compiling the kernel does not pay
TOLERANCE = Field(
    "rtol", "a relative tolerance", "1e-9", Range("from 1e-13 to 1e-3", 1e-13, 1e-3, low_open=False, high_open=False)
)
UNTIL = Field("until", "a time after initial contact", '"5 ms"', unit="s")  # to which a stick is followed on


def check_rtol(rtol: object, label: str = "rtol") -> float:
    """Return the relative tolerance; InputError naming `label` unless it is 1e-13 to 1e-3."""
    return TOLERANCE.number(rtol, label=label)


def check_engine(engine: object, label: str = "engine") -> str | None:
    """Return the engine, None for the default; InputError naming `label` if it is unknown."""
    if engine is None:
        return None
    if not isinstance(engine, str) or engine not in ENGINES:
        raise InputError(label, engine, ", ".join(ENGINES), "is not known" + did_you_mean(engine, ENGINES))
    return engine


def check_plugin(engine: object, label: str = "engine") -> str | None:
    """Return the engine as `check_engine` does, only for engines that CasADi can differentiate."""
    found = check_engine(engine, label)
    if found is not None and found not in CASADI_ENGINES:
        raise InputError(label, found, ", ".join(CASADI_ENGINES), "has no derivatives of this kind")
    return found
