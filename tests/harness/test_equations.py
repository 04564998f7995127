"""The functions of `wd.equations`, one phase after another, are the collision: by scipy's integrator, for any scene."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from wetdoublet.solvers import ComputationError, equations

from .conditioning import decided
from .scenes import parts, scenes
from .settings import examples
from .structures import Structure

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
_LONG = 1e4  # x0/v0; a longer phase creeps, and takes the test's integrator minutes


@parts
@examples(16)
@given(st.data())
def test_the_phases_one_after_another_are_the_collision(structures: list[Structure], data: st.DataObject) -> None:
    """States run from `before` to `after`, guards vanish there, resets lead on, and the outputs are the results."""
    scene = data.draw(scenes(structures))
    collision = decided(scene, rtol=1e-10)
    try:
        found = equations(scene)
    except ComputationError:  # beside a separatrix, where no engine of CasADi can repeat the kernel's trajectory
        assume(False)
        raise
    assert found.outcome == collision.outcome
    groups, functions = list(found.groups.values()), found.functions
    assert functions["groups"](list(found.entries.values())).full().ravel() == pytest.approx(groups, rel=1e-14)
    state = functions["start"](groups).full().ravel()
    assert len(state) == len(found.states)
    time = 0.0
    for k, phase in enumerate(found.phases):
        assert state == pytest.approx(phase.before, rel=1e-12, abs=1e-12)
        assert phase.duration > 0
        assume(phase.duration < _LONG)
        rates = functions[f"rates_{k}"]
        solution = solve_ivp(
            lambda t, y, rates=rates: rates(y, groups).full().ravel(),
            (0, phase.duration), phase.before, "Radau", rtol=1e-9, atol=1e-12,
        )  # fmt: skip
        size = np.abs(solution.y).max(axis=1) + 1e-3
        assert np.abs(solution.y[:, -1] - phase.after) == pytest.approx(0 * size, abs=2e-5 * float(size.max()))
        state = phase.after
        if f"event_{k}" in functions:
            guards = [functions[f"event_{k}"](y, groups).full().item() for y in (phase.before, phase.after)]
            assert abs(guards[1]) <= 1e-9 * max(1.0, abs(guards[0]))
            assert functions[f"events_{k}"](phase.after, groups).numel() == len(phase.watched)
            state = functions[f"reset_{k}"](phase.after, groups).full().ravel()
        time += phase.duration
    if collision.outcome == "stick":
        return
    results = dict(zip(found.outputs["outputs"], functions["outputs"](state, groups).full().ravel(), strict=True))
    assert results["restitution"] == pytest.approx(collision.restitution, rel=1e-5, abs=1e-7)
    assert time * found.scales["time"] == pytest.approx(collision.contact_time, rel=1e-5, abs=1e-15)
    assert collision.energy is not None
    kinetic = found.outputs["energies"].index("kinetic")
    final = functions["energies"](state, groups)[kinetic].full().item() * found.scales["energy"]
    assert final == pytest.approx(collision.energy.final, rel=1e-5, abs=1e-7 * collision.energy.initial)
    for name in ("final_spin", "final_spin_partner", "final_rotation_rate"):
        if name in results:
            most = found.scales["rate"]
            assert results[name] * most == pytest.approx(getattr(collision, name), rel=1e-5, abs=1e-6 * most)
    assert set(found.units) >= {*found.states, *found.groups, *found.scales, *found.entries, *results, "duration"}
