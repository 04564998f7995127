"""Forces for time steps: the law's collisions at second order, all that is conserved to rounding, no silent NaN."""

import math
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.collision.space.pairs import Bodies

from ...helpers.exported_law import FOUND, Law, law_alone
from ...helpers.flags import QUICK
from ...helpers.host_of_forces import Host
from .conftest import OWN, WALL
from .test_law_in_space import arrivals

pytestmark = [pytest.mark.slow, pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")]
FILM_ALONE = Scene.load("granulation-dry-bridge")
ROUGH = {"particles.friction": 0.2, "particles.contact_tangential_restitution": 0.5}
COUNT = 60


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The exported folder of unequal spheres with a bridge."""
    return law_alone(OWN, tmp_path_factory.mktemp("law") / "bridge")


@pytest.fixture(scope="module")
def law(folder: Path) -> Law:
    """Its law."""
    return Law(OWN, folder, *QUICK.split(), "-march=native")


@pytest.fixture(scope="module")
def host(law: Law, folder: Path) -> Host:
    """Its host."""
    return Host(OWN, law, folder)


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> tuple[Law, Host]:
    """Law and host of equal spheres without a bridge, whose kinetic energy is all there is."""
    folder = law_alone(FILM_ALONE, tmp_path_factory.mktemp("law") / "film")
    law = Law(FILM_ALONE, folder, *QUICK.split())
    return law, Host(FILM_ALONE, law, folder)


def durations(
    scene: Scene, law: Law, pairs: tuple[np.ndarray, np.ndarray, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """What the law says of pairs, and their contact times; of sticks ten times the time to cross the film."""
    found = law.collide_pairs(law.pairs(*pairs))
    normal, velocities, _ = pairs
    speed = -np.sum(normal * (velocities[:, 1] - velocities[:, 0]), axis=1)
    film = float(scene.material["film_thickness"])
    times = np.where(found["outcome"] > 0, found["time"], 10 * film / speed)
    return found, np.where(times > 0.0, times, film / speed)  # glass may be met at initial contact


@pytest.mark.parametrize("bridge", [True, False])
def test_the_law_is_the_limit_of_small_steps(bridge: bool, law: Law, host: Host, alone: tuple[Law, Host]):
    """All outcomes, unequal spheres with spins in any direction: 1 % at 1/20 of the contact time, and second order."""
    scene = OWN if bridge else FILM_ALONE
    law, host = (law, host) if bridge else alone
    pairs = arrivals(scene, COUNT, seed=3)
    found, times = durations(scene, law, pairs)
    away, errors = found["outcome"] > 0, {}
    assert set(found["outcome"].tolist()) >= ({0, 1, 2} if bridge else {1, 2})
    for steps in (20, 100):
        flown = host.fly(pairs, times / steps, 8 * steps)
        assert np.count_nonzero(flown["outcome"] != found["outcome"]) <= 1, steps
        assert flown["angular_momentum"].max() <= 1e-13
        errors[steps] = np.abs(flown["restitution"] - found["restitution"])[away & (flown["outcome"] > 0)]
    assert np.quantile(errors[20], 0.97) <= 0.01
    assert np.median(errors[20]) <= 1e-3
    part = 0.5 if bridge else 0.9  # without a bridge most bounce at initial contact, without an error
    assert np.quantile(errors[100], part) <= np.quantile(errors[20], part) / 8  # 25 of a second order


def test_a_film_never_adds_energy(alone: tuple[Law, Host]):
    """Without a bridge kinetic energy never exceeds its first value, at any step, of elastic spheres too."""
    law, host = alone
    pairs = arrivals(FILM_ALONE, COUNT, seed=6)
    _, times = durations(FILM_ALONE, law, pairs)
    for viscosity, restitution in ((1.0, 0.99), (1e-4, 1.0)):
        material = law.material()
        material["viscosity"] *= viscosity
        material["dry_restitution"] = restitution
        for steps in (1, 5, 40):
            flown = host.fly(pairs, times / steps, 10 * steps, material)
            assert flown["energy"].max() <= 1 + 1e-12, (viscosity, steps)
            assert flown["angular_momentum"].max() <= 1e-13


def test_a_stick_is_followed_for_long(law: Law, host: Host):
    """Sticks turn on as one body: the host's distance stays with the contact's, and nothing is lost of the momentum."""
    pairs = arrivals(OWN, COUNT, seed=7)
    found, times = durations(OWN, law, pairs)
    flown = host.fly(pairs, times / 50, 2_000)
    sticks = found["outcome"] == 0
    steady = np.arange(COUNT) % 20 != 10  # not with twist alone, whose balance rounding tips over
    assert np.count_nonzero(((flown["outcome"] == 0) != sticks)[steady]) <= 1
    sticks &= flown["outcome"] == 0
    assert np.abs(flown["apart"][sticks]).max() <= 0.5 * float(OWN.material["film_thickness"])
    assert flown["angular_momentum"].max() <= 1e-12


class Pair:
    """One pair of the host in Python, step by step."""

    def __init__(self, law: Law, position: object, velocity: object) -> None:
        self.law, self.material = law, law.material()
        self.motion, self.history, self.force = (
            np.zeros(1, law.dtype(f"pair_{each}")) for each in ("motion", "history", "force")
        )
        self.motion["position"], self.motion["velocity"] = position, velocity

    def call(self, dt: float) -> int:
        """Ask for the force of a step."""
        return self.law.contact_force(self.material, self.motion, dt, self.history, self.force)

    def step(self, dt: float, inertia: tuple[float, float]) -> None:
        """A step of the host; the loads act on the relative motion of equal spheres."""
        assert self.call(dt) == 0
        mass = float(self.material["reduced_mass"][0])
        push = self.force["force"] + 0.5 * (self.motion["forces"][:, 1] - self.motion["forces"][:, 0])
        self.motion["velocity"] += dt * push / mass
        for k in range(2):
            self.motion["spins"][:, k] += dt * self.force["torques"][:, k] / inertia[k]
        self.motion["position"] += dt * self.motion["velocity"]


def test_a_restart_from_bytes_gives_the_same_bits(law: Law):
    """The history is plain bytes: saved in the middle of a contact and read again, all later forces are the same."""
    distance, inertia = law.contact_distance(), (1e-12, 2e-12)
    pair = Pair(law, [1.001 * distance, 0, 0], [-0.4, 0.3, 0.1])
    other = Pair(law, 0.0, 0.0)
    assert pair.history.nbytes == 56  # as the page says
    for k in range(60):
        pair.step(2e-6, inertia)
        if k == 20:
            other.motion = np.frombuffer(pair.motion.tobytes(), pair.motion.dtype).copy()
            other.history = np.frombuffer(pair.history.tobytes(), pair.history.dtype).copy()
        if k > 20:
            other.step(2e-6, inertia)
            assert pair.force.tobytes() == other.force.tobytes()
    assert pair.history["time"][0] > 0.0


def capillary_work(gap: float) -> float:
    """Work against OWN's bridge from the film's thickness to a gap, J: Mikami's fit as printed, integrated by sums."""
    radius, volume = 2 * float(OWN.material["reduced_radius"]), 0.02  # of equal spheres with the same curvature
    slope, tail = -1.1 * volume**-0.53, 0.0042 * math.log(volume) + 0.078
    offset = -0.019 * math.log(volume) + 0.48
    at = (np.arange(2000) + 0.5) / 2000 * (gap - 8e-6) + 8e-6
    force = math.pi * radius * float(OWN.material["surface_tension"]) * (np.exp(slope * at / radius + offset) + tail)
    return float(force.mean() * (gap - 8e-6))


def test_a_bridge_adds_its_own_energy_alone(law: Law):
    """Kinetic energy and work against the bridge never exceed the first, at steps from a half of the contact time."""
    material, inertia = law.material(), Bodies.of(OWN).inertia
    mass = float(material["reduced_mass"][0])
    pairs = arrivals(OWN, 12, seed=8)
    _, times = durations(OWN, law, pairs)
    for normal, velocities, spins, time in zip(*pairs, times, strict=True):
        moving = velocities[1] - velocities[0]
        for steps in (2, 20):
            pair = Pair(law, law.contact_distance() * normal - 2.3 * time / steps * moving, moving)
            pair.motion["spins"][0] = spins
            first = 0.5 * (
                mass * moving @ moving + sum(i * spin @ spin for i, spin in zip(inertia, spins, strict=True))
            )
            for _ in range(3 * steps):
                pair.step(time / steps, inertia)
                turning = sum(i * spin @ spin for i, spin in zip(inertia, pair.motion["spins"][0], strict=True))
                energy = 0.5 * (mass * (pair.motion["velocity"][0] ** 2).sum() + turning)
                if pair.history["joined"][0] or pair.force["outcome"][0] >= 0:
                    energy += capillary_work(float(pair.force["gap"][0]))
                assert energy <= first * (1 + 1e-9)
                if pair.force["outcome"][0] >= 0:
                    break


def test_a_load_holds_against_a_bridge(law: Law):
    """A pair that is pulled apart by less than its bridge holds; by more, it separates, and says so once."""
    gap, events = 0.5 * float(OWN.material["film_thickness"]), law.number("SEPARATES")
    for pull, holds in ((0.2, True), (5.0, False)):
        radius = float(law.material()["reduced_radius"][0])
        force = pull * 2 * math.pi * radius * float(OWN.material["surface_tension"])
        pair = Pair(law, [law.contact_distance() - gap, 0, 0], 0.0)
        assert law.contact_join(pair.material, gap, 0.1, pair.history) == 0
        pair.motion["forces"][0, 1], pair.motion["forces"][0, 0] = [force, 0, 0], [-force, 0, 0]
        count = 0
        for _ in range(4000):
            pair.step(2e-6, (1e-12, 2e-12))
            count += int(pair.force["events"][0]) & events != 0
        assert (pair.history["joined"][0] == 1) == holds
        assert count == (not holds)


def test_bad_input_is_refused(law: Law):
    """Each by its name, with forces that are NaN and a history that stays as it was."""
    distance = law.contact_distance()

    def status(change: object = None, dt: float = 1e-6, **entries: float) -> str:
        pair = Pair(law, [distance, 0, 0], [-0.1, 0, 0])
        for name, value in entries.items():
            pair.material[name] = value
        if callable(change):
            change(pair)
        before = pair.history.tobytes()
        result = pair.call(dt)
        assert result != 0
        assert np.isnan(pair.force["force"]).all()
        assert np.isnan(pair.force["torques"]).all()
        assert pair.history.tobytes() == before
        return law.message(result)

    def put(array: str, value: float) -> object:
        row, name = array.split(".")
        return lambda pair: getattr(pair, row)[name].fill(value)

    for dt in (0.0, -1.0, math.nan, math.inf):
        assert "step" in status(dt=dt)
    assert "normal is zero" in status(put("motion.position", 0.0))
    assert "normal is zero" in status(put("motion.position", math.nan))
    for name in ("velocity", "spins", "forces", "torques"):
        for value in (math.nan, math.inf, 1e200):
            assert "not finite" in status(put(f"motion.{name}", value))
    for name, value in (("joined", 1), ("joined", -7)):
        assert "history" in status(put(f"history.{name}", value))
    assert "viscosity" in status(viscosity=-1.0)
    assert "film_thickness" in status(film_thickness=math.nan)
    pair = Pair(law, [distance, 0, 0], 0.0)
    assert "contact distance" in law.message(law.contact_join(pair.material, 1.0, 0.1, pair.history))
    assert "too small" in law.message(law.contact_join(pair.material, 1e-6, 0.0, pair.history))


def test_what_has_no_forces_says_so(walled: tuple[Path, Law]):
    """A wall: the header gives the reason."""
    header = (walled[0] / "granulation.h").read_text()
    assert "#define GRANULATION_FORCES 0" in header
    assert "two spheres" in header.replace("\n * ", " ")


def test_dry_contacts_rub(tmp_path: Path):
    """With friction at every rebound, outcomes, e_n and both spins are the law's; rubbing adds no energy."""
    scene = FILM_ALONE.with_entries(ROUGH | {"model.contact_friction": "all"})
    law = Law(scene, law_alone(scene, tmp_path), *QUICK.split())
    host, pairs = Host(scene, law, tmp_path), arrivals(scene, COUNT, seed=3)
    found, times = durations(scene, law, pairs)
    smooth = law.material()
    smooth["friction"] = 0.0
    flown, slid = (host.fly(pairs, times / 50, 400, each) for each in (law.material(), smooth))
    away = (found["outcome"] > 0) & (flown["outcome"] == found["outcome"])
    assert np.count_nonzero((flown["outcome"] != found["outcome"]) & (found["status"] == 0)) <= 1
    assert np.quantile(np.abs(flown["restitution"] - found["restitution"])[away], 0.97) <= 4e-3
    apart, effect = (
        np.linalg.norm(flown["spins"] - other, axis=(1, 2))[away] for other in (found["spins"], slid["spins"])
    )
    rubbed = effect > np.median(effect)
    assert np.median(apart[rubbed] / effect[rubbed]) <= 4e-2
    assert flown["angular_momentum"].max() <= 1e-13
    assert flown["energy"].max() <= 1 + 1e-12


def test_a_wall_is_a_far_larger_sphere(law: Law, walled: tuple[Path, Law]):
    """As the page says: 10,000 times as large and heavy, and held beneath the sphere; e_n is that of the wall."""
    wall, material = walled[1], law.material()
    normal, velocities, spins = arrivals(WALL, 15, seed=2)
    found = wall.collide_pairs(wall.pairs(normal, velocities, spins[:, :1]))
    for name in wall.material().dtype.names:
        material[name] = wall.material()[name]
    material["radius_ratio"] = material["mass_ratio"] = 1e4
    radius, mass, film = (float(material[name][0]) for name in ("reduced_radius", "reduced_mass", "film_thickness"))
    for k in np.flatnonzero(found["outcome"] > 0):
        n, (velocity, moving), spin = normal[k], velocities[k].copy(), spins[k, 0].copy()
        speed = n @ (velocity - moving)
        dt = max(found["time"][k], film / speed) / 20
        motion, history, force = (np.zeros(1, law.dtype(f"pair_{each}")) for each in ("motion", "history", "force"))
        gap = film + 2.3 * dt * speed
        for _ in range(200):
            motion["position"], motion["velocity"] = (radius * (2 + 1e4 + 1e-4) + gap) * n, moving - velocity
            motion["spins"][0, 0] = spin
            assert law.contact_force(material, motion, dt, history, force) == 0
            velocity -= dt / mass * force["force"][0]
            spin += dt / (0.4 * mass * radius**2) * force["torques"][0, 0]
            gap += dt * (moving - velocity) @ n
            if force["outcome"][0] >= 0:
                break
        assert force["outcome"][0] == found["outcome"][k]
        assert abs(force["restitution"][0] - found["restitution"][k]) <= 1e-3
        size = np.linalg.norm(velocities[k, 1] - velocities[k, 0])
        assert np.linalg.norm(velocity - found["velocities"][k, 0]) <= 1e-3 * size
        assert np.linalg.norm(spin - found["spins"][k, 0]) * radius <= 1e-3 * size
