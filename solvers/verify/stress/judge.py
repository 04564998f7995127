"""One case of the stress test: computation by all engines, and comparison of the results."""

from __future__ import annotations

import math
import re
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ....generated.automaton import OUTCOMES
from ...certificates import Certainty, NoCertificate
from ...collision.by_casadi import by_casadi
from ...engines.casadi.locate import CHATTERS
from ...engines.taylor.build import Variant
from ...engines.taylor.call import variant_for_many
from ...errors import ComputationError, ModelWarning
from ...many.collide_many import collide_many
from ...model.model import load, select_model
from ...model.phases import Phase
from ...model.validity import remarks
from ...scene.scene import Scene
from .answers import Impact, answer, dimensionless
from .located import LocatedTrajectories
from .scipy_engine import ScipyLocator
from .verdict import FAST, RTOL, Case, Found, Issue, Verdict, physical_reason

SHARE = 1e3  # assumed bound of an engine's error in units of rtol, times the conditioning
FLOOR = 1e-12  # assumed bound of rounding errors, times the conditioning
OPEN = 1e-5  # largest residual, relative to the ledger's largest term
DRIFT = 1e-6
PATIENCE, GIVEN_UP = 0.5, "given up"  # s of CPU time for a scipy method
_STEP = 1e-6  # relative step in St for the conditioning
_AUDIT = 100  # phases and intervals for which a certified stick is continued
PEER = "LSODA"  # scipy's failures do not count as ours
_LOCATED = LocatedTrajectories()
_PARTICULAR = re.compile(r" = .* is (?=above|below)| \(.*")  # value and source of a remark


def fast(scene: Scene, rtol: float) -> Found:
    """Result of `collide_many` with the fastest engine."""
    names = _spins_of(scene)
    data = collide_many(scene, rtol=rtol, engine=FAST, of=("outcome", "restitution", *names))
    outcome = int(data["outcome"].values[0])
    if outcome < 0:
        raise ComputationError(str(data["reason"].values[0]))
    found = Found(OUTCOMES[outcome], float(data["restitution"].values[0]), bool(data["certified"].values[0]))
    return replace(found, spins=_surface_speeds(scene, *(float(data[name].values[0]) for name in names)))


def _spins_of(scene: Scene) -> tuple[str, ...]:
    """Names of the spins that a collision of the scene has."""
    second = scene.pair or scene.impact.partner_spin is not None
    return ("final_spin", "final_spin_partner") if second else ("final_spin",)


def _surface_speeds(scene: Scene, *spins: float | None) -> tuple[float, ...]:
    """Spins times radii over the initial relative speed; 0 for one that a stick or a head-on collision has not."""
    speed, angle = scene.need_impact()
    radius, given = 2 * scene.particles.reduced_radius, (scene.impact.spin, scene.impact.partner_spin)
    radii = radius, radius * (scene.radius_ratio or 1.0)
    fast = speed / math.cos(angle) + sum(abs(spin or 0.0) * size for spin, size in zip(given, radii, strict=True))
    sizes = zip(spins, radii, strict=False)
    return tuple(0.0 if spin is None or math.isnan(spin) else spin * size / fast for spin, size in sizes)


def fast_kernel(scene: Scene) -> Variant:
    """The kernel variant of a scene."""
    oblique = dimensionless(scene, Impact(float(scene.stokes or 0.0), float(scene.angle or 0.0))).oblique
    return variant_for_many(scene, oblique, RTOL, rotation=False)


def chained(scene: Scene, rtol: float, plugin: str = "cvodes") -> Found:
    """Result as by `collide` with its ledger; located once for both engines, with the cost charged to each."""
    n = dimensionless(scene, Impact(float(scene.stokes or 0.0), float(scene.angle or 0.0)))
    spared = _LOCATED.spared
    one = by_casadi(scene, n, rtol, plugin, True, False, _LOCATED.find)
    spared = _LOCATED.spared - spared
    more: dict[str, float] = {}
    if one.energy is not None:
        terms = one.energy.to_dict()
        more["residual"] = abs(terms["residual"]) / max(abs(value) for value in terms.values())
    if one.angular_momentum_drift is not None:
        more["drift"] = one.angular_momentum_drift
    spins = _surface_speeds(scene, *(getattr(one, name) for name in _spins_of(scene)))
    return Found(one.outcome, one.restitution, one.certified, cpu=spared, more=more, spins=spins)


