"""Declared events in resting contact, where the gap is held: the rotation has a closed form, and the time goes on."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, collide_many

from ...helpers.reference import collide
from ...helpers.snapping import BRIDGE, TIMED, TORQUE
from ...helpers.two_bodies import bodies_of

pytestmark = pytest.mark.slow
# The liquid is glass at initial contact, and nothing rebounds: the doublet rests at the gap x0 from the start.
RESTING = {"particles.dry_restitution": 0.0, "bridge.surface_tension": "0.5 N/m"}
IMPACT = {"stokes": 0.5, "angle": math.radians(10)}
ENGINES = ("taylor", "rosenbrock", "cvodes")


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Model files: with a bridge that lets go, and with a torque."""
    folder = tmp_path_factory.mktemp("rest")
    unused = "\n".join(line for line in TIMED.splitlines() if not line.startswith("holding"))
    texts = {"bridge": TIMED + BRIDGE, "torque": unused + "\n" + TORQUE}
    for name, text in texts.items():
        (folder / f"{name}.py").write_text(text)
    return {name: folder / f"{name}.py" for name in texts}


class Rotation:
    """The rotation of equal spheres at the gap x0, under their tangential force and a torque on the line of centres."""

    def __init__(self, scene: Scene, speed: float, torque: float = 0.0) -> None:
        bodies = bodies_of(scene)
        a, m, x = bodies.a, bodies.m, bodies.film_thickness
        r, inertia = 4 * a + x, 16 / 5 * m * a**2
        drag = 8 * math.pi * scene.liquid.viscosity * a**2 * math.log(2 * a / x)  # tangential force over omega - xi
        self.start = speed * math.tan(IMPACT["angle"]) / (4 * a)  # omega; xi is zero
        self.decay, self.push = drag / (m * r) + drag * r / (2 * inertia), torque / (m * r**2)
        self.taken, self.given = drag / (m * r), drag * r / (2 * inertia)

    def slip(self, t: float) -> tuple[float, float]:
        """Omega - xi at a time (s), and its integral up to then."""
        steady, gone = self.push / self.decay, -math.expm1(-self.decay * t) / self.decay
        slip = steady + (self.start - steady) * math.exp(-self.decay * t)
        return slip, steady * t + (self.start - steady) * gone

    def rate(self, t: float) -> float:
        """omega, rad/s."""
        return self.start + self.push * t - self.taken * self.slip(t)[1]

    def spin(self, t: float) -> float:
        """xi, rad/s."""
        return self.given * self.slip(t)[1]

    def angle(self, t: float) -> float:
        """beta, rad."""
        steady = self.push / self.decay
        twice = steady * t**2 / 2 + (self.start - steady) * (t + math.expm1(-self.decay * t) / self.decay) / self.decay
        return self.start * t + self.push * t**2 / 2 - self.taken * twice


def written(folder: Path, body: str, name: str = "own") -> Path:
    """A model file of these lines."""
    path = folder / f"{name}.py"
    path.write_text(f'"""x"""\nfrom wetdoublet.derive.user import *\n{body}')
    return path


def scene(model: Path, **custom: object) -> Scene:
    """Granulation that rests at initial contact, with a model."""
    return Scene.load("granulation", model=model).with_entries(
        RESTING | {f"custom.{name}": value for name, value in custom.items()}
    )


@pytest.mark.parametrize(
    ("engine", "model", "torque"),
    [
        ("taylor", "bridge", 0.0), ("cvodes", "torque", 1e-11), ("rosenbrock", "torque", -3e-12),
    ],
)  # fmt: skip
def test_cut_offs_come_when_the_rotation_or_the_time_is_there(
    models: dict[str, Path], engine: str, model: str, torque: float
):
    """At an angle turned, at a spin and at a time, as the closed form has them."""
    own = scene(models[model], **({"twist": torque} if torque else {}))
    speed = own.speed_of(IMPACT["stokes"])
    expected, end = Rotation(own, speed, torque), 2e-3
    spun = min(end, 0.7 / expected.decay)
    cases = {
        "far enough": ({"custom.largest": expected.angle(end)}, end),
        "late": ({"custom.last": end}, end),
        "spun": ({"custom.fastest": expected.spin(spun)}, spun),
    }
    for word, (threshold, time) in cases.items():
        found = collide(own.with_entries(threshold), **IMPACT, engine=engine)
        assert found.engine == engine
        assert [event.kind for event in found.events] == ["glass", "rests", word]
        assert (found.outcome, found.certified) == ("stick", False)
        assert found.events[-1].time == pytest.approx(time, rel=1e-7)


LATE = """
kicked = quantity("kicked", unit="s", default="1e8 s")
given = quantity("given", unit="m/s", default="0 m/s", bounds=">= 0")
event("kick", guard=kicked - t, jump={u: u + given}, releases=m*given**2)
"""


