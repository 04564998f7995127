"""Enclosures hold trajectories: series of the emitted equations in 300-bit balls, step by step and through events."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import flint
import numpy as np
import pytest
from wetdoublet import generated
from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.engines.interval.build import FLAGS, source
from wetdoublet.solvers.engines.interval.inputs import Inputs
from wetdoublet.solvers.engines.machine import own_sets
from wetdoublet.solvers.host.compiler import compiler, library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.model.model import select_model

pytestmark = [pytest.mark.slow, pytest.mark.skipif(compiler() is None, reason="no C compiler")]
BITS, TERMS, STEPS = 300, 25, 3000
ORDER, TOLERANCE, WIDEST = 16, 1e-15, 0.5  # of the enclosure
# One row a step: its length, rebounds so far, film, shear, whether the pair is apart; low and high of each state.
HARNESS = """
typedef struct { const double *quantities; const int *moving; proof *w; double *rows; long room, count; } flight;
static void run_flight(void *argument)
{
    flight *g = argument;
    proof *w = g->w;
    const options o = {ORDER, 0, 0, TOLERANCE, WIDEST, 0.01};
    set_up(w, g->quantities, g->moving);
    for (int goes = begin(w, &o); goes && g->count < g->room;) {
        iv x[STATES];
        double width = 0.0;
        const int rebounds = w->rebounds, film = w->here.film, shear = iv_positive(w->here.shear);
        double *row = g->rows + g->count*(5 + 2*STATES);
        hull_of(&w->p, &w->s, x);
        for (int i = 0; i < STATES; i++)
            width = larger(width, iv_width(x[i]));
        if (!w->wall.known && (w->rebounds || iv_lo(x[NORMAL_VELOCITY]) > -0.1))
            find_barrier(&w->p, &w->rest, &w->wall);
        if (!(width < o.widest) || (w->wall.known && below_barrier(&w->p, &w->wall, &w->s)))
            return;
        goes = step(w, &o, x, width);
        if (!goes && w->outcome < ROTATE) /* none, or a stick */
            return;
        const int other = w->here.film != film || iv_positive(w->here.shear) != shear;
        const int event = !goes || w->rebounds != rebounds || other;
        const double said[] = {event ? 2.0*w->h : w->h, w->rebounds, w->here.film, iv_positive(w->here.shear), !goes};
        memcpy(row, said, sizeof said);
        hull_of(&w->p, &w->s, x);
        for (int i = 0; i < STATES; i++) {
            row[5 + 2*i] = iv_lo(x[i]);
            row[6 + 2*i] = iv_hi(x[i]);
        }
        g->count++;
        w->steps++;
    }
}
EXPORTED long interval_flight(const double *quantities, const int *moving, void *room, double *rows, long most)
{
    flight g = {quantities, moving, room, rows, most, 0};
    rounded(run_flight, &g);
    return g.count;
}
"""
PRESETS = ("granulation", "granulation-dry-bridge", "lactose-pvp", "glass-beads-water", "pellet-coating")
VARIED = ("liquid.viscosity", "particles.roughness", "particles.dry_restitution", "bridge.surface_tension")
SPINS = ("impact.spin", "impact.partner_spin")
LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[-+]?\d+)?)")
FUNCTIONS = {
    name: lambda x, name=name: getattr(x + flint.arb(0), name)()
    for name in ("exp", "log", "sqrt", "sin", "cos", "acos", "tan")
} | {"fabs": abs, "fmax": lambda x, y: max(x, y, key=float)}


@pytest.fixture(autouse=True)
def _precision() -> Iterator[None]:
    before = flint.ctx.prec
    flint.ctx.prec = BITS
    yield
    flint.ctx.prec = before


@cache
def emitted(name: str) -> SimpleNamespace:
    """The functions of an emitted Python file, with decimals as balls and functions of series in place of CasADi's."""
    text = (Path(generated.__file__).parent / f"{name}.py").read_text()
    text = re.sub(r"^from (casadi|\.\w+) import (\([^)]*\)|.*)\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"\((\d+)/(\d+)\)", r"(Decimal(\1)/\2)", text)
    space: dict[str, Any] = {"Decimal": flint.arb, "pi": flint.arb.pi(), **FUNCTIONS}
    exec(LITERAL.sub(r'Decimal("\1")', text), space)
    return SimpleNamespace(**space)


class Outside(Exception):
    """A state lies outside of its enclosure."""


class Exact:
    """A collision in balls: groups by their definitions, series of the emitted right-hand side, emitted guards."""

    def __init__(self, scene: Scene, structure: str, laws: dict[str, str]) -> None:
        self.laws = SimpleNamespace(
            **{slot: emitted(f"laws/{slot}_{law.replace('-', '_')}") for slot, law in laws.items()}
        )
        self.model, self.guards = emitted(structure), emitted(structure.removesuffix("_reduced"))
        plain = "oblique_wall" if scene.wall else "oblique_pair" if scene.pair else "oblique_reduced"
        self.rebound, self.start = (getattr(emitted(plain), name) for name in ("rebound", "start"))
        quantities = {name: flint.arb(low) for name, (low, _) in Inputs.of(scene).ranges.items()}
        self.groups = groups(scene, quantities)

    def series(self, state: dict[str, Any], film: int, shear: int) -> dict[str, Any]:
        """Coefficients of the states about a state, one after another."""
        known = {name: [value] for name, value in state.items()}
        for k in range(TERMS - 1):
            flint.ctx.cap = k + 1
            at = {name: flint.arb_series(each, prec=k + 1) for name, each in known.items()}
            rates = self.model.right_hand_side(at, self.groups, self.laws, film, shear)
            for name, rate in rates.items():
                known[name].append(rate[k] / (k + 1))
        flint.ctx.cap = TERMS
        return {name: flint.arb_series(each, prec=TERMS) for name, each in known.items()}

    def guard(self, name: str) -> Callable[[dict[str, Any]], Any]:
        """A guard of the table of events as a function of the states or their series."""
        return lambda state: self.guards.events(state, self.groups, self.laws)[name]


def groups(scene: Scene, q: dict[str, Any]) -> dict[str, Any]:
    """The dimensionless groups, by their emitted definitions in balls."""
    scaling, suffix = emitted("scaling"), "_pair" if scene.pair else ""

    def group(name: str, *more: str, **known: Any) -> Any:
        return getattr(scaling, name)(*((q | known)[each] for each in scaling.ARGUMENTS[name]))

    still = {"impact_spin": flint.arb(0), "impact_partner_spin": flint.arb(0)}
    q = still | q
    if "speed" not in q:
        q["speed"] = q["stokes"] / group("stokes", speed=flint.arb(1))
    q["obliquity"] = group(f"obliquity{suffix}")
    q["rate_scale"] = group(f"rate_scale{suffix}")
    names = ["stokes", "aspect", "initial_turning", "initial_spin", "rough_gap", "glass_number"]
    names += ["elastic_gap"] * (scene.particles.youngs_modulus is not None)
    names += ["capillary", "rupture_gap"] * (scene.bridge is not None) + ["initial_partner_spin"] * bool(scene.pair)
    found = {"elastic_gap": flint.arb(0), "rupture_gap": flint.arb(1)} | {name: group(name) for name in names}
    return q | found


@cache
def compiled(text: str) -> ctypes.CDLL:
    """The engine's text with the harness, as a library."""
    settings = f"#define ORDER {ORDER}\n#define TOLERANCE {TOLERANCE}\n#define WIDEST {WIDEST}\n"
    made = loaded(library(text + settings + HARNESS, (*own_sets()[0].flags, *FLAGS)), ctypes.CDLL)
    assert made.interval_start()
    made.interval_flight.restype = ctypes.c_long
    return made


def flown(scene: Scene, change: tuple[str, str] = ("", "")) -> np.ndarray:
    """The rows of the enclosure's steps; of a runtime in which one text stands for another."""
    inputs = Inputs.of(scene)
    engine, states = inputs.engine(), 2 if scene.wall else 4 if scene.pair else 3
    text = source(select_model(scene, not scene.wall, fold=True), own_rupture=False, parameters=0)
    assert change[0] in text
    made = compiled(text.replace(*change))
    pairs = np.array([inputs.ranges.get(name, (np.nan, np.nan)) for name in engine.quantities])
    columns = np.full(len(engine.quantities), -1, np.int32)
    rows, room = np.empty((STEPS, 5 + 2 * states)), ctypes.create_string_buffer(engine.room + 64)
    at = -(-ctypes.addressof(room) // 64) * 64
    pointers = [ctypes.c_void_p(each) for each in (pairs.ctypes.data, columns.ctypes.data, at, rows.ctypes.data)]
    count = made.interval_flight(*pointers, ctypes.c_long(STEPS))
    return rows[:count]


def first_root(guard: Any, near: float) -> Any:
    """The root of a series near a time, by Newton's method from there."""
    time, slope = flint.arb(near), guard.derivative()
    for _ in range(12):
        time = flint.arb((time - evaluated(guard, time) / evaluated(slope, time)).mid())
    return time


def evaluated(series: Any, time: Any) -> Any:
    """A series at a time, as a polynomial."""
    total = flint.arb(0)
    for k in range(len(series) - 1, -1, -1):
        total = total * time + series[k]
    return total


def followed(scene: Scene, change: tuple[str, str] = ("", "")) -> tuple[int, int]:
    """Follow a collision beside its enclosure; Outside where a state is not in it.

    Returns:
        The numbers of steps and of events.
    """
    choice = select_model(scene, True, fold=True)
    exact = Exact(scene, choice.structure, dict(choice.laws))
    state = {name: flint.arb(1) * value for name, value in exact.start({}, exact.groups, exact.laws).items()}
    edge = exact.laws.shear.edge(exact.groups["aspect"])
    film, shear, rebounds, events = 1, int(flint.arb(edge) >= 1), 0, 0
    solid = "elastic" if exact.groups["elastic_gap"] > exact.groups["rough_gap"] else "rough"
    if exact.guard("glass")(state) <= 0:  # at initial contact, from where the film is left at once
        state, rebounds, film = exact.rebound(state, exact.groups, exact.laws), 1, 0
        shear = int(flint.arb(edge) > 1)
    rows = flown(scene, change)
    for length, bounced, now_film, now_shear, apart, *ends in rows.tolist():
        series = exact.series(state, film, shear)
        if bounced != rebounds:
            times = [first_root(exact.guard(each)(series), length) for each in (solid, "glass")]
            time = min(times, key=lambda each: abs(float(each) - length))
        elif apart or now_film != film:
            target = exact.groups["rupture_gap"] if apart else flint.arb(1)
            time = first_root(series["gap"] - target, length)
        elif now_shear != shear:
            time = first_root(series["gap"] - edge, length)
        else:
            time = flint.arb(length)
        event = bool(apart) or (bounced, now_film, now_shear) != (rebounds, film, shear)
        assert abs(float(time) / length - 1) < 0.1  # the root that is meant; behind slow rebounds sets are wide
        state = {name: evaluated(each, time) for name, each in series.items()}
        if bounced != rebounds:
            state = exact.rebound(state, exact.groups, exact.laws)
        # a partner's spin, and what moves along a wall, are no states of the enclosure
        for value, low, high in zip(state.values(), ends[::2], ends[1::2], strict=False):
            if not flint.arb(low) <= value <= flint.arb(high):
                raise Outside(f"{float(value)} is not between {low} and {high}, after {events} events")
        state = {name: flint.arb(each.mid()) for name, each in state.items()}
        rebounds, film, shear, events = bounced, int(now_film), int(now_shear), events + event
    return len(rows), events


def scenes(seed: int, partner: str = "") -> Iterator[Scene]:
    """Presets with entries and impacts at random; with a larger sphere, or a wall, in place of the equal one."""
    random = np.random.default_rng(seed)
    while True:
        scene = Scene.load(PRESETS[random.integers(len(PRESETS))])
        entries = {name: float(scene.entries[name]) for name in VARIED if name in scene.entries}
        changed = {name: value * float(np.exp(random.uniform(-0.7, 0.7))) for name, value in entries.items()}
        changed["particles.dry_restitution"] = float(random.uniform(0.3, 1.0))
        if partner == "pair":
            radius, ratio = 2 * scene.particles.reduced_radius, float(random.uniform(1.2, 3))
            mass = 2 * scene.particles.reduced_mass * ratio**3 * float(random.uniform(0.7, 1.4))
            spins = dict(zip(SPINS, (0.2 * random.normal(size=2) / radius).tolist(), strict=True))
            changed |= {"partner.radius": radius * ratio, "partner.mass": mass, **spins}
        if partner == "wall":
            changed["partner.wall"] = True
            if coating := scene.entries.get("liquid.coating_thickness"):
                changed["partner.coating_thickness"] = 0.5 * float(coating)
        try:
            scene = scene.with_entries(changed)
            yield scene.with_impact(stokes=float(np.exp(random.uniform(-4, 3))), angle=float(random.uniform(0.05, 1.5)))
        except InputError:
            continue


@pytest.mark.parametrize("partner", ["", "pair", "wall"])
def test_trajectories_lie_in_every_step_of_their_enclosures(partner: str) -> None:
    """Random flights: states at the ends of all steps, on surfaces of events, and after rebounds."""
    drawn = scenes(1, partner)
    counts = [followed(next(drawn)) for _ in range(3 if partner else 2)]
    assert sum(steps for steps, _ in counts) > 40
    assert sum(events for _, events in counts) > 1


MUTANTS = {
    "remainder": ("at[i] = horner(w->centre.state[i].v, terms, t);", "at[i] = horner(w->centre.state[i].v, order, t);"),
    "spread": (
        "by[i][j] = HAS(state, j) ? horner(state->d[j], order, t) : iv_point(0.0);",
        "by[i][j] = iv_point(0.0);",
    ),
}


@pytest.mark.parametrize("change", MUTANTS.values(), ids=MUTANTS)
def test_a_term_that_is_dropped_is_noticed(change: tuple[str, str]) -> None:
    """A runtime without the remainder of a step, or without what earlier errors become in it, loses trajectories."""
    drawn = scenes(1)
    assert any(_is_lost(next(drawn), change) for _ in range(5))


def _is_lost(scene: Scene, change: tuple[str, str]) -> bool:
    try:
        followed(scene, change)
    except Outside:
        return True
    return False
