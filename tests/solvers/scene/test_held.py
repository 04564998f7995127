"""What an impact keeps while other entries of its scene change: one rule for all ways of changing them."""

import json
import math

import pytest
from wetdoublet.solvers import Scene, collide, collide_many, regime_map

from ...helpers.command import run

THICKER = {"liquid.viscosity": "2.2 Pa s"}
GRANULATION = Scene.load("granulation")


def test_the_speed_stays_where_the_stokes_number_is_given() -> None:
    """A binder thicker by 10 % lowers St by 10 %; the speed and the way in which it is given stay."""
    changed = GRANULATION.with_entries(THICKER)
    assert changed.speed == pytest.approx(GRANULATION.speed, rel=1e-14)
    assert changed.impact.stokes == pytest.approx(0.03 / 1.1, rel=1e-14)
    assert "normal speed 0.5437 m/s" in changed.held
    assert changed.held in changed.to_toml()


@pytest.mark.parametrize("way", ["stokes", "speed", "relative_speed"])
@pytest.mark.parametrize("hold", ["stokes", "speed", "relative_speed"])
def test_what_is_held_does_not_depend_on_how_it_is_given(way: str, hold: str) -> None:
    """Of a density and an angle that change, exactly the held quantity is what it was."""
    scene = GRANULATION.with_impact(**{way: 0.7})  # type: ignore[arg-type]  # by keyword
    changed = scene.with_entries({"particles.reduced_mass": "9e-6 g", "impact.angle": "70 deg"}, hold=hold)

    def values(one: Scene) -> dict[str, float]:
        speed, angle = one.need_impact()
        return {"speed": speed, "stokes": one.stokes_of(speed), "relative_speed": speed / math.cos(angle)}

    before, after = values(scene), values(changed)
    assert [name for name in before if after[name] == pytest.approx(before[name], rel=1e-12)] == [hold]
    assert getattr(changed.impact, way) is not None


def test_nothing_is_held_of_an_impact_that_is_given_anew() -> None:
    """An impact among the changes, or set afterwards, wins; nothing is said to be held then."""
    for changed in (
        GRANULATION.with_entries({**THICKER, "impact.stokes": 0.03}),
        GRANULATION.with_entries(THICKER).with_impact(stokes=0.03),
    ):
        assert (changed.impact.stokes, changed.held) == (0.03, "")
    assert GRANULATION.with_entries({"particles.roughness": "0.3 um"}).held == ""  # speed and number do not differ


def test_batches_and_maps_hold_the_scenes_speed() -> None:
    """Collisions of varied viscosities are those of the scenes with these viscosities, whatever is held."""
    vary = {"liquid.viscosity": [2.2]}
    for hold in (None, "stokes"):
        one = collide(GRANULATION.with_entries(THICKER, hold))
        many = collide_many(GRANULATION, vary=vary, hold=hold)
        drawn = regime_map(GRANULATION, vary=vary, hold=hold, of=("restitution",))
        assert many.restitution.item() == pytest.approx(one.restitution, rel=1e-7)
        assert drawn.restitution.item() == pytest.approx(one.restitution, rel=1e-7)
        assert many.attrs["held"] == drawn.attrs["held"]
        assert many.attrs["held"].startswith("held: Stokes number" if hold else "held: normal speed")


def test_commands_hold_and_say_so() -> None:
    """`--set` keeps the speed and `--hold stokes` the number, in text and JSON; `--stokes` leaves nothing to say."""
    words = ("collide", "granulation", "--set", "liquid.viscosity=2.2 Pa s")
    held, number = (json.loads(run(*words, *more, "--json").stdout) for more in ((), ("--hold", "stokes")))
    assert held["speed"] == pytest.approx(0.5437, rel=1e-4)
    assert held["restitution"] == pytest.approx(0.5022, abs=1e-4)
    assert number["stokes"] == pytest.approx(0.03)
    assert number["restitution"] == pytest.approx(0.5517, abs=1e-4)
    assert "normal speed" in held["held"]
    assert "Stokes number 0.03" in number["held"]
    assert "held: normal speed 0.5437 m/s; Stokes number 0.03 -> 0.02727" in run(*words).stdout
    assert "held" not in json.loads(run(*words, "--stokes", "0.03", "--json").stdout)
