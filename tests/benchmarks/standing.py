"""One problem differentiated through its events by several libraries, far from a graze and near it.

python -m tests.benchmarks.standing [FILE]    (pip install -e '.[bench]')

writes its tables between the marks of FILE, by default docs/engineering/standing.md.

Granulation at 0.8 rad. Above a Stokes number the film's pressure reaches the glass transition and the pair rebounds;
just above, the criterion is met for a short time only (a graze). All get the emitted equations of this scene, and give
e_n and its derivatives by the logarithms of speed and viscosity.
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from wetdoublet.solvers import ComputationError, Scene, boundary, collide
from wetdoublet.solvers.formatting.markdown import table
from wetdoublet.solvers.host.environment import environment, one_core
from wetdoublet.solvers.model.model import load, select_model

from .measured.answers import Impact
from .measured.gradient_task import Gradients
from .measured.peers.translated import translated

ROOT = Path(__file__).resolve().parents[2]
BEGIN = "<!-- standing: written by `python -m tests.benchmarks.standing` -->"
END = "<!-- end of standing -->"
PRESET, ANGLE, NAMES = "granulation", 0.8, ("impact.speed", "liquid.viscosity")
DISTANCES = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
"""Relative distances above the Stokes number of the graze."""
RTOL = 1e-9
STEP = 1e-5  # of differences, relative
HORIZON, EVENTS, MOST = 1e4, ("glass", "solid", "rupture", "film_edge"), 100_000
Found = tuple[float, np.ndarray]
"""e_n, and its derivatives by the logarithms of NAMES."""


def tasks() -> list[Gradients]:
    """A collision at each distance."""
    scene = Scene.load(PRESET)
    (graze,) = (each for each in boundary(scene, angle=ANGLE).changes[0] if each.kind == "graze")
    return [Gradients(scene, (Impact(graze.stokes * (1 + each), ANGLE),), NAMES) for each in DISTANCES]


def by_sensitivities(engine: str, rtol: float, asked: Gradients) -> Found:
    """`sensitivities`, as a user calls it."""
    impact = asked.impacts[0]
    e_n = collide(asked.scene, stokes=impact.stokes, angle=impact.angle, engine=engine, rtol=rtol).restitution
    return e_n, asked.by_casadi("forward", engine, rtol)[0]


def by_diffrax(asked: Gradients) -> Found:
    """`jacfwd` through diffrax's events: `measured/peers/diffrax_gradient.py`; the value from its engine."""
    from .measured.peers.diffrax_engine import collisions
    from .measured.peers.diffrax_gradient import of_task

    (answer,) = _read(collisions(asked.scene, asked.impacts, RTOL))
    return getattr(answer, "restitution", math.nan), of_task(asked, 1, RTOL)()[0]


def by_cvode(asked: Gradients) -> Found:
    """CVODE's own root finding by scikit-sundae, which has no sensitivities: central differences."""
    from .measured.peers.sundials_engine import Sundae

    choice = select_model(asked.scene, True)

    def at(theta: np.ndarray) -> float:
        groups = dict(zip(asked.groups, _groups(asked) + asked.slopes[0] @ theta))
        path = Sundae(load(choice), groups, RTOL).run()
        return float(path.y[1]) if path.separated else 0.0

    moved = [(at(+STEP * row) - at(-STEP * row)) / (2 * STEP) for row in np.eye(len(NAMES))]
    return at(np.zeros(len(NAMES))), np.array(moved)


def by_casadi_events(plugin: str, asked: Gradients) -> Found:
    """CasADi's own events (`zero` and `transition` of `integrator`), differentiated by CasADi.

    It has no event that ends an integration: at separation a switch among the states halts the motion.
    """
    theta = ca.MX.sym("theta", len(NAMES))
    groups = _groups(asked) + ca.mtimes(ca.DM(asked.slopes[0]), theta)
    final = _integrator(plugin)(x0=_start()(groups), p=groups)["xf"]
    call = ca.Function("gradient", [theta], [final[1], ca.jacobian(final[1], theta), final[-1]])
    e_n, slope, going = call(0)
    if float(going):
        raise ComputationError("does not come to an end")
    return float(e_n), np.asarray(slope.full())[0]


def _groups(asked: Gradients) -> np.ndarray:
    return np.array([asked.numbers[0].groups[name] for name in asked.groups])


def _model() -> tuple[Any, Any, tuple[str, ...]]:
    choice = select_model(Scene.load(PRESET), True)
    return *translated(choice, lambda word: getattr(ca, word)), tuple(load(choice).groups)


