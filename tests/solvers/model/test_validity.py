"""Where a collision leaves the model's range: each remark exactly where its number passes its limit."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_many

from ...helpers.command import run
from ...helpers.reference import collide

LIQUID = {"liquid.density": "1000 kg/m^3"}
WET = Scene.load("granulation").with_entries(LIQUID)
WORDS = {  # what the sentence of a flag says, after its number
    "film_reynolds": "Re = ",
    "film_gap": "x0/a = ",
    "rupture_gap": "x_f/a = ",
    "bridge_liquid": "the bridge holds ",
    "fly_by": "a fly-by",
    "wall_coupling": "the coupling that sets the final spin",
    "cavitating_film": "the film cavitating",
    "own_rupture": "own rupture distance",
    "idle_friction": "friction does nothing",
    "law_range": "outside the range of the law",
}


def bits(data):
    """Whether each flag is set, by its word."""
    said = data.validity.attrs
    masks = dict(zip(said["flag_meanings"].split(), said["flag_masks"], strict=True))
    return {word: (data.validity.values & mask) != 0 for word, mask in masks.items()}


@pytest.fixture(scope="module")
def random_collisions():
    """300 scenes around the limits, as columns."""
    rng = np.random.default_rng(14)
    count = 300

    def spread(low, high):
        return np.exp(rng.uniform(math.log(low), math.log(high), count))

    vary = {
        "liquid.film_thickness": spread(3e-6, 3e-5),
        "liquid.viscosity": spread(3e-4, 3e-1),
        "bridge.volume": spread(0.03, 2.0),
        "bridge.contact_angle": rng.uniform(0, 1.2, count),
    }
    scene = WET.with_entries({"bridge.law": "willett"})
    return collide_many(scene, speed=spread(0.01, 3), angle=rng.uniform(0.2, 1.55, count), vary=vary, of=["validity"])


def test_flags_are_set_where_a_number_passes_its_limit(random_collisions):
    """Re, x0/a, x_f/a, the bridge's share of the coatings and a law's range, from their definitions."""
    data = random_collisions
    radius, a = 100e-6, 50e-6
    film, volume, phi = data["liquid.film_thickness"], data["bridge.volume"], data["bridge.contact_angle"]
    coatings = 2 * 4 / 3 * math.pi * ((radius + film / 2) ** 3 - radius**3)
    expected = {
        "film_reynolds": 1000 * data.speed * film / data["liquid.viscosity"] > 1,
        "film_gap": film / a > 0.2,
        "rupture_gap": 2 * np.cbrt(volume) * (1 + phi / 2) > 1,
        "bridge_liquid": volume * radius**3 > coatings,
        "law_range": (volume > 0.1) | (np.degrees(phi) > 50),
    }
    found = bits(data)
    there = data.outcome.values >= 0
    for word, truth in expected.items():
        assert (found[word][there] == truth.values[there]).all(), word
        assert 0.05 < found[word][there].mean() < 0.95, word


def test_a_fly_by_hardly_bends_the_path(random_collisions):
    """A fly-by meets no criterion, would miss the solids, and leaves within 10 deg of its direction."""
    data = random_collisions
    reach, film = 200e-6, data["liquid.film_thickness"].values
    sliding = np.tan(data.angle.values) * (1 + film / reach)  # r omega at r = reach + film
    misses = (reach + film) * np.sin(np.arctan(sliding)) > reach
    turn = data.rotation.values
    before, final = 1j * sliding - 1, data.restitution.values + 1j * data.tangential_restitution.values * sliding
    cosine = np.cos(np.angle(final * np.exp(1j * turn) / before))
    expected = (data.outcome.values == 1) & misses & (cosine > math.cos(math.radians(10))) & (turn < math.pi)
    assert (bits(data)["fly_by"] == expected).all()
    assert expected.any()


def test_without_forces_the_path_is_straight():
    """Almost no liquid forces act: the path is bent by less than 1e-6 deg, which the sentence shows."""
    weak = {"liquid.viscosity": 1e-12, "bridge.surface_tension": 1e-12, "liquid.film_thickness": 2e-5}
    scene = Scene.load("granulation").with_entries(weak).with_impact(speed=0.5, angle=1.45)
    (sentence,) = [said for said in collide(scene, ledger=False).validity if "fly-by" in said]
    assert float(sentence.partition("is bent by ")[2].partition(" deg")[0]) < 1e-6


@pytest.mark.parametrize(("smallest", "published"), [(0.003, 1.66), (0.01, 1.95)])
def test_beside_a_wall_the_coupling_is_held_against_the_published_one(smallest, published):
    """The sentence has the factor: 1.7 at x/R = 0.003, 2 at 0.01 (Goldman, Cox & Brenner 1967)."""
    rigid = {"liquid.glass_transition_pressure": 1e20, "particles.youngs_modulus": 1e20}
    beside = {"partner.wall": True, "particles.roughness": smallest * 100e-6}
    wall = Scene.load("granulation-dry-bridge").with_entries(rigid | beside)
    one = collide(wall, stokes=20, angle="40 deg")
    assert one.smallest_gap == pytest.approx(smallest * 100e-6)
    (said,) = [each for each in one.validity if WORDS["wall_coupling"] in each]
    assert f"is {published:.3g} times" in said


def test_unequal_spheres_leave_the_forms_of_equal_ones():
    """What holds for equal spheres only is said of others, with the ratio of the radii, and not of equal ones."""
    entries = {"model.film": "cavitating", "bridge.rupture": "own"}
    equal, unequal = (
        collide(WET.with_entries({**entries, "partner.radius": radius, "partner.mass": mass}), ledger=False).validity
        for radius, mass in (("100 um", "1.04e-5 g"), ("150 um", "2e-5 g"))
    )
    for flag in ("cavitating_film", "own_rupture"):
        assert ["1.5 times" in said for said in unequal if WORDS[flag] in said] == [True]
        assert not any(WORDS[flag] in said for said in equal)


@pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
def test_sentences_and_flags_agree(random_collisions):
    """One collision's sentences are those of the flags that many have at the same place."""
    data, flags = random_collisions, bits(random_collisions)
    scene = WET.with_entries({"bridge.law": "willett"})
    for k in range(0, 300, 50):
        varied = {name: float(data[name][k]) for name in data.coords if "." in name}
        one = collide(scene.with_entries(varied), speed=float(data.speed[k]), angle=float(data.angle[k]), ledger=False)
        for flag, words in WORDS.items():
            assert any(words in said for said in one.validity) == bool(flags[flag][k]), (k, flag)


