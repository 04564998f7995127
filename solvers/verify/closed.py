"""Closed-form solutions against integration, for scenes with parts removed.

Each is derived independently of the emitted equations of motion: a momentum integral, Newton's first law, a harmonic
oscillator, an exponential. The scene's numerical values are kept.
"""

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from ..collision.collide import collide
from ..engines.casadi.integrators import IntegrationFailed, Tolerance, plain, tolerance_for
from ..errors import ComputationError
from ..model.dimensionless import Problem, nondimensionalise
from ..model.model import load, select_model
from ..model.phases import Flow, Phase
from ..scene.contact import contact_gap
from ..scene.scene import Scene
from ..scene.scenefile import written
from ..scene.schema import FIELDS, SPINS
from .report import Finding, bounded, note
from .sample import PLUGINS, RTOL, Collide, place, stokes_of

Integrators = Callable[[Flow, str, Tolerance], Callable[[np.ndarray, np.ndarray, float], np.ndarray]]
_BOUND = 1000 * RTOL  # global error of either engine, as in the comparison of engines
_ANGLE = math.radians(50)  # angle for oblique closed forms if the scene's impact is head-on
_INSTANTS = np.array([0.03, 0.1, 0.3, 1.0])
_SMALLEST, _BOUNCES = 0.02, 4  # smallest e_n and number of the compared bounces


def closed_forms(
    scene: Scene, head_on: bool = False, plain: Integrators = plain, collide: Collide = collide
) -> Iterator[Finding]:
    """Findings for every closed form that applies to the scene.

    Arguments:
        head_on: only forms without rotation.
        plain: factory of the integrator of a flow.
        collide: function that computes a bounce.
    """
    checks: list[Callable[[Scene, str, Integrators], tuple[float, str]]] = [partial(film_alone, collide=collide)]
    if not head_on and scene.partner is not None:
        for name, statement in _FORMS[1:3]:
            yield note(name, statement, "derived for equal spheres only")
    elif not head_on:
        checks += [straight_line, spin_relaxes, *([swinging] if scene.pendulum is not None else [])]
    for (name, statement), check in zip(_FORMS, checks, strict=False):
        worst = (-1.0, "")
        for engine in PLUGINS:
            try:
                figure, where = check(scene, engine, plain)
            except (ComputationError, IntegrationFailed) as failure:
                figure, where = math.inf, f"{engine}: {failure}"
            worst = max(worst, (figure if math.isfinite(figure) else math.inf, where))
        yield bounded(name, statement, worst[0], _BOUND, worst[1])


_FORMS = (
    (
        "film alone",
        "film and solids alone, head-on: approach, rebound, e_n by -u/v0 = 1 - [ln(1/s) - 3/2 + 2s - s^2/2]/St",
    ),
    (
        "straight line",
        "liquid, bridge, attraction and strings taken away: the centres move on a straight line, r(t)^2 and beta(t)",
    ),
    (
        "spin relaxes",
        "gap held: omega - xi = omega0 exp(-k t), k = 8 pi mu a^2 ln(2a/x) [1/r + 5 r/(32 a^2)]/m; then one rigid body",
    ),
    (
        "swinging",
        "liquid taken away, small angles: the centres' difference from the pivots' is a harmonic oscillator, sqrt(g/l)",
    ),
)


def film_loss(s: float) -> float:
    """Lf(s), St times the loss of -u/v0 between x0 and s x0, for the film alone."""
    return math.log(1 / s) - 1.5 + 2 * s - s * s / 2


def _bare(scene: Scene) -> Scene:
    """The scene without bridge, attraction, strings, spins, and without a user's model."""
    tables = _of_the_library(scene, without=("bridge", "attraction", "pendulum"))
    tables["impact"] = {name: value for name, value in tables["impact"].items() if f"impact.{name}" not in SPINS}
    return Scene.from_dict(tables)


def _of_the_library(scene: Scene, without: tuple[str, ...]) -> dict[str, Any]:
    """The tables of a scene but for some, without a user's model: its quantities, and the default for its laws."""
    tables: dict[str, Any] = {"name": scene.name} if scene.name else {}
    for entry, value in scene.given:
        table, _, key = entry.partition(".")
        common = entry in FIELDS and (not FIELDS[entry].choices or value in FIELDS[entry].choices)
        if common and table not in without:
            tables.setdefault(table, {})[key] = written(entry, value)
    return tables


