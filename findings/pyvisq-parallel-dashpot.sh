#!/usr/bin/env bash
# pyvisq 1.2.2: the stress of a spring beside a dashpot (Kelvin-Voigt), and a model whose parameters are changed
#
# Guess: stretched at a constant rate, a spring k beside a dashpot c has the stress k strain + c rate, and the closed
#   loop of stress and strain the work that the dashpot takes. A model given other `params` answers with these.
# What happens: the stress is that of the spring alone, for a dashpot of 1 and of 100 alike; the loop takes nothing. A
#   dashpot by itself has the stress 0 at each rate, also one beside a springpot. The creep of the same models is right.
#   `G(t)` and `J(t)` of a time that was asked before keep the values of the old parameters, those of other times have
#   the new ones.
# Why: the relaxation modulus of a dashpot is an impulse at time 0. It is infinite at that point and 0 elsewhere, or
#   left out, and the integral over the history of the strain never meets it. Both functions remember their last
#   hundred results by time only.
# Why it matters here: a spring beside a dashpot is the usual contact of grains, whose restitution would be 1 by this
#   stress. Take a springpot of exponent 0.999 for the dashpot, and a new model for each set of parameters.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'pyvisq==1.2.2' 'numpy==2.4.6' \
    'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

import numpy as np
from pyvisq import Test, TestMethod
from pyvisq.models.elements import Dashpot, DashpotParams, Springpot, SpringParams, SpringpotParams
from pyvisq.models.kelvinvoigt import (
    FracDashpotKelvinVoigt,
    FracDashpotKelvinVoigtParams,
    FracSpringKelvinVoigt,
    FracSpringKelvinVoigtParams,
    KelvinVoigt,
    KelvinVoigtParams,
)
from pyvisq.models.maxwell import Maxwell, MaxwellParams

RISE, HOLD = 0.5, 1.0  # s: to the strain 1, there, back to 0, there
SPRING = SpringParams(1.0)


def history(model, method=TestMethod.RELAXATION):
    model.set_test(Test(method, 1.0, RISE, HOLD, RISE, HOLD))
    model.set_time()
    model.set_input()
    model.run()
    return model.data


def rise(values, data):
    return np.interp(RISE / 2, data.time, values)


print("pyvisq", version("pyvisq"), "- strain rises to 1 at 2 per second: stress at 0.5, work of the loop")
print("model                                        stress     true      work     true")
for viscosity in (1.0, 100.0):
    dashpot, almost = DashpotParams(viscosity), SpringpotParams(0.999, viscosity)
    half = SpringpotParams(0.5, 1.0)
    for name, model, elastic, right in (
        ("dashpot", Dashpot(dashpot), 0.0, False),
        ("dashpot, spring", KelvinVoigt(KelvinVoigtParams(dashpot, SPRING)), 0.5, False),
        ("springpot 0.999, spring", FracSpringKelvinVoigt(FracSpringKelvinVoigtParams(almost, SPRING)), 0.5, True),
    ):
        data = history(model)
        stress, work = rise(data.stress, data), np.trapezoid(data.stress, data.strain)
        true, lost = elastic + 2 * viscosity, 4 * viscosity
        label = f"{viscosity:g}: {name}"
        print(f"{label:40s} {stress:10.4g} {true:8g} {work:9.2g} {lost:8g}")
        if right:
            assert abs(stress / true - 1) < 0.01, "an exponent near 1"
        else:
            assert abs(stress - elastic) < 1e-6 and abs(work) < 1e-6, "changed: the stress of a dashpot"
    mixed = history(FracDashpotKelvinVoigt(FracDashpotKelvinVoigtParams(dashpot, half))).stress
    assert np.allclose(mixed, history(Springpot(half)).stress, atol=1e-6), "changed: a dashpot beside a springpot"
    creep = history(KelvinVoigt(KelvinVoigtParams(dashpot, SPRING)), TestMethod.CREEP)
    expected = 2 * (RISE / 2 - viscosity * (1 - math.exp(-RISE / 2 / viscosity)))
    assert abs(rise(creep.strain, creep) - expected) < 0.01 * expected + 1e-4, "creep"

model = Maxwell(MaxwellParams(DashpotParams(1.0), SpringParams(1.0)))
before = model.G(0.5)
model.params = MaxwellParams(DashpotParams(1.0), SpringParams(5.0))
print("Maxwell, relaxation modulus: G(0.5), G(0.6) after k went from 1 to 5")
true = [5 * math.exp(-5 * time) for time in (0.5, 0.6)]
found = [model.G(time) for time in (0.5, 0.6)]
print(f"pyvisq {found[0]:.4f} {found[1]:.4f}, true {true[0]:.4f} {true[1]:.4f}")
assert found[0] == before and abs(before - math.exp(-0.5)) < 1e-9, "changed: a time asked before"
assert abs(found[1] - true[1]) < 1e-9, "another time"
PY