@pytest.mark.parametrize("engine", ["rosenbrock", "cvodes"])
def test_a_rest_of_years_is_replayed(engine: str, tmp_path: Path):
    """When nothing slips any more an engine need not integrate: three years later the energy is the closed form's."""
    own = scene(written(tmp_path, LATE))
    found, bodies = collide(own, **IMPACT, engine=engine, ledger=True), bodies_of(own)
    assert (found.engine, found.events[-1].kind, found.steps < 1000) == (engine, "kick", True)
    assert found.events[-1].time == pytest.approx(1e8, rel=1e-12)
    rotation, r = Rotation(own, found.speed), 4 * bodies.a + bodies.film_thickness
    energy = bodies.m * (r * rotation.rate(1e8)) ** 2 / 2 + 16 / 5 * bodies.m * bodies.a**2 * rotation.spin(1e8) ** 2
    assert found.energy.final == pytest.approx(energy, rel=1e-8)


def test_a_torque_turns_back(models: dict[str, Path]):
    """An angle is never reached where the torque turns the doublet back before."""
    own = scene(models["torque"], twist=-1e-10, last=0.02)
    expected = Rotation(own, own.speed_of(IMPACT["stokes"]), -1e-10)
    turned = brentq(expected.rate, 0.0, 0.02)
    for share, word in ((1 - 1e-6, "far enough"), (1 + 1e-6, "late")):
        found = collide(own.with_entries({"custom.largest": share * expected.angle(turned)}), **IMPACT)
        assert found.events[-1].kind == word


@pytest.mark.parametrize("engine", ENGINES)
def test_a_bridge_that_lets_go_releases_what_rests(models: dict[str, Path], engine: str):
    """No stick is proved before; then the doublet opens with the rotation that it has, with its whole energy."""
    held = 1.5e-3
    own = scene(models["bridge"], holding=held)
    found = collide(own, **IMPACT, engine=engine)
    assert [event.kind for event in found.events] == ["glass", "rests", "lets go", "released", "rupture"]
    assert [event.time for event in found.events[2:4]] == pytest.approx([held, held], rel=1e-9)
    rotation, bodies = Rotation(own, own.speed_of(IMPACT["stokes"])), bodies_of(own)
    a, m, x0, spin = bodies.a, bodies.m, bodies.film_thickness, rotation.spin(held)
    # beyond the film; shear has no slip left to act on but what opening makes, which is of the order of the gap
    energy = m * (4 * a + x0) ** 2 * rotation.rate(held) ** 2 / 2 + 16 / 5 * m * a**2 * spin**2
    final = m * ((4 * a + found.final_gap) * found.final_rotation_rate) ** 2 / 2
    final += 16 / 5 * m * a**2 * found.final_spin**2 + m * (found.restitution * found.speed) ** 2 / 2
    assert found.energy is not None
    assert final + found.energy.tangential_lubrication - (
        m * (rotation.start * (4 * a + x0)) ** 2 / 2 - energy
    ) == pytest.approx(energy, rel=1e-7)
    assert abs(found.energy.residual) < 1e-8 * found.energy.initial


def test_head_on_a_stick_is_proved_when_nothing_is_to_come(models: dict[str, Path]):
    """Not while the bridge is to let go: without forces the doublet then rests, and the stick is proved there."""
    for engine in ENGINES:
        own = scene(models["bridge"], holding=1.5e-3, kicked=1e-3)
        found = collide(own, stokes=0.5, angle=0.0, engine=engine)
        assert [event.kind for event in found.events] == ["glass", "rests", "kick", "lets go"]
        assert (found.outcome, found.certified) == ("stick", True)
        assert found.until == pytest.approx(1.5e-3, rel=1e-9)