class Limited(ScipyLocator):
    """A scipy locator that stops after PATIENCE seconds of CPU time."""

    def _integrated(self, rates: Any, start: float, end: float, y: np.ndarray, more: dict[str, Any]) -> Any:
        if not hasattr(self, "_until"):
            self._until = time.process_time() + PATIENCE

        def limited(t: float, state: np.ndarray) -> Any:
            if time.process_time() > self._until:
                raise self._error(f"{GIVEN_UP} after {PATIENCE:g} s of {self.method}", "")
            return rates(t, state)

        return super()._integrated(limited, start, end, y, more)  # type: ignore[arg-type]  # called like a Bound


def by_scipy(scene: Scene, rtol: float, method: str = "LSODA") -> Found:
    """Result by a scipy method, with scipy's event location."""
    impact = Impact(float(scene.stokes or 0.0), float(scene.angle or 0.0))
    n = dimensionless(scene, impact)
    path = Limited(load(select_model(scene, n.oblique)), n.groups, rtol, method).run()
    said = answer(path)
    if said.restitution < 0:
        raise ComputationError(f"{method} takes the start for its end")  # a step smaller than the rounding of x0
    spins = (said.spins[name] * n.rate for name in _spins_of(scene) if name in said.spins)
    return Found(said.outcome, said.restitution, path.certified, spins=_surface_speeds(scene, *spins))


Run = Callable[[Scene, float], Found]


def runs() -> dict[str, Run]:
    """The compared engines; the first is the one under test."""
    found: dict[str, Run] = {FAST: fast}
    if FAST != "rosenbrock":
        found["rosenbrock"] = lambda scene, rtol: chained(scene, rtol, "rosenbrock")
    found["cvodes"] = chained
    found[PEER] = lambda scene, rtol: by_scipy(scene, rtol / 10)
    return found


def judge(case: Case, engines: dict[str, Run] | None = None) -> Verdict:
    """Run every engine on a case and compare the results.

    Arguments:
        engines: engines by name, the one under test first; `runs()` if None.
    """
    from .lines import judge_lines

    _LOCATED.forget()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # counted, and reported once for all cases
        verdict = judge_lines(case) if case.angles else _judged(case, runs() if engines is None else engines)
    return replace(verdict, remarks=tuple(_PARTICULAR.sub(" ", each).strip() for each in remarks(case.scene)))


def _judged(case: Case, engines: dict[str, Run]) -> Verdict:
    found: dict[str, Found] = {}
    for name, run in engines.items():
        found[name] = _timed(run, case.scene, RTOL)
        if CHATTERS in found[name].failure:
            break  # the others share the rules of the event location and would chatter too
    issues: list[Issue] = [
        Issue("peer" if name == PEER else "failure", (name,), each.failure, _physical(each.failure, name, case))
        for name, each in found.items()
        if each.failure
    ]
    there = {name: each for name, each in found.items() if not each.failure}
    first = next(iter(there), None)
    error = slope = None
    if first is not None and len(there) > 1:
        differs = [name for name in there if there[name].outcome != there[first].outcome]
        slope = _conditioning(engines[first], case.scene, there[first])
        for name in differs:
            said = f"{first} says {there[first].outcome}, {name} {there[name].outcome}"
            issues.append(Issue("outcome", (first, name), said, _beside(case, engines, first, name)))
        same = [there[name].restitution for name in there if name not in differs]
        error = max(same) - min(same)
        for name in there:
            if name not in differs:
                issues += _compared(case, engines, first, name, there, slope)
    issues += _sides(case, there)
    for name, each in there.items():
        issues += _ledger(name, each, case)
    if first is not None and there[first].certified:
        issues += _audited(case, engines, first)
    return Verdict(case, found, tuple(issues), error, slope)


def _timed(run: Run, scene: Scene, rtol: float) -> Found:
    start = time.process_time()
    try:
        found = run(scene, rtol)
    except ComputationError as error:
        found = Found(failure=str(error))
    except Exception as error:  # noqa: BLE001 # a defect is what this is looking for
        found = Found(failure=f"internal error: {type(error).__name__}: {error}")
    return replace(found, cpu=found.cpu + time.process_time() - start)


def _physical(failure: str, engine: str, case: Case) -> str:
    """The physical reason of a failure; empty if there is none. The engine under test must not fail near a boundary."""
    if engine != FAST and case.distance is not None and case.distance <= SHARE * RTOL:
        return f"within {SHARE * RTOL:.0e} of a boundary, where the trajectory passes a saddle or a graze"
    return physical_reason(failure)


def _at(scene: Scene, factor: float) -> Scene:
    return scene.with_impact(stokes=float(scene.stokes or 0.0) * factor)


