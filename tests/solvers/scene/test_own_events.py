"""Events that a model file declares: by every engine, with ledger, derivatives, boundaries and proofs."""

import math
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import ComputationError, InputError, Scene, atlas, boundary, collide_many, regime_map
from wetdoublet.solvers.boundaries.on_map import map_curves

from ...helpers.judged_models import compared
from ...helpers.reference import collide
from ...helpers.snapping import EVENTS

pytestmark = pytest.mark.slow
ANGLE = math.radians(60)
SOFT = {"particles.dry_restitution": 0.5}  # head-on, some doublets rebound, leave the film, and are pulled back


@pytest.fixture(scope="module")
def snaps(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The model file; what is derived from it is kept in the cache."""
    path = tmp_path_factory.mktemp("events") / "snaps.py"
    path.write_text(EVENTS)
    return path


def scene(model: Path, **custom: object) -> Scene:
    """Granulation with the model's bridge."""
    own = {f"custom.{name}": value for name, value in custom.items()}
    return Scene.load("granulation", model=model).with_entries(own)


def test_what_a_jump_takes_is_booked(snaps: Path):
    """A brake that leaves half of the speed takes three quarters of that motion's energy, and the ledger closes."""
    own = scene(snaps, braking_gap="20 um")
    found = collide(own, stokes=0.5, angle=0.0, rtol=1e-10)
    free = collide(scene(snaps), stokes=0.5, angle=0.0, rtol=1e-10)
    assert found.energy is not None
    assert "braked" in [event.kind for event in found.events]
    unit, pull = own.particles.reduced_mass / 2, 4 * math.pi * own.particles.reduced_radius * own.bridge.surface_tension
    # where it brakes, from what it has without the brake at rupture
    before = (free.speed * free.restitution) ** 2 + pull / unit * (own.rupture_gap - 20e-6)
    assert found.energy.own_events == pytest.approx(0.75 * unit * before, rel=1e-8)
    assert abs(found.energy.residual) < 1e-8 * found.energy.initial
    many = collide_many(own, stokes=[0.5], angle=0.0, rtol=1e-10, of=("energy.final", "energy.residual"))
    assert many["energy.final"].item() == pytest.approx(found.energy.final, rel=1e-8)
    assert abs(many["energy.residual"].item()) < 1e-8 * found.energy.initial


def test_a_proved_stick_sticks_beside_events(snaps: Path):
    """A stick that is proved although an event might have come: it does not, however long it is followed on."""
    own = scene(snaps, critical_rate="6e4 1/s").with_entries(SOFT)
    stick = collide(own, stokes=0.117, angle=0.1, engine="rosenbrock", ledger=False)
    assert (stick.outcome, stick.certified) == ("stick", True)
    followed = collide(own, stokes=0.117, angle=0.1, until=20 * stick.until, ledger=False)
    assert followed.outcome == "stick"


@pytest.mark.parametrize(
    ("custom", "impact"),
    [
        ({"leaving_speed": "0.05 m/s", "braking_gap": "12 um"}, {"stokes": 0.08, "angle": ANGLE}),
        ({"critical_rate": "6e3 1/s", "leaving_speed": "0.1 m/s"}, {"stokes": 0.08, "angle": ANGLE}),
        ({"braking_gap": "20 um"}, {"stokes": 0.5, "angle": 0.0}),
    ],
)
def test_all_engines_agree_and_their_derivatives_pass_the_jumps(snaps: Path, custom: dict[str, str], impact: dict):
    """Results, ledgers, and the saltation of guard and jump: derivatives of e_n are those of differences."""
    verdict, how = compared(scene(snaps, **custom), impact)
    assert verdict == "right", how


def test_a_boundary_is_named_after_its_event(snaps: Path):
    """A change of outcome that an event makes: there the film is left at the critical rate, which alone it passes."""
    rate = 2e4
    own = scene(snaps, critical_rate=rate).with_entries(SOFT)
    (line,) = boundary(own, angle=[0.0], stokes=(0.11, 0.13)).changes
    assert [(one.before, one.after, one.kind) for one in line] == [("stick", "bounce", "event snap")]
    at = line[0].stokes
    free = collide(own.with_entries({"custom.critical_rate": 1e3}), stokes=at, angle=0.0, rtol=1e-10, ledger=False)
    assert [event.kind for event in free.events] == ["glass", "film edge", "snap"]
    assert free.restitution * free.speed == pytest.approx(rate * own.liquid.film_thickness, rel=1e-7)


def test_what_needs_the_kinds_of_curves_is_refused(snaps: Path):
    """They are told by functions that know of no declared event: no atlas, no lines over a map."""
    own = scene(snaps, critical_rate="1e4 1/s")
    with pytest.raises(InputError, match="declares events, terms or criteria; accepted: boundaries at so many angles"):
        atlas(own, over="impact.angle", span=(0.0, 0.3), stokes=(0.1, 0.2))
    assert map_curves(regime_map(own, stokes=[0.05, 0.1], angle=[0.5, 1.0]), own.package) == {}


def test_energy_is_not_created_unsaid(snaps: Path):
    """A jump that adds energy which the event does not declare is an error with phase and advice."""
    for engine in ("rosenbrock", None):
        with pytest.raises(ComputationError, match="the event braked creates .* that it does not declare in phase"):
            collide(scene(snaps, kept=2.0, braking_gap="12 um"), stokes=0.3, angle=0.0, engine=engine)


TURNS = '''"""The collision ends when the doublet has turned far enough."""
from wetdoublet.derive.user import *

last = quantity("last", default=1000.0, meaning="angle at which it ends")
event("at last", guard=last - beta, ends="stick")
'''


def test_a_guard_of_the_angle(tmp_path: Path):
    """An end at an angle: where the library's own trajectory is then, by every engine."""
    path = tmp_path / "turns.py"
    path.write_text(TURNS)
    impact = {"stokes": 0.02, "angle": math.radians(75)}
    library = collide(Scene.load("granulation"), **impact, trajectory=True, engine="cvodes", rtol=1e-12).trajectory
    place = int(0.6 * library.time.size)
    own = Scene.load("granulation", model=path).with_entries({"custom.last": float(library.rotation[place])})
    for engine in ("taylor", "rosenbrock", "cvodes"):
        found = collide(own, **impact, engine=engine)
        assert found.engine == engine
        assert (found.events[-1].kind, found.outcome) == ("at last", "stick")
        assert found.events[-1].time == pytest.approx(float(library.time[place]), rel=1e-7)


TWO = '''"""Two events at one gap."""
from wetdoublet.derive.user import *

place = quantity("place", unit="m", default="5 um", meaning="a gap")
{}
'''
HALF, END = (
    'event("half", guard={}, where="opening", jump={{u: u / 2}})',
    'event("end", guard={}, where="opening", ends="separated")',
)


def with_two(folder: Path, body: str, name: str = "two") -> Scene:
    """Granulation with a model of these events at a place."""
    (folder / f"{name}.py").write_text(TWO.format(body))
    return Scene.load("granulation", model=folder / f"{name}.py")


@pytest.mark.parametrize("ends_first", [False, True])
def test_of_two_events_at_once_the_order_of_the_file_counts(tmp_path: Path, ends_first: bool):
    """Half the speed, then the end; or the end alone: by every engine."""
    rows = [HALF.format("3*(place - x)*m/x"), END.format("place - x")]
    if ends_first:
        rows = [END.format("place - x"), HALF.format("3*(place - x)*m/x")]
    own, single = (
        with_two(tmp_path, each, str(k)) for k, each in enumerate(("\n".join(rows), END.format("place - x")))
    )
    speed = own.speed_of(0.08)
    expected = collide(single, speed=speed, angle=ANGLE)
    for engine in ("taylor", "rosenbrock", "cvodes"):
        found = collide(own, speed=speed, angle=ANGLE, engine=engine)
        assert [event.kind for event in found.events][1:] == (["end"] if ends_first else ["half", "end"])
        assert found.restitution == pytest.approx(expected.restitution / (1 if ends_first else 2), rel=1e-7)
        assert found.contact_time == pytest.approx(expected.contact_time, rel=1e-7)


def test_an_event_that_reverses_is_no_stick(tmp_path: Path):
    """Head-on in the film alone: u = -v0 (1 - L(x/x0)/St), halved and reversed at a gap; the film takes L again."""
    path = tmp_path / "soft.py"
    path.write_text(TWO.format('event("soft", guard=x - place, where="closing", jump={u: -u / 2})'))
    own = Scene.load("granulation-dry-bridge", model=path).with_entries({"liquid.glass_transition_pressure": "2 GPa"})
    s = 5e-6 / own.liquid.film_thickness
    taken = (math.log(1 / s) - 1.5 + 2 * s - s**2 / 2) / 0.4
    for engine in ("taylor", "rosenbrock"):
        found = collide(own, stokes=0.4, angle=0.0, engine=engine)
        assert [event.kind for event in found.events] == ["soft", "rupture"]
        assert found.restitution == pytest.approx((1 - taken) / 2 - taken, rel=1e-7)


def test_no_stick_is_proved_before_the_second_of_two_events(tmp_path: Path):
    """Behind a harmless event at the same gap, or while the mark of another event keeps its guard positive."""
    bodies = {
        "alone": END.format("place - x"),
        "behind": HALF.format("3*(place - x)*m/x") + "\n" + END.format("place - x"),
        "marked": 'closed = event("deep", guard=x - place, where="closing")\n' + END.format("place*(1 + closed) - x"),
    }
    entries = {"particles.roughness": "4 um", "custom.place": "1 um"}  # it opens from 4 um, beyond that place
    outcomes = {}
    for name, body in bodies.items():
        own = with_two(tmp_path, body, name).with_entries(entries)
        outcomes[name] = collide_many(own, stokes=np.linspace(0.005, 0.06, 23), angle=ANGLE)["outcome"].values
    assert (outcomes["alone"] > 0).all()
    assert all((outcomes[name] == outcomes["alone"]).all() for name in ("behind", "marked"))


# Equal spheres whose liquid turns to glass again and again, ever deeper in the film, while the bridge holds them.
CHATTERS = {
    "particles.reduced_radius": 8.4368e-06, "particles.density": 5920.68, "particles.roughness": 2.28375e-11,
    "particles.dry_restitution": 0.3, "liquid.viscosity": 0.0013101, "liquid.film_thickness": 1.45882e-07,
    "liquid.glass_transition_pressure": 286324.0, "bridge.surface_tension": 0.571652, "bridge.volume": 0.00792969,
    "bridge.contact_angle": 1.29799, "impact.stokes": 1.85967, "impact.angle": 0.729151,
}  # fmt: skip


def test_chatter_below_the_barrier_is_a_proved_stick_beside_an_event(tmp_path: Path):
    """The event needs a speed beyond the film, where the energy that is left does not lead."""
    path = tmp_path / "snap.py"
    path.write_text(
        '"""x"""\nfrom wetdoublet.derive.user import *\n'
        'rate = quantity("rate", unit="1/s", default="1 1/s", meaning="of snapping")\n'
        'event("snap", guard=rate - u/x, where="opening beyond the film", ends="separated")\n'
    )
    plain = Scene("chatters", tuple(CHATTERS.items()))
    own = plain.with_model(path)
    own = own.with_entries({"custom.rate": 0.1 * own.need_impact()[0] / own.liquid.film_thickness})
    found, longer = collide(own, engine="taylor"), 20 * own.liquid.film_thickness / own.need_impact()[0]
    assert (found.outcome, found.certified) == ("stick", True)
    assert found.until < longer
    assert found.steps < 200
    for scene in (plain, own):  # chatter goes on, and does not lead there
        followed = collide(scene, engine="taylor", until=0.1 * longer)
        assert "film edge" not in [event.kind for event in followed.events]


def test_a_guard_that_swings_is_not_passed_while_the_doublet_creeps(tmp_path: Path):
    """A gap below height cos(rate t): within one period after the gap has fallen below the height, for good."""
    path = tmp_path / "shaken.py"
    path.write_text(
        '"""x"""\nfrom wetdoublet.derive.user import *\n'
        'height = quantity("height", unit="m", default="1 um", meaning="amplitude")\n'
        'rate = quantity("rate", unit="1/s", default="0 1/s", bounds=">= 0", meaning="of the oscillation")\n'
        'event("touch", guard=x - height*cos(rate*t), where="closing", jump={u: u + v0/100}, releases=m*v0**2)\n'
    )
    entries = {
        "particles.reduced_radius": 0.000400493, "particles.density": 4136.17, "particles.roughness": 5.95141e-10,
        "particles.dry_restitution": 0.3, "liquid.viscosity": 4.39362, "liquid.film_thickness": 4.68712e-07,
        "liquid.glass_transition_pressure": 1632150000.0, "bridge.surface_tension": 0.0699936,
        "bridge.volume": 0.000182508, "bridge.contact_angle": 0.0, "impact.stokes": 0.0166261, "impact.angle": 0.925123,
    }  # fmt: skip
    own = Scene("creeps", tuple(entries.items())).with_model(path)
    film, times = own.liquid.film_thickness, []
    for rate in (0.0, 10.0 * own.need_impact()[0] / film):
        found = collide(own.with_entries({"custom.height": 0.3 * film, "custom.rate": rate}), engine="taylor")
        [touch] = [event.time for event in found.events if event.kind == "touch"]
        times.append(touch)
    assert times[0] < times[1] < times[0] + 2 * math.pi / rate
