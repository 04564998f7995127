"""The equations of a scene as plain CasADi functions: what stands at their edges."""

import pytest
from wetdoublet.solvers import InputError, Scene, collide, equations

from ...helpers.snapping import EVENTS


def test_the_text_has_everything_with_its_unit():
    """States, groups, scales and phases, each with its unit; every function with its arguments."""
    found = equations("granulation")
    text = str(found)
    for name, value in {**found.groups, **found.scales}.items():
        (line,) = [line for line in text.splitlines() if line.split()[:1] == [name]]
        assert float(line.split()[1]) == pytest.approx(value, rel=1e-5)
        assert line.endswith(found.units[name])
    assert "orbital_momentum [a^2 Omega]" in text
    assert [phase.event for phase in found.phases] == [event.kind for event in collide("granulation").events]
    assert all(phase.name in text for phase in found.phases)
    assert "  rates_K:(state[4],groups[13])->(rates[4])\n      Rates of the states per v0/x0." in text
    assert "->(energies)\n      Energies of the state over m v0^2.\n" in text
    of_phases = {f"{name}_{k}" for name in ("rates", "events", "event", "reset") for k in range(3)}
    assert {*found.functions} - of_phases == {*found.docs} - {"rates_K", "events_K", "event_K", "reset_K"}
    assert found.units["liquid.viscosity"] == "Pa s"
    assert found.units["final_spin"] == "Omega" and found.units["kinetic"] == "m v0^2"


def test_what_happens_at_initial_contact_is_in_the_start():
    """Glass at x = x0: the collision begins behind the rebound, and no phase takes no time."""
    scene = Scene.load("granulation").with_impact(stokes=0.3, angle="20 deg")
    assert collide(scene).events[0].time == 0
    found = equations(scene)
    start = found.functions["start"](list(found.groups.values())).full().ravel()
    assert start[:2] == pytest.approx([1.0, 0.99])
    assert [phase.event for phase in found.phases] == ["rupture"]


def test_a_stick_has_phases_up_to_where_it_is_certain():
    """None where that is initial contact; `until` follows it on; the last phase of a stick has no event."""
    scene = Scene.load("granulation").with_impact(stokes=0.012, angle="50 deg")
    assert equations(scene).phases == () and "certain at initial contact" in str(equations(scene))
    found = equations(scene, until="1 ms")
    assert found.outcome == "stick"
    assert sum(phase.duration for phase in found.phases) * found.scales["time"] == pytest.approx(1e-3)
    last = len(found.phases) - 1
    assert found.phases[-1].event == "" and f"event_{last}" not in found.functions
    with pytest.raises(InputError, match=r"impact\.angle"):
        equations(Scene.from_toml(Scene.load("granulation").to_toml().replace('angle = "60 deg"', "")))


@pytest.mark.slow
def test_the_equations_of_a_model_of_ones_own(tmp_path):
    """`model` takes a model file: its entries, its events and its laws are in the functions."""
    path = tmp_path / "snaps.py"
    path.write_text(EVENTS)
    scene = Scene.load("granulation", model=path).with_entries({"custom.critical_rate": "9e3 1/s"})
    found = equations(scene.with_impact(stokes=0.02, angle="75 deg"))
    assert found.phases[-1].event == "snap"
    assert found.entries["custom.critical_rate"] == 9e3
    last = len(found.phases) - 1
    values = dict(found.entries) | {"custom.critical_rate": 8e3}
    groups = found.functions["groups"](list(values.values()))
    assert float(found.functions[f"event_{last}"](found.phases[-1].after, groups)) < -1e-3
    assert equations("granulation", model=path).entries["custom.kept"] == 0.5
