"""Conservation of energy and angular momentum along every trajectory, and agreement of the engines."""

import math
from collections.abc import Callable, Iterator, Sequence

from casadi import SX, Function, integrator, vertcat

from ..collision.collide import collide
from ..collision.result import Collision
from ..engines.casadi.integrators import quiet
from ..engines.settings import ENGINES
from ..errors import WetDoubletError
from ..host.thread_caches import own_cache
from ..model.phases import Flow, expressions
from .backward import Replayed, replayed
from .report import Finding, bounded, note
from .sample import REFERENCE, RTOL, Sample, place, where

# In units of the sample's rtol. A linear invariant is conserved by every step up to rounding and Newton's residual;
# the ledger is a sum of quadratures with the integrator's error; between engines both errors add. The torque integral
# is relative to the loss and to L: two integrations of the same equations, one by quadrature.
DRIFT, RESIDUAL, AGREEMENT, _TORQUE = 10 * RTOL, 100 * RTOL, 1000 * RTOL, 100 * RTOL
_NUDGE, _WORST_CONDITION = 1e-5, 1e4


def conserved(sample: Sample) -> Iterator[Finding]:
    """Findings on completed trajectories, ledger, drift and agreement of the engines, each with its worst case."""
    completed = f"{len(sample.all)} of {len(sample.failures) + len(sample.all)} collisions"
    failures = tuple(f"  {text}" for text in sample.failures[:5])
    statement = "every collision of the sample is completed"
    yield Finding("", "completed", statement, completed, "", not sample.failures, about=failures)
    if not sample.all:
        return
    figure, worst = _worst(
        sample.all, lambda one: abs(one.energy.residual) / one.energy.initial if one.energy else None
    )
    statement = "T(0) = T(end) + losses + works: residual over T(0)"
    yield bounded("energy ledger", statement, figure, RESIDUAL, where(worst))
    statement = "L is conserved: |L/L(0) - 1| where the spin is integrated, not eliminated"
    drifting = [one for one in sample.all if one.angular_momentum_drift is not None]
    if sample.scene.pendulum is not None and any(one.angle for one in sample.all):
        yield note("angular momentum", statement, "the strings exert a torque: L is not conserved")
    elif drifting and sample.scene.model.arm != "surface":
        figure, worst = _worst(drifting, lambda one: one.angular_momentum_drift)
        yield bounded("angular momentum", statement, figure, DRIFT, where(worst))
    for engine, reference in (*((each, REFERENCE) for each in ENGINES if each != REFERENCE), ("taylor", "cvodes")):
        pairs = [
            (impact[engine], impact[reference])
            for impact in sample.impacts
            if engine in impact and reference in impact and impact[engine].engine == engine
        ]
        if pairs:
            yield agreement(f"{engine} = {reference}", pairs)


def _worst(collisions: Sequence[Collision], figure: Callable[[Collision], float | None]) -> tuple[float, Collision]:
    """The largest figure, infinite where it is missing or not finite, and its collision."""
    figures = [value if (value := figure(one)) is not None and math.isfinite(value) else math.inf for one in collisions]
    largest = max(figures)
    return largest, collisions[figures.index(largest)]


def agreement(name: str, pairs: Sequence[tuple[Collision, Collision]]) -> Finding:
    """Finding on collisions by one engine, each beside the same by another: the worst in outcome and e_n."""
    judged = [(_apart(one, other), _allowed(one, other), one) for one, other in pairs]
    figure, bound, one = max(judged, key=lambda entry: entry[0] / entry[1])
    statement = f"same outcome, and e_n apart by no more than {AGREEMENT:.0e} times its condition d ln e_n/d ln St"
    return bounded(name, statement, figure, bound, where(one))


def _apart(one: Collision, other: Collision) -> float:
    if one.outcome != other.outcome:
        return math.inf
    return abs(one.restitution - other.restitution) / (abs(other.restitution) or 1.0)


