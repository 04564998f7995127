"""Check of the surface lever arm: its drift of angular momentum must equal the torque integral."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from casadi import SX, Function, integrator, vertcat

from ..engines.casadi.integrators import quiet
from ..errors import WetDoubletError
from ..host.thread_caches import own_cache
from ..model.phases import Flow, expressions
from .follow import Followed, follow
from .report import Finding, bounded
from .sample import REFERENCE, RTOL, Sample, place

_BOUND = 100 * RTOL  # relative to the loss and to L: two integrations of the same equations, one by quadrature


def surface_arm(group: str, sample: Sample, integral: Callable[[Followed], float] | None = None) -> Iterator[Finding]:
    """Findings for a scene with the surface lever arm: the drift, and its difference from the integral of -x F_t dt.

    Arguments:
        integral: function of a trajectory that returns the integral over the size of L(0); `torque` if None.
    """
    integral = torque if integral is None else integral
    scene = sample.scene
    if scene.model.arm != "surface" or scene.pendulum is not None:
        return
    law, statement = "dL = -int x F_t dt", "L(end) - L(0) = -(integral of x F_t dt) for the surface arm, over |L(0)|"
    if scene.pair or scene.wall:
        yield Finding(group, law, statement, "derived for equal spheres with one spin", "", None)
        return
    found: list[tuple[float, float, str]] = []
    for impact in sample.impacts:
        one = next(iter(impact.values()))
        if not scene.turns(one.angle):
            continue
        try:
            followed = follow(scene, one.stokes, one.angle, REFERENCE, RTOL)
            lost = followed.model.values("angular_momentum", followed.replayed.y, followed.p)["angular_momentum"] - 1.0
            apart = abs(lost - integral(followed))
        except WetDoubletError:
            continue  # failures are reported with the sample
        found.append((apart if math.isfinite(apart) else math.inf, abs(lost), place(one.stokes, one.angle, REFERENCE)))
    if not found:
        return
    largest = max(found, key=lambda entry: entry[1])
    yield Finding(
        group, "angular momentum", "the surface arm conserves L only to leading order: a known violation",
        f"drift {largest[1]:.1e}: a known violation of this arm", "", None, largest[2],
    )  # fmt: skip
    worst = max(found)
    yield bounded(group, law, statement, worst[0], _BOUND, worst[2])


def torque(followed: Followed) -> float:
    """-(integral of x F_t dt) over the size of L(0) along a trajectory, phase by phase."""
    total = 0.0
    for piece in followed.replayed.pieces:
        run = _torque(piece.flow, followed.tolerance.relative, followed.tolerance.absolute)
        start = vertcat(*piece.start, 0.0)
        total += float(run(x0=start, p=vertcat(followed.p, piece.duration))["xf"][-1])
    first = followed.model.values("start", followed.replayed.y, followed.p)
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