@pytest.mark.parametrize("angle", [0.0, 1e-3])
def test_a_kick_sets_free(models: dict[str, Path], angle: float):
    """Beyond the film a bridge of constant force brakes what a kick has opened: e_n by its work."""
    own = scene(models["bridge"], kicked=1e-3, given=5.0)
    bodies = bodies_of(own)
    for engine in ENGINES:
        found = collide(own, stokes=0.5, angle=angle, engine=engine)
        assert [event.kind for event in found.events] == ["glass", "rests", "kick", "rupture"]
        work = 4 * math.pi * bodies.a * own.bridge.surface_tension * (bodies.rupture - bodies.film_thickness)
        expected = math.sqrt(5.0**2 - 2 * work / bodies.m) / found.speed
        assert found.restitution == pytest.approx(expected, rel=1e-9 if angle == 0.0 else 1e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_torque_releases_beyond_the_tangential_force(models: dict[str, Path], engine: str):
    """Where no shear acts, omega = omega0 + torque t/(m r^2), until m r omega^2 exceeds the bridge's force."""
    twist = 1e-11
    own = scene(models["torque"], twist=twist).with_entries({"model.tangential": "film"})
    found, bodies = collide(own, **IMPACT, engine=engine), bodies_of(own)
    m, r = bodies.m, 4 * bodies.a + bodies.film_thickness
    start = found.speed * math.tan(IMPACT["angle"]) / (4 * bodies.a)
    needed = math.sqrt(bodies.pull(bodies.film_thickness) / (m * r))
    assert [event.kind for event in found.events] == ["glass", "rests", "released", "rupture"]
    assert found.events[2].time == pytest.approx((needed - start) * m * r**2 / twist, rel=1e-7)


def test_a_kick_inward_rebounds(models: dict[str, Path]):
    """What is kicked into the contact rebounds there, and here comes to rest again."""
    found = collide(scene(models["torque"], kicked=1e-3, given=-5.0, last=2e-3), **IMPACT)
    assert [event.kind for event in found.events] == ["glass", "rests", "kick", "glass", "rests", "late"]


def test_a_proof_stands_beside_a_cut_off(tmp_path: Path):
    """A cut-off changes no barrier: the stick is proved at rest; followed on, it is cut off when the angle is there."""
    far = 'largest = quantity("largest", default=1e9)\nevent("far enough", guard=largest - beta, ends="stick")\n'
    own = scene(written(tmp_path, far))
    expected = Rotation(own, own.speed_of(IMPACT["stokes"]))
    own = own.with_entries({"custom.largest": expected.angle(2e-3)})
    proved = collide(own, **IMPACT)
    assert proved.certified
    assert proved.until < 1e-6
    for engine in ENGINES:
        found = collide(own, **IMPACT, until=5e-3, engine=engine)
        assert [event.kind for event in found.events] == ["glass", "rests", "far enough"]
        assert found.until == pytest.approx(2e-3, rel=1e-7)
        assert found.certified


NEVER = """
fastest = quantity("fastest", unit="1/s", default="1e6 1/s")
later = quantity("later", unit="s", default="1 s")
level = quantity("level", default=1)
for word, guard in {"spun": fastest - xi, "timed": t + later, "turned far": 2*level + cos(beta)}.items():
    event(word, guard=guard, jump={u: u + v0}, releases=m*v0**2)
"""


@pytest.mark.parametrize("entries", [{}, RESTING], ids=["rebounds first", "rests at once"])
def test_events_that_never_come_keep_no_stick_undecided(entries: dict[str, object], tmp_path: Path):
    """Guards that stay positive: a stick without the events, alone, in a batch and replayed, after a bounded time."""
    scene = Scene.load("granulation", model=written(tmp_path, NEVER)).with_entries(entries)
    impact = IMPACT if entries else {"stokes": 0.01, "angle": math.radians(60)}
    for angle in (impact["angle"], 0.0):
        assert collide_many(scene, stokes=[impact["stokes"]] * 3, angle=angle).outcome.values.tolist() == [0, 0, 0]
        for engine in ENGINES:
            alone = collide(scene, stokes=impact["stokes"], angle=angle, engine=engine)
            assert alone.outcome == "stick"
            assert not {"spun", "timed", "turned far"} & {event.kind for event in alone.events}
            assert alone.steps < 1e5


RUNAWAY = """
fastest = quantity("fastest", unit="1/s", default="1e4 1/s", meaning="spin at which it ends")
start = quantity("start", unit="N m", default="1e-20 N m", meaning="torque on the spin")
growth = quantity("growth", unit="1/s", default="1e3 1/s", meaning="rate at which the spin grows")
force_on("spin", start + growth * Rational(32, 5) * m * a**2 * xi)
event("spun", guard=fastest - xi, ends="stick")
"""


def test_a_spin_that_grows_from_nearly_nothing_is_not_settled(tmp_path: Path):
    """Where no shear acts, xi = s/(I k) (exp(k t) - 1): from 1e-18 of the initial rotation rate to the event."""
    own = scene(written(tmp_path, RUNAWAY)).with_entries({"model.tangential": "film"})
    bodies, growth, fastest = bodies_of(own), 1e3, 1e4
    least = 9e-19 * own.speed_of(IMPACT["stokes"]) * math.tan(IMPACT["angle"]) / (4 * bodies.a)
    own = own.with_entries({"custom.start": least * growth * 32 / 5 * bodies.m * bodies.a**2})
    found = collide(own, **IMPACT, engine="taylor", rtol=1e-12)
    assert [event.kind for event in found.events] == ["glass", "rests", "spun"]
    # what is below the absolute tolerance grows by rates that are less accurate
    assert found.events[-1].time == pytest.approx(math.log1p(fastest / least) / growth, rel=0.01)


def test_an_angle_that_turns_for_ever_ends_alike_with_the_ledger_and_without(tmp_path: Path):
    """A guard that swings and stays positive: a stick after a thousand turns, within as many steps, by either form."""
    swings = 'event("kick", guard=largest + cos(beta), jump={u: u + v0}, releases=m*v0**2)\n'
    path = written(tmp_path, 'largest = quantity("largest", default=1.033)\n' + swings)
    entries = {"particles.dry_restitution": 0.3, "bridge.surface_tension": 0.509, "particles.roughness": 0.66e-6}
    own = Scene.load("granulation", model=path).with_entries(entries | {"liquid.viscosity": 0.185})
    impact = {"stokes": 0.0544, "angle": 0.1945}
    found = collide(own, **impact, engine="taylor")
    many = collide_many(own, stokes=[impact["stokes"]] * 3, angle=impact["angle"], of=("outcome", "steps", "until"))
    assert (found.outcome, many.outcome.values.tolist()) == ("stick", [0, 0, 0])
    assert found.steps < 2e4
    np.testing.assert_allclose(many.steps, found.steps, rtol=0.01)
    np.testing.assert_allclose(many.until, found.until, rtol=1e-3)


KICK = 'event("kick", guard={}, jump={{u: u + v0/4}}, releases=m*v0**2)\n'
FILM_ALONE = Scene.load("granulation-dry-bridge").with_entries({"liquid.glass_transition_pressure": "1e6 GPa"})


@pytest.mark.parametrize("wall", [False, True])
def test_what_a_film_has_stopped_waits_for_the_time_of_an_event(wall: bool, tmp_path: Path):
    """Head-on, or beside a wall, nothing moves a doublet that the film alone has stopped: a kick comes when due."""
    kick = 'kicked = quantity("kicked", unit="s", default="0.01 s")\n' + KICK
    plain = FILM_ALONE.with_entries({"partner.wall": True}) if wall else FILM_ALONE
    angle = 0.5 if wall else 0.0
    due, never = (
        plain.with_model(written(tmp_path, kick.format(guard), name))
        for name, guard in (("due", "kicked - t"), ("never", "kicked + t"))
    )
    for engine in ENGINES:
        found = collide(due, stokes=0.1, angle=angle, engine=engine)
        assert [event.kind for event in found.events] == ["turned", "kick"]
        assert (found.outcome, found.events[-1].time) == ("stick", pytest.approx(0.01, rel=1e-9))
    assert collide_many(never, stokes=[0.1] * 3, angle=angle).outcome.values.tolist() == [0, 0, 0]


def test_an_event_comes_when_its_guard_is_first_zero_however_fast_that_swings(tmp_path: Path):
    """Also in motion, and where the film has stopped the doublet: level + cos(rate t), at arccos(-level)/rate."""
    known = 'level = quantity("level", default=0.5)\nrate = quantity("rate", unit="1/s", default="100 1/s")\n'
    scene = FILM_ALONE.with_model(written(tmp_path, known + KICK.format("level + cos(rate*t)")))
    for rate, level in ((1e2, 0.99), (1e3, 0.5), (1e4, 0.5), (1e6, 0.99), (1e8, 0.99)):
        found = collide(scene.with_entries({"custom.rate": rate, "custom.level": level}), stokes=0.1, angle=0.0)
        [kick] = [event.time for event in found.events if event.kind == "kick"]
        assert kick == pytest.approx(math.acos(-level) / rate, rel=1e-6), (rate, level)


def test_a_guard_that_swings_with_the_time_and_stays_positive_keeps_no_stick_undecided(tmp_path: Path):
    """At rest a proved stick, turning or not; where the film has stopped the doublet, one within a bounded time."""
    known = 'level = quantity("level", default=0.5)\nrate = quantity("rate", unit="1/s", default="1e6 1/s")\n'
    model = written(tmp_path, known + KICK.format("2 - level*sin(rate*t)*cos(u/v0) - cos(rate*t)/2"))
    for own, stokes, certified in ((scene(model), 0.5, True), (FILM_ALONE.with_model(model), 0.1, False)):
        for engine in ("taylor", "rosenbrock"):
            found = collide(own, stokes=stokes, angle=0.0, engine=engine)
            assert (found.outcome, found.certified, found.steps < 1e5) == ("stick", certified, True)
        higher = own.with_entries({"custom.level": 1.49})
        assert collide_many(higher, stokes=[stokes] * 3, angle=0.0).outcome.values.tolist() == [0, 0, 0]
    turning = collide(scene(model), **IMPACT)
    assert (turning.outcome, turning.certified) == ("stick", True)
    comes = collide(scene(model).with_entries({"custom.level": 2.0}), **IMPACT)  # of amplitude sqrt(level^2 + 1/4)
    assert "kick" in [event.kind for event in comes.events]
