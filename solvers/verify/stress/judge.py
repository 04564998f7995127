"""One case of the stress test, computed by all engines, whose results are compared."""

import math
import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ....generated.automaton import OUTCOMES
from ...boundaries.boundary import boundary
from ...boundaries.trace import SHARPEST
from ...collision.by_kernel import recorded
from ...collision.by_replay import by_replay
from ...engines.taylor.call import variant
from ...engines.taylor.source import Variant
from ...engines.taylor.undecided import CHATTERS, SEPARATES
from ...errors import ComputationError, ModelWarning
from ...many.collide_many import collide_many
from ...model.dimensionless import Problem
from ...model.validity import remarks
from ...scene.scene import Scene
from ..audit import LONG
from .verdict import FAST, RTOL, Case, Issue, Result, Verdict, physical_reason

SHARE = 1e3  # assumed bound of an engine's error in units of rtol, times the conditioning
FLOOR = 1e-12  # assumed bound of rounding errors, times the conditioning
OPEN = 1e-5  # largest residual, relative to the ledger's largest term
DRIFT = 1e-6  # largest relative drift of the angular momentum
_STEP = 1e-6  # relative step in St for the conditioning
_PARTICULAR = re.compile(r" = .* is (?=above|below)| \(.*")  # value and source of a remark
SPAN = (2e-3, 30.0)  # range of the Stokes number
SAMPLES = 700  # samples of a line
_ASIDE = 3e-6  # relative distance from a change at which outcomes are compared
_BY_ROSENBROCK, _SOME = 10, 24  # every so many scenes a replay of collisions, at so many Stokes numbers of a line


def fast(scene: Scene, rtol: float) -> Result:
    """Result of `collide_many` with the fastest engine."""
    names = _spins_of(scene)
    data = collide_many(scene, rtol=rtol, engine=FAST, of=("outcome", "restitution", *names))
    outcome = int(data["outcome"].values[0])
    if outcome < 0:
        raise ComputationError(str(data["reason"].values[0]))
    restitution, certified, *spins = (data[name].values[0].item() for name in ("restitution", "certified", *names))
    return Result(OUTCOMES[outcome], restitution, certified, spins=_surface_speeds(scene, *spins))


def _spins_of(scene: Scene) -> tuple[str, ...]:
    """Names of the spins that a collision of the scene has."""
    second = scene.pair or scene.impact.partner_spin is not None
    return ("final_spin", "final_spin_partner") if second else ("final_spin",)


def _surface_speeds(scene: Scene, *spins: float | None) -> tuple[float, ...]:
    """Spins times radii over the initial relative speed; 0 for one that a stick or head-on collision lacks."""
    speed, angle = scene.need_impact()
    radius, impact_spins = 2 * scene.particles.reduced_radius, (scene.impact.spin, scene.impact.partner_spin)
    radii = radius, radius * (scene.radius_ratio or 1.0)
    fast = speed / math.cos(angle) + sum(
        abs(spin or 0.0) * size for spin, size in zip(impact_spins, radii, strict=True)
    )
    sizes = zip(spins, radii, strict=False)
    return tuple(0.0 if spin is None or math.isnan(spin) else spin * size / fast for spin, size in sizes)


def fast_kernel(scene: Scene) -> Variant:
    """The kernel variant of a scene."""
    return variant(scene, Problem.read(scene).oblique, RTOL, rotation=False)


def chained(scene: Scene, rtol: float, plugin: str = "cvodes") -> Result:
    """Result as by `collide` with its ledger."""
    collision = by_replay(Problem.read(scene), rtol, plugin, True, False)
    more: dict[str, float] = {}
    if collision.energy is not None:
        terms = collision.energy.to_dict()
        more["residual"] = abs(terms["residual"]) / max(abs(value) for value in terms.values())
    if collision.angular_momentum_drift is not None:
        more["drift"] = collision.angular_momentum_drift
    spins = _surface_speeds(scene, *(getattr(collision, name) for name in _spins_of(scene)))
    return Result(collision.outcome, collision.restitution, collision.certified, more=more, spins=spins)


Run = Callable[[Scene, float], Result]


def runs() -> dict[str, Run]:
    """The compared engines; the first is the one under test."""
    return {FAST: fast, "rosenbrock": lambda scene, rtol: chained(scene, rtol, "rosenbrock"), "cvodes": chained}