def _start() -> ca.Function:
    structure, laws, names = _model()
    p = ca.SX.sym("p", len(names))
    first = structure.start({}, dict(zip(names, ca.vertsplit(p))), laws)
    return ca.Function("start", [p], [ca.vertcat(*first.values(), 1, 1)])


def _integrator(plugin: str) -> ca.Function:
    structure, laws, names = _model()
    count = len(structure.STATES)
    x, p, t, index = ca.SX.sym("x", count + 2), ca.SX.sym("p", len(names)), ca.SX.sym("t"), ca.SX.sym("index")
    state, groups = dict(zip(structure.STATES, ca.vertsplit(x))), dict(zip(names, ca.vertsplit(p)))
    film, going = x[count], x[count + 1]
    rates = structure.right_hand_side(state, groups, laws, film, 1)
    of = structure.events(state, groups, laws)
    zero = [of["glass"], ca.fmin(of["elastic"], of["rough"]), of["rupture"], (2 * film - 1) * of["film_edge"]]
    after = ca.vertcat(x[0], ca.if_else(index < 2, -groups["dry_restitution"], 1) * x[1], x[2:count])
    after = ca.vertcat(after, ca.if_else(index == 3, 1 - film, film), ca.if_else(index == 2, 0, going))
    dae = {"x": x, "p": p, "t": t, "ode": ca.vertcat(going * ca.vertcat(*rates.values()), 0, 0)}
    dae["zero"] = ca.vertcat(*zero)
    given = {"index": index, "t": t, "x": x, "p": p, "post_x": after}
    jump = ca.Function("transition", given, ["index", "t", "x", "z", "p", "u"], ["post_x", "post_z"])
    options = {"reltol": RTOL, "abstol": 1e-3 * RTOL, "max_num_steps": MOST, "transition": jump, "max_events": 20}
    return ca.integrator("trajectory", plugin, dae, 0, [HORIZON], options)


@dataclass(frozen=True)
class Peer:
    """What is compared, and the modules it needs."""

    name: str
    run: Callable[[Gradients], Found]
    needs: tuple[str, ...] = ()


PEERS = (
    Peer("wetdoublet, Taylor kernel", partial(by_sensitivities, "taylor", RTOL)),
    Peer("wetdoublet, rosenbrock", partial(by_sensitivities, "rosenbrock", RTOL)),
    Peer("CasADi's events, rosenbrock", partial(by_casadi_events, "rosenbrock")),
    Peer("CasADi's events, cvodes", partial(by_casadi_events, "cvodes")),
    Peer("diffrax", by_diffrax, ("diffrax",)),
    Peer("scikit-sundae, differences", by_cvode, ("sksundae", "numba")),
)


TIMES = (0.5, 0.6, 0.7, 1.0)
SEARCHES = (("rosenbrock", 3), ("cvodes", 3), ("idas", 3), ("idas", 50), ("rk", 3), ("rk", 50), ("collocation", 3),
            ("collocation", 50))  # fmt: skip
"""CasADi's plugins, and the iterations of their event search (`max_event_iter`; 3 is the default)."""


def ball() -> list[list[str]]:
    """A ball with one rebound by CasADi's events: the smallest case of what its plugins do."""
    x, p, t, index = ca.SX.sym("x", 2), ca.SX.sym("p"), ca.SX.sym("t"), ca.SX.sym("index")
    dae = {"x": x, "p": p, "t": t, "ode": ca.vertcat(x[1], -9.81), "zero": x[0]}
    given = {"index": index, "t": t, "x": x, "p": p, "post_x": ca.vertcat(x[0], -p * x[1])}
    jump = ca.Function("transition", given, ["index", "t", "x", "z", "p", "u"], ["post_x", "post_z"])
    falls = math.sqrt(2 / 9.81)
    after = [each - falls for each in TIMES]
    rows = [["exact", *(f"{0.8 * 9.81 * falls * each - 9.81 / 2 * each**2:.6f}" for each in after)]]
    for plugin, most in SEARCHES:
        cells = []
        options: dict[str, Any] = {"transition": jump, "max_event_iter": most}
        for end in TIMES:
            try:
                final = ca.integrator("ball", plugin, dae, 0, [end], options)(x0=[1, 0], p=0.8)["xf"]
                cells.append(f"{float(final[0]):.6f}")
            except RuntimeError as error:
                cells.append("fails: " + str(error).rpartition('returned "')[2].partition('"')[0])
        rows.append([f"{plugin}, {most} iterations", *cells])
    return rows


