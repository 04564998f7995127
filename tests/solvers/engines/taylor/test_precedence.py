"""What the kernel watches for, and which of coincident events it reports: as the table of the automaton has it."""

import ctypes
from itertools import combinations

import pytest
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


@pytest.fixture(scope="module")
def kernel() -> ctypes.CDLL:
    """The search for events of a structure that has all of them: oblique, with bridge and strings."""
    bridge = {"bridge.surface_tension": "0.05 N/m", "bridge.volume": 0.05, "bridge.contact_angle": "0 deg"}
    choice = select_model(Scene.load("pendulum").with_entries(bridge), True)
    emitted = headers(choice)
    assert emitted is not None
    text = resolved(HARNESS, source.files(source.Variant(choice, 9, lanes=2), emitted))
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