def judge(case: Case, engines: dict[str, Run] | None = None) -> Verdict:
    """Run every engine on a case and compare the results.

    Arguments:
        engines: engines by name, the one under test first; `runs()` if None.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # counted, and reported once for all cases
        verdict = judge_lines(case) if case.angles else _judged(case, runs() if engines is None else engines)
    return replace(verdict, remarks=tuple(_PARTICULAR.sub(" ", remark).strip() for remark in remarks(case.scene)))


def _judged(case: Case, engines: dict[str, Run]) -> Verdict:
    results: dict[str, Result] = {}
    for name, run in engines.items():
        results[name] = _result(run, case.scene, RTOL)
        if CHATTERS in results[name].failure:
            break  # nothing is recorded that others could follow
    issues: list[Issue] = [
        Issue("failure", (name,), result.failure, _physical(result.failure, name, case))
        for name, result in results.items()
        if result.failure
    ]
    answers = {name: result for name, result in results.items() if not result.failure}
    first = next(iter(answers), None)
    error = slope = None
    if first is not None and len(answers) > 1:
        reference = answers[first]
        slope = _conditioning(engines[first], case.scene, reference)
        bound = (SHARE * RTOL + FLOOR) * slope
        same = [result.restitution for result in answers.values() if result.outcome == reference.outcome]
        error = max(same) - min(same)
        for name, result in answers.items():
            if result.outcome != reference.outcome:
                kind, text = "outcome", f"{first} says {reference.outcome}, {name} {result.outcome}"
            elif reference.apart(result) > bound:
                kind = "restitution" if abs(reference.restitution - result.restitution) > bound else "spin"
                text = f"e_n and spins {reference.numbers} by {first}, {result.numbers} by {name}"
            else:
                continue
            issues.append(Issue(kind, (first, name), text, change_nearby(case, engines, first, name)))
    for name, result in answers.items():
        issues += _of_engine(name, result, case)
    if first is not None and answers[first].certified:
        issues += _audited(case, first)
    return Verdict(case, results, tuple(issues), error, slope)


def _result(run: Run, scene: Scene, rtol: float) -> Result:
    try:
        return run(scene, rtol)
    except ComputationError as error:
        return Result(failure=str(error))
    except Exception as error:  # noqa: BLE001 # a defect is what this is looking for
        return Result(failure=f"internal error: {type(error).__name__}: {error}")


def _physical(failure: str, engine: str, case: Case) -> str:
    """The physical reason of a failure; empty if there is none. The engine under test must not fail near a boundary."""
    if engine != FAST and case.distance is not None and case.distance <= SHARE * RTOL:
        return f"within {SHARE * RTOL:.0e} of a boundary, where the trajectory passes a saddle or a graze"
    return physical_reason(failure)


def _at(scene: Scene, factor: float) -> Scene:
    return scene.with_impact(stokes=float(scene.stokes or 0.0) * factor)


def _conditioning(run: Run, scene: Scene, here: Result) -> float:
    """|d/d ln St| of e_n and spins over a small step, the largest of both sides; at least 1. inf at a change."""
    largest = 1.0
    for factor in (1 - _STEP, 1 + _STEP):
        neighbour = _result(run, _at(scene, factor), RTOL)
        if neighbour.failure:
            continue
        if neighbour.outcome != here.outcome:
            return math.inf
        largest = max(largest, neighbour.apart(here) / _STEP)
    return largest


def change_nearby(case: Case, engines: dict[str, Run], first: str, name: str) -> str:
    """Explanation of a disagreement: a change so close that an engine's error may cross it; else empty.

    A change of outcome, or a jump of e_n or of a spin. Each engine is run again at St and at St (1 +- SHARE RTOL).
    """
    reach = SHARE * RTOL
    for who in dict.fromkeys((first, name)):
        values = [_result(engines[who], _at(case.scene, factor), RTOL) for factor in (1 - reach, 1.0, 1 + reach)]
        outcomes = {result.outcome for result in values if not result.failure}
        if len(outcomes) > 1:
            return f"a change of outcome lies within {reach:.0e} of St (seen by {who})"
        ends = [result for result in values if not result.failure]
        if ends and max(result.apart(ends[0]) for result in ends) > 1e-3:
            return f"e_n or a spin jumps within {reach:.0e} of St (seen by {who})"
    return ""


def _of_engine(name: str, result: Result, case: Case) -> list[Issue]:
    """Issues of one engine: a ledger that does not close, a drift of L, or the wrong outcome beside a boundary.

    Beside a boundary, the outcome is compared only at distances larger than the engine's error.
    """
    issues = []
    if case.distance is not None and case.distance > SHARE * RTOL and result.outcome != case.expected:
        issues.append(
            Issue("side", (name,), f"{name} says {result.outcome} where the traced boundary says {case.expected}")
        )
    if result.more.get("residual", 0.0) > OPEN:
        issues.append(Issue("ledger", (name,), f"{name}'s ledger is open by {result.more['residual']:.1e}"))
    if case.scene.law_has("arm", "balanced") and result.more.get("drift", 0.0) > DRIFT:
        issues.append(Issue("drift", (name,), f"L drifts by {result.more['drift']:.1e} in {name}"))
    return issues


def _audited(case: Case, first: str) -> list[Issue]:
    """Issues of a certified stick that separates without its certificate.

    A trajectory that is not certified has another outcome, which its error near a boundary may explain.
    """
    try:
        ended = recorded(Problem.read(case.scene), RTOL).answers["time"][0]
        recorded(Problem.read(case.scene), RTOL, until=float(ended) + LONG)
    except ComputationError as error:
        if SEPARATES not in str(error):
            return []  # it continued until the kernel gave up
    else:
        return []
    return [Issue("certificate", (first,), f"certified by {first}, but continued it separates", "")]


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