def film_alone(scene: Scene, engine: str, plain: Integrators = plain, collide: Collide = collide) -> tuple[float, str]:
    """Largest error of u(s) on approach, of e_n and of the gap at rebound, with its place."""
    bare = _bare(scene)
    worst = max(_approach(bare, factor * stokes_of(bare), engine, plain) for factor in (0.3, 1.0, 4.0))
    bounced = 0
    # Stokes numbers about the one at which the film just stops the pair at the roughness
    critical = film_loss(bare.particles.roughness / bare.liquid.film_thickness)
    critical *= 1 + 1 / max(bare.particles.dry_restitution, 0.2)
    for stokes in np.geomspace(1e-3 * critical, 30 * critical, 60).tolist():
        n = nondimensionalise(bare, bare.speed_of(stokes), 0.0)
        gap = _rebound(n, bare.law_has("glass", "rim"))
        loss = film_loss(gap) / stokes
        expected = bare.particles.dry_restitution * (1 - loss) - loss
        if gap == 1 or expected < _SMALLEST or bounced == _BOUNCES:
            continue
        bounced += 1
        collision = collide(bare, stokes=stokes, angle=0.0, rtol=RTOL, engine=engine)
        error = abs(collision.restitution - expected)
        if collision.smallest_gap is not None:
            error = max(error, abs(collision.smallest_gap / n.length / gap - 1))
        worst = max(worst, (error, place(stokes, 0.0, engine, collision.reversal or "")))
    return worst


def _approach(bare: Scene, stokes: float, engine: str, plain: Integrators) -> tuple[float, str]:
    """Error of -u/v0 against the closed form on approach, at several instants."""
    n = nondimensionalise(bare, bare.speed_of(stokes), 0.0)
    flow, start = Flow(select_model(bare, oblique=False), Phase(1, 1, 0)), np.array([1.0, -1.0])
    contact, errors = contact_gap(n.groups), [0.0]
    for time in _INSTANTS.tolist():
        gap, normal_velocity = _integrated(plain, flow, engine, n, start, time)
        if gap > contact:  # within the range that trajectories reach
            errors.append(abs(-normal_velocity - (1 - film_loss(gap) / stokes)))
    return max(errors), place(stokes, 0.0, engine, "approach")


def _rebound(n: Problem, rim: bool) -> float:
    """The first gap on approach at which a rebound criterion is met, by a scan and bisection of the closed form."""
    stokes, limit = n.groups["stokes"], n.groups["glass_number"]
    contact = contact_gap(n.groups)
    if contact >= 1:
        return 1.0

    def clear(s: float) -> bool:
        return (1 - film_loss(s) / stokes) * (1 / s**2 - rim) < limit

    outer = 1.0
    if not clear(outer):
        return outer
    for inner in np.geomspace(1.0, contact, 4001)[1:].tolist():
        if not clear(inner):
            break
        outer = inner
    else:
        return contact
    for _ in range(80):
        middle = 0.5 * (outer + inner)
        outer, inner = (middle, inner) if clear(middle) else (outer, middle)
    return outer


def _oblique(scene: Scene) -> Problem:
    """Dimensionless groups of the scene's impact, or of an oblique one if it is head-on."""
    return nondimensionalise(scene, scene.speed_of(stokes_of(scene)), scene.angle or _ANGLE)


def straight_line(scene: Scene, engine: str, plain: Integrators = plain) -> tuple[float, str]:
    """Error of r and beta of free spheres, over r0 and 1 rad, at several instants."""
    bare = _bare(scene)
    n = _oblique(bare)
    flow = Flow(select_model(bare, oblique=True, full=True), Phase(0, 0, 0), ("rotation",))
    start = np.array([1.0, 1.0, (4 + n.groups["aspect"]) ** 2, 0.0, 0.0])  # opening, or they would meet
    aspect, tangent = n.groups["aspect"], n.groups["obliquity"]
    distance = (4 + aspect) / aspect  # in x0; the tangential speed over v0 is tan(theta0) r0/(4a)
    sideways = tangent * (4 + aspect) / 4
    worst = (-1.0, "")
    longest = 5 * distance / math.hypot(1.0, sideways)
    for time in (longest * _INSTANTS).tolist():
        y = _integrated(plain, flow, engine, n, start, time)
        ahead, aside = distance + time, sideways * time
        errors = (abs((y[0] + 4 / aspect) / math.hypot(ahead, aside) - 1), abs(y[4] - math.atan2(aside, ahead)))
        worst = max(worst, (max(errors), place(n.stokes, n.angle, engine, f"{time:.3g} x0/v0")))
    return worst