def _conditioning(run: Run, scene: Scene, here: Found) -> float:
    """|d/d ln St| of e_n and spins over a small step, the largest of both sides; at least 1. inf at a change."""
    largest = 1.0
    for factor in (1 - _STEP, 1 + _STEP):
        there = _timed(run, _at(scene, factor), RTOL)
        if there.failure:
            continue
        if there.outcome != here.outcome:
            return math.inf
        largest = max(largest, there.apart(here) / _STEP)
    return largest


def _compared(case: Case, engines: dict[str, Run], first: str, name: str, there: dict[str, Found],
              slope: float) -> list[Issue]:  # fmt: skip
    """Issue if two engines' e_n or final spins differ by more than their bounds."""
    bound = (SHARE * RTOL + FLOOR) * slope
    if there[first].apart(there[name]) <= bound:
        return []
    both = [
        " ".join(f"{value:.12g}" for value in (each.restitution, *each.spins)) for each in (there[first], there[name])
    ]
    said = f"e_n and spins {both[0]} by {first}, {both[1]} by {name}"
    kind = "restitution" if abs(there[first].restitution - there[name].restitution) > bound else "spin"
    return [Issue(kind, (first, name), said, _beside(case, engines, first, name))]


def _beside(case: Case, engines: dict[str, Run], first: str, name: str) -> str:
    """Explanation of a disagreement: a change of outcome within the error bound of either engine; else empty.

    Both engines are run again within that error in St, then at a tolerance a thousand times smaller.
    """
    reach = SHARE * RTOL
    for who in (first, name):
        values = [_timed(engines[who], _at(case.scene, factor), RTOL) for factor in (1 - reach, 1.0, 1 + reach)]
        outcomes = {each.outcome for each in values if not each.failure}
        if len(outcomes) > 1:
            return f"a change of outcome lies within {reach:.0e} of St (seen by {who})"
        ends = [each for each in values if not each.failure]
        if ends and max(each.apart(ends[0]) for each in ends) > 1e-3:
            return f"e_n jumps within {reach:.0e} of St (seen by {who})"
    return ""


def _sides(case: Case, there: dict[str, Found]) -> list[Issue]:
    """Issues of engines that miss the expected outcome beside a boundary at a distance larger than their error."""
    if case.expected is None or case.distance is None or case.distance <= SHARE * RTOL:
        return []
    return [
        Issue("side", (name,), f"{name} says {each.outcome} where the traced boundary says {case.expected}")
        for name, each in there.items()
        if each.outcome != case.expected
    ]


def _ledger(name: str, each: Found, case: Case) -> list[Issue]:
    """Issues of an energy ledger that does not close, or of angular momentum that is not conserved."""
    issues = []
    if each.more.get("residual", 0.0) > OPEN:
        issues.append(Issue("ledger", (name,), f"{name}'s ledger is open by {each.more['residual']:.1e}"))
    if case.scene.model.arm == "midgap" and each.more.get("drift", 0.0) > DRIFT:
        issues.append(Issue("drift", (name,), f"L drifts by {each.more['drift']:.1e} in {name}"))
    return issues


class Audit(NoCertificate):
    """A locator without certificates, which integrates until no event is left or for a long time."""

    def __init__(self) -> None:
        self._phase: Phase | None = None
        self._quiet = self._asked = 0

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        self._quiet, self._phase = (self._quiet + 1 if phase == self._phase else 0), phase
        self._asked += 1
        return Certainty.of(self._quiet >= 4 or self._asked > _AUDIT)


def _audited(case: Case, engines: dict[str, Run], first: str) -> list[Issue]:
    """Issues of a certified stick that separates when continued without certificate from the certified state.

    A trajectory that does not reach that state has another outcome, which its error near a boundary may explain.
    """
    n = dimensionless(case.scene, Impact(float(case.scene.stokes or 0.0), float(case.scene.angle or 0.0)))
    try:
        locator: Any = _LOCATED.handed_out(load(select_model(case.scene, n.oblique, fold=True)), n.groups, RTOL)
        proved = locator.path.certified
        locator.proof = Audit()
        locator.watch = replace(locator.watch, certificate=None)
        path = locator.run() if proved else locator.path
    except ComputationError:
        return []  # it continued until the integrator failed
    if not path.separated:
        return []
    said = f"certified by {first}, but continued it ends as {path.outcome}"
    return [Issue("certificate", (first,), said, "" if proved else _beside(case, engines, first, first))]
