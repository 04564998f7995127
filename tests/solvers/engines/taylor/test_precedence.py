"""What the kernel watches for and reports, and how conditions and proofs decide: as the automaton declares them."""

import ctypes
import inspect
from collections.abc import Callable
from itertools import combinations

import numpy as np
import pytest
from wetdoublet.derive.equations.automaton import arguments
from wetdoublet.derive.equations.certificates.table import CERTIFICATES
from wetdoublet.generated import automaton
from wetdoublet.generated.automaton import EVENTS
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.taylor import source
from wetdoublet.solvers.engines.taylor.headers import headers
from wetdoublet.solvers.engines.taylor.source import resolved
from wetdoublet.solvers.host.compiler import compiler, library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.model.model import select_model

from ....helpers.flags import QUICK

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")

# Series of which those asked for are 1 - 2 t, up to a power of two: they vanish together, to the last bit.
HARNESS = """#include "guards.h"

static series s;
static lanes l;
static fixed f;

#define WANTED(event) (wanted >> (event) & 1)
#define LINE(of, at_0, slope, event) of[0] = splat(at_0), of[1] = splat(WANTED(event) ? slope : 0.0)

int reported(unsigned wanted, int closing, int inside, int sheared, int resting, int by_gap, double gap)
{
    double towards = closing ? -1.0 : 1.0;
    memset(&s, 0, sizeof s);
    memset(&l, 0, sizeof l);
    memset(&f, 0, sizeof f);
    l.alive = splat_mask(TRUTH);
    l.closing = splat_mask(closing ? TRUTH : 0);
    l.resting = splat_mask(resting ? TRUTH : 0);
    l.film = splat(inside), l.shear = splat(sheared);
    f.contact = splat(0.25), f.edge = splat(2.0), f.end = splat(4.0);
    LINE(s.gap, gap - 0.25*towards, 0.5*towards, by_gap);
    LINE(s.normal_velocity, towards, -2.0*towards, AT_TURNING);
    LINE(s.glass.result, 1.0, -2.0, AT_GLASS);
    LINE(s.acceleration, -1.0, 2.0, AT_RELEASE);
    LINE(s.rotation, M_PI - 1.0, 2.0, AT_HALF_TURN);
    LINE(s.orbital_momentum, 1.0, -2.0, AT_UNWINDING);
    first_event first = find_events(&s, &l, &f, splat(1.0));
    return LANE(first.time, 0) == 0.5 ? (int)LANE(first.event, 0) : -1;
}
"""
NUMBER = {event.name: number for number, event in enumerate(EVENTS)}
GAPS = {"contact": 0.25, "film_edge": 1.0, "tangential_edge": 2.0, "rupture": 4.0}  # one of them at a time
MODES = {  # motion, film, shear, resting, and what happens at a gap
    "closing to contact": (-1, 1, 1, 0, "contact"),
    "closing to the film": (-1, 0, 1, 0, "film_edge"),
    "closing to the tangential edge": (-1, 0, 0, 0, "tangential_edge"),
    "opening to the film's edge": (1, 1, 1, 0, "film_edge"),
    "opening to the tangential edge": (1, 0, 1, 0, "tangential_edge"),
    "opening to rupture": (1, 0, 0, 0, "rupture"),
    "resting": (1, 1, 1, 1, "contact"),
}


CONDITIONS = {
    name: each
    for name, each in vars(automaton).items()
    if inspect.isfunction(each) and each.__module__ == automaton.__name__
}
PROOFS = {
    proof.name: eval(f"lambda {', '.join(arguments(proof.test))}: {proof.test}", vars(automaton))
    for row in CERTIFICATES
    for proof in row.proofs
}
VALUES = [0.0, 1.0, 1e-13, 1e-9, 1e9, float("nan")]


def call(name: str, condition: Callable[..., bool]) -> str:
    """A C function that returns a condition of numbers in an array."""
    numbers = [
        f"splat(x[{k}])" if name in PROOFS and each != "margin" else f"x[{k}]"
        for k, each in enumerate(inspect.signature(condition).parameters)
    ]
    result = f"{name}({', '.join(numbers)})"
    result = f"LANE({result}, 0) != 0" if name in PROOFS else result
    return f"int call_{name}(const double *x) {{ return {result}; }}\n"


@pytest.fixture(scope="module")
def kernel() -> ctypes.CDLL:
    """Conditions, proofs, and the search for events, of a structure that has all: oblique, with bridge and strings."""
    bridge = {"bridge.surface_tension": "0.05 N/m", "bridge.volume": 0.05, "bridge.contact_angle": "0 deg"}
    choice = select_model(Scene.load("pendulum").with_entries(bridge), True)
    emitted = headers(choice)
    assert emitted is not None
    calls = "".join(call(*each) for each in (CONDITIONS | PROOFS).items())
    text = resolved(HARNESS + calls, source.files(source.Variant(choice, 9, lanes=2), emitted))
    made = loaded(library(text, ("-std=gnu11", "-fPIC", "-shared", *QUICK.split())), ctypes.CDLL)
    made.reported.argtypes = [ctypes.c_uint, *[ctypes.c_int] * 5, ctypes.c_double]
    return made


@pytest.mark.parametrize("mode", MODES)
def test_of_coincident_events_the_first_of_the_table_is_reported(kernel: ctypes.CDLL, mode: str):
    """Alone and in pairs, every event that the table watches for in a mode, in its order of precedence."""
    motion, film, shear, resting, at_gap = MODES[mode]
    values = {"motion": motion, "film": film, "resting": resting, "rolling": None}  # friction: not by the kernel
    watched = [
        event.name
        for event in EVENTS
        if all(values[part] == value for part, value in event.where)
        and (event.name == at_gap if event.name in GAPS else True)
    ]
    assert len(watched) > 2
    for some in (*combinations(watched, 1), *combinations(watched, 2)):
        wanted = sum(1 << NUMBER[name] for name in some)
        found = kernel.reported(wanted, motion < 0, film, shear, resting, NUMBER[at_gap], GAPS[at_gap])
        assert found == NUMBER[some[0]], some


@pytest.mark.parametrize("name", CONDITIONS | PROOFS)
def test_a_condition_is_the_declared_one(kernel: ctypes.CDLL, name: str) -> None:
    """For numbers of any size, on limits, and for NaN, with which no condition holds; both answers occur."""
    condition, rng = (CONDITIONS | PROOFS)[name], np.random.default_rng(7)
    compiled = getattr(kernel, f"call_{name}")
    names, answers = list(inspect.signature(condition).parameters), set()
    for _ in range(1000):
        some = np.where(rng.random(len(names)) < 0.5, rng.choice(VALUES, len(names)), rng.normal(size=len(names)))
        numbers = [abs(value) if each in ("aspect", "margin") else value for each, value in zip(names, some.tolist())]
        expected = bool(condition(*numbers))
        assert bool(compiled((ctypes.c_double * len(names))(*numbers))) == expected, numbers
        answers.add(expected)
    assert answers == {True, False}
