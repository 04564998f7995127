"""Comparison of traced boundaries with a dense scan of outcomes."""

from collections.abc import Sequence

import numpy as np

from ....generated.automaton import OUTCOMES
from ...boundaries.boundary import boundary
from ...boundaries.trace import SHARPEST
from ...many.collide_many import collide_many
from ...scene.scene import Scene
from .verdict import FAST, RTOL, Case, Issue, Result, Verdict, physical_reason

SPAN = (2e-3, 30.0)  # range of the Stokes number
SAMPLES = 700  # samples of a line
_ASIDE = 3e-6  # relative distance from a change at which outcomes are compared
_BY_ROSENBROCK, _SOME = 10, 24  # every so many scenes a replay of collisions, at so many Stokes numbers of a line


def judge_lines(case: Case) -> Verdict:
    """Trace the lines of a case and compare them with collisions."""
    issues: list[Issue] = []
    traced = boundary(case.scene, angle=np.array(case.angles), stokes=SPAN, rtol=RTOL)
    by_rosenbrock = int(case.name.rpartition("-")[2]) % _BY_ROSENBROCK == 0
    for angle, changes, failure in zip(traced.angles, traced.changes, traced.failures, strict=True):
        if failure:
            issues.append(Issue("failure", ("boundary",), failure, physical_reason(failure)))
            continue
        at = np.array([change.stokes for change in changes])
        outcomes = [changes[0].before, *(change.after for change in changes)] if changes else None
        apart = at.size < 2 or bool(np.min(np.diff(np.log(at))) > 4 * _ASIDE)  # no change lies within another's reach
        beside = np.concatenate([at * (1 - _ASIDE), at * (1 + _ASIDE)]) if apart else np.zeros(0)
        scans = [(FAST, np.concatenate([np.geomspace(*SPAN, SAMPLES), beside]))]
        if by_rosenbrock:
            scans.append(("rosenbrock", np.concatenate([np.geomspace(*SPAN, _SOME), beside])))
        for engine, stokes in scans:
            issues += _denied(case.scene, angle, at, outcomes, engine, np.clip(stokes, *SPAN))
    return Verdict(case, {"boundary": Result()}, tuple(issues), None, None)


def _denied(
    scene: Scene, angle: float, at: np.ndarray, outcomes: Sequence[str] | None, engine: str, stokes: np.ndarray
) -> list[Issue]:
    """The first collision of a line whose outcome contradicts the changes below it, as text."""
    seen = collide_many(scene, stokes=stokes, angle=angle, rtol=max(RTOL, SHARPEST), engine=engine)["outcome"].values
    if outcomes is None:
        outcomes = [OUTCOMES[max(int(seen.max()), 0)]]
    expected = np.array([OUTCOMES.index(outcome) for outcome in outcomes])[np.searchsorted(at, stokes)]
    wrong = np.flatnonzero((seen >= 0) & (seen != expected))
    if not wrong.size:
        return []
    k = wrong[0]
    text = (
        f"at {np.degrees(angle):.8g} deg, St {stokes[k]:.10g}: {OUTCOMES[seen[k]]} by {engine}, "
        f"where the traced line has {OUTCOMES[expected[k]]} ({wrong.size} of {stokes.size} such)"
    )
    return [Issue("boundary", ("boundary", engine), text)]