def counted(plugin: str, zeros: Callable[[ca.SX], tuple[ca.SX, ca.SX]]) -> str:
    """How often each of two events occurs by CasADi, as y falls from 1 to -1; both are at y = 0."""
    x, t, index = ca.SX.sym("x", 3), ca.SX.sym("t"), ca.SX.sym("index")
    dae: dict[str, Any] = {"x": x, "t": t, "ode": ca.vertcat(-1, 0, 0), "zero": ca.vertcat(*zeros(x[0]))}
    given = {"index": index, "t": t, "x": x, "post_x": ca.vertcat(x[0], x[1] + (index == 0), x[2] + (index == 1))}
    jump = ca.Function("transition", given, ["index", "t", "x", "z", "p", "u"], ["post_x", "post_z"])
    final = ca.integrator("counts", plugin, dae, 0, [2], {"transition": jump})(x0=[1, 0, 0])["xf"]
    return f"{float(final[1]):g} and {float(final[2]):g}"


COINCIDENT: tuple[Callable[[ca.SX], tuple[ca.SX, ca.SX]], ...] = (
    lambda y: (y, 2 * y),
    lambda y: (2 * y, y),
    lambda y: (-y, y),
)


def _read(bulk: Any) -> list[Any]:
    found: list[Any] = bulk.read(bulk.run())
    return found


def cell(peer: Peer, asked: Gradients, truth: Found) -> tuple[str, float]:
    """Errors of value and gradient in words, and the CPU time of a second call (s)."""
    try:
        peer.run(asked)
        start = time.process_time()
        e_n, slope = peer.run(asked)
        spent = time.process_time() - start
    except Exception as error:  # noqa: BLE001 # of any library: it is shown
        text = " ".join(str(error).split())
        return f"fails: {text.rsplit('cpp:', 1)[-1][-90:]}", math.nan
    apart = abs(e_n - truth[0])
    wrong = np.abs(slope - truth[1]).max() / np.abs(truth[1]).max()
    said = "refused" if np.isnan(slope).any() else "no reference" if np.isnan(wrong) else f"{wrong:.0e}"
    return f"{apart:.0e}, {said}", spent


def text() -> str:
    """The tables."""
    warnings.simplefilter("ignore")
    asked = tasks()
    truths = [by_sensitivities("rosenbrock", 1e-12, each) for each in asked]
    here = [each for each in PEERS if all(find_spec(name) for name in each.needs)]
    absent = [each.name for each in PEERS if each not in here]
    rows, spent = [], []
    for peer in here:
        cells = [cell(peer, each, truth) for each, truth in zip(asked, truths)]
        rows.append([peer.name, *(words for words, _ in cells)])
        spent.append([peer.name, *(f"{1e3 * seconds:.3g}" for _, seconds in cells)])
    values = [
        [f"{d:.0e}", f"{e_n:.10f}", *(f"{each:.6g}" for each in slope)] for d, (e_n, slope) in zip(DISTANCES, truths)
    ]
    machine = environment()
    return "\n\n".join(
        [
            (
                f"Tolerance {RTOL:g}; differences with a relative step of {STEP:g}. Reference: `sensitivities` by "
                "rosenbrock at 1e-12."
            ),
            table(["above the graze", "e_n", "d e_n/d ln v", "d e_n/d ln mu"], values),
            "Errors: of e_n, and of the gradient over its largest part.",
            table(["", *(f"{each:.0e}" for each in DISTANCES)], rows),
            (
                "CPU time of the second call, ms, with everything that a call of this script does (diffrax compiles, "
                "and CasADi's events are built, anew in each):"
            ),
            table(["", *(f"{each:.0e}" for each in DISTANCES)], spent),
            (f"Not installed: {', '.join(absent)}. " if absent else "All are installed. ")
            + "; ".join(
                f"{name} {machine[name]}" for name in ("date", "cpu", "casadi", "jax", "diffrax", "scikit-sundae")
            ),
        ]
    )


def smallest() -> str:
    """What CasADi's events do on the smallest problem there is, as tables."""
    return "\n\n".join(
        [
            "A ball that falls from 1 m and rebounds with 0.8, by CasADi's events, default tolerances: height, m.",
            table(["", *(f"at {each:g} s" for each in TIMES)], ball()),
            "How often two events of CasADi occur at y = 0, as y falls from 1 to -1.",
            table(
                ["", "y, then 2 y", "2 y, then y", "-y, then y"],
                [
                    [plugin, *(counted(plugin, zeros) for zeros in COINCIDENT)]
                    for plugin in ("rosenbrock", "rk", "collocation")
                ],
            ),
        ]
    )


def main(arguments: list[str]) -> None:
    """Write the tables, and print them."""
    file = Path(arguments[0]) if arguments else ROOT / "docs/engineering/standing.md"
    with one_core():
        written, more = text(), smallest()
    sys.stdout.write(f"{written}\n\n{more}\n")
    before, begin, rest = file.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    file.write_text(f"{before}{begin}\n{written}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
