#!/usr/bin/env bash
# numbakit-ode 0.5 (nbkode): the points before a terminal event
#
# Guess: `run_events`, whose events follow SciPy's, gives the points that were asked for up to the event that ends the
#   run, then the event; of two events that end it, the earlier one does; none lies behind the last point asked for.
# What happens: all points between the last step and the event are missing: three of nine here, five with the method of
#   order eight. If two such events fall into one step, the one that stands later in the list ends the run: a run that
#   is to end at a gap of 0.85 goes on to 0.9, or not, by the order of the list. And a run to 0.65 s lists an event at
#   0.693 s. `max_step=0.1` changes none of it. No message.
# Why: a step is looked through for events before its points are interpolated, and an event that ends the run is put in
#   the place of the next point. The bound that later events are compared with is never moved. The step that passes
#   the last point may go beyond it. `max_step` is stored and not used.
# Why it matters here: a gap that is plotted or fitted over these points has a hole just before its rupture, the larger
#   the smoother the motion; and a stop behind the rupture hides the rupture. Take a method of fixed, small steps.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numbakit-ode==0.5' 'numba==0.68.1' 'numpy==2.4.6' \
    'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

import nbkode
import numba
import numpy as np

START = np.array([0.0, 1.0])  # a gap that opens, slowed by drag: 1 - exp(-t)


@numba.njit
def motion(time, state):
    return np.array([state[1], -state[1]])


@numba.njit
def half(time, state):
    return state[0] - 0.5


@numba.njit
def thread(time, state):
    return state[0] - 0.85


@numba.njit
def rupture(time, state):
    return state[0] - 0.9


thread.terminal = rupture.terminal = True


def run(method, times, *events, **options):
    solver = method(motion, 0.0, START, **options or {"first_step": 1e-3})
    found, _, moments, _ = solver.run_events(np.array(times), events)
    return list(found), [list(each) for each in moments]


print("numbakit-ode", version("numbakit-ode"), "- gap 1 - exp(-t)")
asked = [0.25 * number for number in range(1, 41)]
end = -math.log(1 - 0.9)
right = [time for time in asked if time < end]
print(f"points every 0.25 s, rupture at a gap of 0.9, {end:.3f} s: {len(right)} points and the rupture")
for method, least in ((nbkode.RungeKutta45, 3), (nbkode.DOP853, 4)):
    found, ((moment,),) = run(method, asked, rupture)
    lost = [time for time in right if time not in found]
    print(f"{method.__name__:13s} rupture at {moment:.3f} s, missing: {', '.join(f'{time:g}' for time in lost)}")
    assert abs(moment - end) < 0.02 and found[-1] == moment, "the event"
    assert found[:-1] == right[: len(found) - 1], "the points before"
    assert len(lost) >= least, "changed: points"
    if method is nbkode.RungeKutta45:
        short, _ = run(method, asked, rupture, first_step=1e-3, max_step=0.1)
        print(f"{method.__name__:13s} with max_step=0.1: {'the same' if short == found else short}")
        assert short == found, "changed: max_step"
    if method is nbkode.DOP853:
        ends = [run(method, asked, *events)[0][-1] for events in ((thread, rupture), (rupture, thread))]
        print(f"events at gaps of 0.85 (1.897 s) and 0.9 end it at {ends[0]:.3f} s, in the other order {ends[1]:.3f} s")
        assert abs(ends[0] - end) < 0.02 and abs(ends[1] + math.log(0.15)) < 0.02, "changed: two events"
fixed, _ = run(nbkode.RungeKutta4, asked, rupture, h=0.05)
print(f"{'RungeKutta4':13s} with steps of 0.05 s: {len(fixed) - 1} points and the rupture")
assert fixed[:-1] == right, "fixed steps"
_, ((beyond,),) = run(nbkode.RungeKutta45, [0.3, 0.65], half)
print(f"run to 0.65 s: event at {beyond:.3f} s")
assert abs(beyond - math.log(2)) < 1e-3, "changed: an event behind the end"
PY
