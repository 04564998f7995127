#!/usr/bin/env bash
# scikit-sundae 1.2.0: events of a solver that is used twice
#
# Guess: `solve` of the same CVODE or IDA object, from another start, returns the events of that solution, as its `t`
#   and `y` are of it; `terminal = [3]` stops each solution at its third event.
# What happens: the events of all solutions before come first. A ball that is dropped from 1, 0.5 and 2 m has 1, 2 and 3
#   impacts, `t_events[0]` is the first ball's each time, and a solution without an event has those of others. The count
#   of `terminal` runs on as well: the second solution stops at its first event instead of its third. No warning.
# Why: times, states and counts are kept as attributes of the *event function*, and are emptied only when a solver is
#   made; a second solver of the same function empties the first one's too.
# Why it matters here: a regime map is one model from many starts, and onset and rupture are read off the first entry.
#   Make a solver for each start, each with an event function of its own, or take the last entry.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'scikit-sundae==1.2.0' 'numpy==2.4.6' 'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

import numpy as np
from sksundae.cvode import CVODE
from sksundae.ida import IDA

GRAVITY = 9.81
HEIGHTS = (1.0, 0.5, 2.0)
TOLERANCES = {"rtol": 1e-9, "atol": 1e-12}


def fall(time, state, rate):
    rate[:] = state[1], -GRAVITY


def residual(time, state, rate, value):
    value[:] = rate[0] - state[1], rate[1] + GRAVITY


def swing(time, state, rate):
    rate[:] = state[1], -state[0]


def ground(time, state, events):
    events[0] = state[0]


def ground_of_residual(time, state, rate, events):
    events[0] = state[0]


def zero(time, state, events):
    events[0] = state[0]


zero.terminal = [3]


def near(found, expected):
    return np.shape(found) == np.shape(expected) and np.allclose(found, expected, rtol=1e-7, atol=0)


print("scikit-sundae", version("scikit-sundae"), "- one solver, three falls")
print("height (m)   impact at (s)   last t    t_events of CVODE             of IDA")
cvode = CVODE(fall, eventsfn=ground, num_events=1, **TOLERANCES)
ida = IDA(residual, eventsfn=ground_of_residual, num_events=1, **TOLERANCES)
impacts = []
for height in HEIGHTS:
    impacts.append(math.sqrt(2 * height / GRAVITY))
    first = cvode.solve([0, 2], [height, 0])
    second = ida.solve([0, 2], [height, 0], [0, -GRAVITY])
    texts = (", ".join(f"{time:.5f}" for time in result.t_events) for result in (first, second))
    print(f"{height:10.1f}   {impacts[-1]:13.5f}   {first.t[-1]:.5f}   {next(texts):27s}   {next(texts)}")
    assert near(first.t[-1], impacts[-1]), "the solution itself"
    assert near(first.t_events, impacts) and near(second.t_events, impacts), "changed: events of earlier solutions"
short = cvode.solve([0, 0.1], [1.0, 0])
print(f"until 0.1 s, in the air: {len(short.t_events)} events, {short.message}")
assert near(short.t_events, impacts), "changed: no event"

pendulum = CVODE(swing, eventsfn=zero, num_events=1, **TOLERANCES)
ends = [float(pendulum.solve([0, 20], [1.0, 0]).t[-1]) for _ in range(3)]
print("terminal = [3], zeros at pi/2, 3 pi/2, 5 pi/2: ends at", ", ".join(f"{end / math.pi:.3f} pi" for end in ends))
assert near(ends, [2.5 * math.pi, math.pi / 2, math.pi / 2]), "changed: count of events"
CVODE(swing, eventsfn=zero, num_events=1, **TOLERANCES)
again = float(pendulum.solve([0, 20], [1.0, 0]).t[-1])
print(f"after another solver of the same function was made: {again / math.pi:.3f} pi")
assert near(again, 2.5 * math.pi), "changed: a new solver"
PY
