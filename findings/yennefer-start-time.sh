#!/usr/bin/env bash
# yennefer 0.5.0: where a run begins and ends
#
# Guess: `ASolver.solve(2, step, t_init=1)` starts from the given state at 1 s; `n_max_steps` bounds the steps, and a
#   run that meets it says so.
# What happens: each run starts at 0 s, whatever `t_init` is: the integral of cos t from 1 to 2 s is 0.909, not 0.068,
#   and its first time is 0. With 10 steps at most, `DOP853Solver` and `RADAUSolver` end at 3.5 and 0.7 of 100 s as if they
#   were through, no flag, no message; `RK45Solver` takes 69 steps, and with `n_max_steps=0.1` some 1000 of 0.1 s.
# Why: the start is passed to the estimate of stiffness, and not to the solver, which knows none; the number of steps is
#   only compared in the condition of the loop; RK45 takes it for the largest width of a step.
# Why it matters here: a piecewise run, free flight and then contact, goes on at the time of the event. Forces that
#   depend on time, a shaken wall, have then the wrong phase. Shift the time inside the function, and look at the last
#   time of each result.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'yennefer==0.5.0' \
    'llvmlite==0.50.0' 'numba==0.68.1' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" -W error::RuntimeWarning - <<'PY'
from importlib.metadata import version

import numpy as np
from numba import njit
from yennefer import ASolver, DOP853Solver, RADAUSolver, RK45Solver


@njit
def shaken(time, state, given):
    return np.array([np.cos(time)])


NOTHING = np.array([0.0])
print("yennefer", version("yennefer"))
times, states = ASolver(shaken, [0.0], NOTHING, verbose=False).solve(2.0, 1e-3, t_init=1.0)
true = np.sin(2) - np.sin(1)
print(f"x' = cos t, x(1) = 0, to 2 s: times from {times[0]:g} to {times[-1]:g}, x = {states[-1, 0]:.4f}, true {true:.4f}")
assert times[0] == 0 and abs(states[-1, 0] - np.sin(2)) < 1e-6, "changed: t_init"

print("the same to 100 s with n_max_steps=10:")
for method, steps in ((DOP853Solver, 10), (RADAUSolver, 10), (RK45Solver, None)):
    times, _ = method(shaken, np.array([0.0]), NOTHING, n_max_steps=10).solve(100.0, 1e-3)
    print(f"{method.__name__:13s} {len(times) - 1:4d} steps, ends at {times[-1]:.3g} s")
    if steps is None:
        assert times[-1] == 100 and len(times) > 50, "changed: n_max_steps of RK45Solver"
    else:
        assert len(times) - 1 <= steps and times[-1] < 10, "changed: n_max_steps"
times, _ = RK45Solver(shaken, np.array([0.0]), NOTHING, n_max_steps=0.1).solve(100.0, 1e-3)
print(f"RK45Solver    n_max_steps=0.1: {len(times) - 1} steps, the widest {np.diff(times).max():.3g} s")
assert 0.0999 < np.diff(times).max() < 0.1001, "changed: the width of the steps"
PY