def _allowed(one: Collision, other: Collision) -> float:
    """The bound AGREEMENT; where exceeded, multiplied by the conditioning of e_n, which diverges towards a boundary."""
    if not AGREEMENT < _apart(one, other) < math.inf:
        return AGREEMENT
    nudged = [other.stokes * (1 + side * _NUDGE) for side in (-1, 1)]
    try:
        below, above = (
            collide(other.scene, stokes=stokes, angle=other.angle, rtol=RTOL, engine=REFERENCE).restitution
            for stokes in nudged
        )
    except WetDoubletError:
        return AGREEMENT
    condition = abs(above - below) / (2 * _NUDGE * other.restitution)
    return AGREEMENT * min(max(condition, 1.0), _WORST_CONDITION)


def surface_arm(sample: Sample, integral: Callable[[Replayed], float] | None = None) -> Iterator[Finding]:
    """Findings for a scene with the surface lever arm: the drift, and its difference from the integral of -x F_t dt.

    Arguments:
        integral: function of a trajectory that returns the integral over the size of L(0); `torque` if None.
    """
    scene = sample.scene
    if scene.model.arm != "surface" or scene.pendulum is not None:
        return
    law, statement = "dL = -int x F_t dt", "L(end) - L(0) = -(integral of x F_t dt) for the surface arm, over |L(0)|"
    if scene.pair or scene.wall:
        yield note(law, statement, "derived for equal spheres with one spin")
        return
    drifts: list[tuple[float, float, str]] = []
    for impact in sample.impacts:
        one = next(iter(impact.values()))
        if not scene.turns(one.angle):
            continue
        try:
            path = replayed(scene, one.stokes, one.angle)
            drift = path.model.values("angular_momentum", path.end, path.p)["angular_momentum"] - 1.0
            apart = abs(drift - (integral or torque)(path))
        except WetDoubletError:
            continue  # failures are reported with the sample
        drifts.append(
            (apart if math.isfinite(apart) else math.inf, abs(drift), place(one.stokes, one.angle, REFERENCE))
        )
    if not drifts:
        return
    _, largest, at = max(drifts, key=lambda entry: entry[1])
    statement_on_drift = "the surface arm conserves L only to leading order: a known violation"
    yield note("angular momentum", statement_on_drift, f"drift {largest:.1e}: a known violation of this arm", at)
    apart, _, at = max(drifts)
    yield bounded(law, statement, apart, _TORQUE, at)


def torque(path: Replayed) -> float:
    """-(integral of x F_t dt) over the size of L(0) along a trajectory, phase by phase."""
    total = 0.0
    for piece in path.pieces:
        run = _torque(piece.flow, path.tolerance.relative, path.tolerance.absolute)
        total += float(run(x0=vertcat(*piece.start, 0.0), p=vertcat(path.p, piece.duration))["xf"][-1])
    first = path.model.values("start", path.end, path.p)
    return total / (abs(first["orbital_momentum"]) + 6.4 * abs(first["spin"]))


@own_cache(32)
def _torque(flow: Flow, relative: float, absolute: float) -> Function:
    """Integrator of a flow and of -x F_t: F_t = 8 pi mu a^2 (omega - xi) times the law's logarithm, in the groups."""
    parts, model = expressions(flow), flow.model
    gap, aspect = model.state["gap"], model.groups["aspect"]
    slip = model.state["orbital_momentum"] / (4 + aspect * gap) ** 2 - model.state["spin"]
    # 8 pi mu a^2 = (4/3) m v0/St, and rates of L are over m a^2 Omega v0/x0
    force = flow.region.shear * 4 * aspect / (3 * model.groups["stokes"]) * slip
    force *= model.laws.shear.log_factor(gap, aspect)
    duration = SX.sym("duration")
    dae = {
        "x": vertcat(parts.variables, SX.sym("torque")),
        "p": vertcat(model.parameters, duration),
        "ode": duration * vertcat(parts.rates, -aspect * gap * force),
    }
    with quiet():
        return integrator("torque", "rosenbrock", dae, 0, 1, {"reltol": relative, "abstol": absolute})