def test_the_presets_are_within_the_range():
    """Nothing is said of the paper's own collisions: an empty list, never null."""
    for name in ("granulation", "pendulum", "granulation-dry-bridge"):
        assert collide(name, ledger=False).to_dict()["validity"] == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "without", [("glass_transition",), ("youngs", "poisson"), ("glass_transition", "youngs", "poisson")]
)
def test_friction_that_cannot_act_whatever_criteria_a_scene_has(without):
    """Glass and elastic contact may be left out: many collisions are flagged, and single ones say it."""
    lines = WET.with_entries({"particles.friction": 0.3}).to_toml().splitlines()
    scene = Scene.from_toml("\n".join(line for line in lines if not line.startswith(without)))
    speeds = np.array([0.6, 1.0, 5.0])
    many = collide_many(scene, speed=speeds, angle=0.4, of=["validity"])
    alone = [collide(scene, speed=speed, angle=0.4, ledger=False) for speed in speeds]
    expected = [any(WORDS["idle_friction"] in said for said in one.validity) for one in alone]
    assert bits(many)["idle_friction"].tolist() == expected


def test_a_map_in_characters_counts_what_is_outside():
    """Under the map stands how many collisions passed which limit."""
    text = run("map", "granulation", "--stokes", "0.1:0.1:1", "--angle", "30:85:2").stdout
    assert "outside the model's range: solids that pass each other in 1" in text
