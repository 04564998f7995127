#!/usr/bin/env bash
# simupy 1.1.2: events at negative times and in the last step
#
# Guess: `simulate` finds an event wherever it lies in the span of time that was asked for, and the result goes to the
#   end of the span, or has the times that were given.
# What happens: an event at a time below zero is passed over: a sphere that touches a film at -0.5 s flies on through
#   it at full speed, and through the wall behind it; the same flight counted from 0 is slowed. Where the event falls
#   into the integrator's last step, and without a largest step that step may be the whole flight, the result ends
#   before it, at 0.276 s of 2 s. A list of times gives a result of one row, the initial state. No message in any of
#   them.
# Why: a change of sign counts only if the row before has a time above 0. A step that has reached the end of the span
#   ends the loop before the event in it is looked for, and its row has been left out by then. With a list the loop
#   ends after the first interval.
# Why it matters here: times are often counted from the contact, so that the approach has negative ones; and a span is
#   often chosen to end soon after the event. Start at 0 or later, give `max_step`, and compare the last time.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
# its list of requirements has sympy, for its symbolic systems, as well
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'numpy==2.4.6' 'scipy==1.17.1' 'simupy==1.1.2'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np

np.Inf, np.float_ = np.inf, np.float64  # two names that NumPy 2 removed
from simupy.block_diagram import DEFAULT_INTEGRATOR_OPTIONS  # noqa: E402
from simupy.systems import DynamicalSystem  # noqa: E402

GAP, FILM, SPEED, TAU = 1.0, 0.5, 1.0, 0.5  # m, m, m/s, s: drag in the film alone
TOUCH = (GAP - FILM) / SPEED


def fly(times, **options):
    """The result for a sphere that comes to a film, and the times at which it touched it."""
    touched = []

    def touch(time, state, *_, event_channels=0):
        touched.append(time)
        return state

    sphere = DynamicalSystem(
        state_equation_function=lambda time, state, *_: np.array([state[1], -state[1] / TAU if touched else 0]),
        output_equation_function=lambda time, state, *_: state,
        event_equation_function=lambda time, state, *_: np.array([state[0] - FILM]),
        update_equation_function=touch,
        dim_state=2,
        num_events=1,
        initial_condition=np.array([GAP, -SPEED]),
    )
    return sphere.simulate(times, integrator_options=DEFAULT_INTEGRATOR_OPTIONS | options), touched


print("simupy", version("simupy"), f"- a film is touched {TOUCH} s after the start")
print("from     to   max_step   rows   last time   speed there   right at the end   touched at")
rows = {}
spans = [(start, 2, 0.05) for start in (0, 1, -0.25, -1, -5)]
for start, span, step in (*spans, (0, 2, 0), (0, 0.52, 0.05)):
    result, touched = fly([start, start + span], max_step=step)
    right = SPEED * np.exp(-(span - TOUCH) / TAU)
    rows[start, span, step] = result.t[-1] - start, -result.x[-1, 1], right, touched
    print(
        f"{start:5} {start + span:6} {step or 'none':>10} {len(result.t):6d} {result.t[-1]:11.4f}"
        f" {-result.x[-1, 1]:13.4f} {right:18.4f}   {', '.join(f'{time:.4f}' for time in touched) or 'never'}"
    )
listed, touched = fly(np.linspace(0, 2, 21), max_step=0.05)
print("21 times from 0 to 2:", len(listed.t), "row, last time", listed.t[-1])

for start in (0, 1, -0.25):  # touched above 0
    last, speed, right, touched = rows[start, 2, 0.05]
    assert abs(last - 2) < 1e-9 and abs(speed - right) < 1e-4, f"after {start}"
    assert len(touched) == 1 and abs(touched[0] - start - TOUCH) < 1e-6, f"after {start}"
for start in (-1, -5):
    last, speed, _, touched = rows[start, 2, 0.05]
    assert not touched and abs(last - 2) < 1e-9 and speed == SPEED, "changed: negative times"
for span, step in ((2, 0), (0.52, 0.05)):
    last, _, _, touched = rows[0, span, step]
    assert not touched and last < TOUCH, "changed: last step"
assert list(listed.t) == [0], "changed: list of times"
PY