def spin_relaxes(scene: Scene, engine: str, plain: Integrators = plain) -> tuple[float, str]:
    """Error of the slip and of the final rigid rotation, at several constant gaps in the film."""
    bare = _bare(scene).with_entries({"model.arm": "midgap"})
    n = _oblique(bare)
    choice = select_model(bare, oblique=True, full=True)
    flow, edge = Flow(choice, Phase(1, 1, 0, resting=True)), float(load(choice).laws.shear.edge(n.groups["aspect"]))
    a, m, mu = bare.particles.reduced_radius, bare.particles.reduced_mass, bare.liquid.viscosity
    worst = (-1.0, "")
    outer, contact = min(edge, 1.0), contact_gap(n.groups)
    for gap in (min(max(depth * outer, contact), 0.9 * outer) for depth in (0.5, 0.05)):  # as deep as the solids allow
        x = gap * n.length
        reach = n.length if bare.law_has("shear", "rim") else 2 * a
        r = 4 * a + x
        # m r domega/dt = -F_t and (16/5) m a^2 dxi/dt = F_t r/2, with F_t = 8 pi mu a^2 (omega - xi) ln(reach/x)
        decay = 8 * math.pi * mu * a**2 * math.log(reach / x) / m * (1 / r + 5 * r / (32 * a**2))
        start = np.array([gap, 0.0, (4 + n.groups["aspect"] * gap) ** 2, 0.0])
        for time in (3.0 / decay / n.time * np.array([0.1, 1.0, 10.0])).tolist():
            y = _integrated(plain, flow, engine, n, start, time)
            rate = y[2] / (r / a) ** 2
            slip = math.exp(-decay * time * n.time)
            rigid = (r / a) ** 2 / ((r / a) ** 2 + 6.4)  # over the first rate, at the same angular momentum
            spin = rigid * (1 - slip)
            error = max(abs(rate - y[3] - slip), abs(y[3] - spin))
            worst = max(worst, (error, place(n.stokes, n.angle, engine, f"x = {gap:.3g} x0")))
    return worst


def swinging(scene: Scene, engine: str, plain: Integrators = plain) -> tuple[float, str]:
    """Error of r and beta of dry spheres on strings at small angles, over r0 and 1 rad, up to a third of a swing."""
    assert scene.pendulum is not None
    dry = Scene.from_dict(_of_the_library(scene, without=("bridge",))).with_entries({"pendulum.law": "small-angle"})
    n = _oblique(dry)
    flow = Flow(select_model(dry, oblique=True, full=True), Phase(0, 0, 0))
    a, aspect = dry.particles.reduced_radius, n.groups["aspect"]
    start = np.array([1.0, 1.0, (4 + aspect) ** 2, 0.0, 0.0])
    swing = math.sqrt(scene.pendulum.gravity / scene.pendulum.length)  # rad/s
    sideways = n.speed * n.groups["obliquity"] * (4 + aspect) / 4
    worst = (-1.0, "")
    for share in _INSTANTS.tolist():
        phase = share * min(2.0, 2 * a * swing / math.hypot(n.speed, sideways))  # radians; stays in front of the pivots
        across = 4 * a + n.length * math.cos(phase) + n.speed / swing * math.sin(phase)
        aside = sideways / swing * math.sin(phase)
        y = _integrated(plain, flow, engine, n, start, phase / swing / n.time)
        r = 4 * a + y[0] * n.length
        names = list(flow.model.state)
        error = max(abs(r / math.hypot(across, aside) - 1), abs(y[names.index("rotation")] - math.atan2(aside, across)))
        worst = max(worst, (error, place(n.stokes, n.angle, engine, f"phase {phase:.3g}")))
    return worst


def _integrated(plain: Integrators, flow: Flow, engine: str, n: Problem, start: np.ndarray, time: float) -> np.ndarray:
    p = flow.model.group_values(n.groups)
    return plain(flow, engine, tolerance_for(RTOL, engine, n.groups))(start, p, time)
