#!/usr/bin/env bash
# hybrid-automaton 1.0.0: the choice of the integrator
#
# Guess: a state made with `integration_fnc=IntegrationFunction.RK4` is integrated to fourth order, and a function that
#   is given to the automaton as `integration_function` does the steps.
# What happens: RK4 is Euler's method to the last bit. A velocity that decays with exp(-t) has 0.250 after one time
#   constant in steps of 0.5 and 0.349 in steps of 0.1 (0.368 is right, and a fourth-order step of 0.5 gives 0.3682).
#   The function given to the automaton is never called. No message.
# Why: the integrator gets the derivative, a vector that was computed once, in place of the function: its four slopes
#   are the same one. The automaton's function is stored and not handed on.
# Why it matters here: in a film the velocity changes the faster the thinner the gap is. One takes RK4 for that, halves
#   the step, sees the result change a little, and takes the difference for rounding: the error falls as the step, not
#   as its fourth power. Write the method into the flow, or take steps for Euler.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'hybrid-automaton==1.0.0' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import asyncio
import contextlib
import io
import math
from importlib.metadata import version

import numpy as np
from hybrid_automaton import Automaton, ContinuousState, IntegrationFunction
from hybrid_automaton.definition import State, Transition, continuous_dynamics, guard, invariant

called = []


def exact(state, slope, step):
    called.append(step)
    return state * math.exp(-step)


def decay(step, method=None, own=None):
    """Velocity after one time constant, from 1."""

    @continuous_dynamics
    def drag(context):
        return -context.continuous_state.latest()

    @continuous_dynamics
    def rest(context):
        return np.zeros(1)

    @guard
    def late(context):  # evaluated behind the step
        return context.clock.get_elapsed_time_active() > 1 - 1.5 * step

    @invariant
    def never(context):
        return False

    moving = State(name="moving", initial=True, flow=drag)
    done = State(name="done", final=True, flow=rest, invariants=[never])
    moving.add_transition(Transition("stop", done, guards=[late]))
    given = {} if own is None else {"integration_function": own}
    automaton = Automaton(name="sphere", version="1", states=[moving, done], **given)
    chosen = {} if method is None else {"integration_fnc": method}
    start = ContinuousState("sphere", x0=np.ones(1), x_labels=["velocity"], **chosen)
    with contextlib.redirect_stdout(io.StringIO()):  # it reports each transition
        run = automaton.activate(initial_continuous_state=start, delta_time=step, should_write_logs=False)
        result = asyncio.run(run)
    assert result.was_successful()
    return float(result.final_continuous_state[0])


print("hybrid-automaton", version("hybrid-automaton"), f"- exp(-1) = {math.exp(-1):.6f}")
print("step     default       EULER         RK4   own function   RK4 as it should be")
for steps in (2, 4, 10, 100):
    step = 1 / steps
    found = [decay(step, method) for method in (None, IntegrationFunction.EULER, IntegrationFunction.RK4)]
    found.append(decay(step, own=exact))
    fourth = (1 - step + step**2 / 2 - step**3 / 6 + step**4 / 24) ** steps
    print(f"{step:4g} {found[0]:11.6f} {found[1]:11.6f} {found[2]:11.6f} {found[3]:14.6f} {fourth:21.6f}")
    assert math.isclose(found[0], (1 - step) ** steps, rel_tol=1e-12), "Euler's method"
    assert found[1] == found[0], "Euler's method"
    assert found[2] == found[0], "changed: RK4"
    assert found[3] == found[0] and not called, "changed: own function"
PY
