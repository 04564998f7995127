"""Boxes of every entry of every structure: proofs at their ends and collisions inside do not contradict them."""

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, collide, prove
from wetdoublet.solvers.engines.interval.call import BOX, enclose
from wetdoublet.solvers.engines.interval.inputs import Inputs
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.held import impact_quantity
from wetdoublet.solvers.scene.schema import FIELDS

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")

PAIR = {"partner.diameter": "400 um", "partner.mass": "8e-5 g", "impact.spin": 300.0, "impact.partner_spin": -100.0}
OTHER = {"partner.diameter": "0.8 mm", "partner.density": "2000 kg/m3", "partner.coating_thickness": "1 um"}
WALL = {"partner.wall": True}
STRUCTURES: dict[str, tuple[str, dict[str, object]]] = {
    "reduced quantities": ("granulation", {}),
    "no bridge": ("granulation-dry-bridge", {}),
    "lactose": ("lactose-pvp", {}),
    "pellets": ("pellet-coating", {}),
    "volume in m^3": ("granulation", {"bridge.volume": "1e-13 m^3"}),
    "from coating": ("glass-beads-water", {}),
    "part of a coating": ("glass-beads-water", {"bridge.coating_fraction": 0.1}),
    "own rupture": (
        "granulation",
        {"bridge.law": "willett", "bridge.rupture": "own", "bridge.volume": 0.05, "bridge.contact_angle": "5 deg"},
    ),
    "attraction": ("granulation", {"attraction.hamaker": "1e-19 J"}),
    "pair": ("granulation", PAIR),
    "pair, volume in m^3": ("granulation", {**PAIR, "bridge.volume": "3e-13 m^3"}),
    "pair of coated spheres": ("glass-beads-water", {**OTHER, "bridge.volume": 0.05}),
    "pair, from coating": ("glass-beads-water", OTHER),
    "wall": ("granulation", WALL),
    "wall, volume in m^3": ("granulation", {**WALL, "bridge.volume": "1e-13 m^3"}),
    "coated wall": ("glass-beads-water", {**WALL, "partner.coating_thickness": "1 um"}),
}
"""A preset and changes of it, which together have every entry that a proof may be about, given in every way."""


def scene_of(structure: str, random: np.random.Generator) -> Scene:
    """A scene of this structure with an impact at random, its speed given in one of three ways."""
    preset, changes = STRUCTURES[structure]
    scene = Scene.load(preset).with_entries(changes)
    angle, stokes = float(random.uniform(0.05, 1.45)), float(np.exp(random.uniform(-3.5, 1.5)))
    if preset in ("lactose-pvp", "glass-beads-water"):
        stokes *= 20
    scene = scene.with_impact(stokes=stokes, angle=angle)
    assert scene.speed is not None
    way = random.integers(3)
    if way == 1:
        scene = scene.with_impact(speed=scene.speed)
    elif way == 2:
        scene = scene.with_impact(relative_speed=scene.speed / np.cos(angle))
    return scene


def boxed(scene: Scene) -> list[str]:
    """The entries of a scene that are numbers."""
    return [name for name, value in scene.entries.items() if not isinstance(value, str)]


def inside(scene: Scene, at: dict[str, float]) -> Scene:
    """The scene with these numbers; the number that says its speed stays."""
    return scene.with_si(at, hold=impact_quantity(scene))


@pytest.mark.parametrize("structure", STRUCTURES)
def test_quantities_at_the_ends_of_an_entry_lie_in_its_box(structure: str) -> None:
    """Of every entry, by a relative width and by both ends as text: all quantities of scenes with it at its ends, and
    between; or it is refused by name. An entry that the scene does not have is refused.
    """
    random, accepted = np.random.default_rng(1), 0
    scene = scene_of(structure, random)
    for name in FIELDS:
        width = float(10 ** random.uniform(-5, -0.7))
        if name not in boxed(scene):
            given = ("1 %", "2 %") if name in scene.entries else width
            with pytest.raises(InputError, match=name):
                prove(scene, within={name: given})
            continue
        try:
            inputs = Inputs.of(scene, {name: width})
        except InputError as error:
            assert name in str(error) or "radii" in str(error)
            continue
        accepted += 1
        low, high = inputs.box[name]
        assert low <= scene.entries[name] * (1 - width) < scene.entries[name] * (1 + width) <= high or low < 0
        for part in (0.0, 0.3, 1.0):
            at = inside(scene, {name: low + part * (high - low)})
            for quantity, (value, _) in Inputs.of(at).ranges.items():
                least, most = inputs.ranges[quantity]
                assert least <= value <= most, (name, quantity)
    assert accepted > 8


@pytest.mark.parametrize("structure", ["volume in m^3", "from coating", pytest.param("pair", marks=pytest.mark.slow)])
def test_proofs_at_the_ends_of_an_entry_agree_with_its_box(structure: str) -> None:
    """Of every entry: scenes with it at either end, and collisions there, have outcome and restitution of the box."""
    scene, proved = scene_of(structure, np.random.default_rng(2)), 0
    for name in boxed(scene):
        try:
            proof = prove(scene, within={name: 1e-4})
        except InputError:
            continue
        for there in (inside(scene, {name: end}) for end in proof.box[name]):
            point = prove(there)
            if proof and point:
                proved += 1
                collided = collide(there, rtol=1e-11, ledger=False)
                assert point.outcome == proof.outcome == collided.outcome
                assert proof.restitution[0] <= point.restitution[1]
                assert point.restitution[0] <= proof.restitution[1]
                assert proof.restitution[0] - 1e-7 <= collided.restitution <= proof.restitution[1] + 1e-7
    assert proved > 15


def test_a_volume_in_cubic_metres_is_boxed_in_cubic_metres() -> None:
    """Large beads with little water stick; read as V/R^3 the same numbers are nearly no bridge, and they bounce."""
    entries = {"particles.diameter": "4 mm", "particles.roughness": "0.1 um", "liquid.coating_thickness": "0.3 um"}
    scene = Scene.load("glass-beads-water").with_entries({**entries, "bridge.volume": "1e-10 m^3"})
    scene = scene.with_impact(speed="0.05 m/s", angle="11.4 deg")
    assert collide(scene, ledger=False).outcome == "stick"
    proof = prove(scene, within={"bridge.volume": ("0.95e-10 m^3", "1.05e-10 m^3")})
    assert proof.outcome == "stick"
    assert proof.ranges["volume"] == pytest.approx((0.95e-10 / 0.002**3, 1.05e-10 / 0.002**3), rel=1e-12)
    with pytest.raises(InputError, match="where the scene gives a volume"):
        prove(scene, within={"bridge.volume": (0.01, 0.02)})


RUPTURING = {"bridge.volume": (0.08, 0.12), "bridge.contact_angle": ("0 deg", "30 deg")}
RUPTURING |= {"liquid.film_thickness": ("7.8 um", "8.2 um"), "particles.reduced_radius": ("49 um", "51 um")}
"""Entries that move the rupture gap of granulation."""


@pytest.mark.parametrize("entry", RUPTURING)
def test_restitutions_of_a_range_of_rupture_gaps_are_enclosed(entry: str) -> None:
    """What moves the rupture gap: pairs separate within many panels of the bounds over the gap."""
    scene = Scene.load("granulation").with_impact(stokes=2.8, angle="83 deg")
    inputs = Inputs.of(scene, {entry: RUPTURING[entry]})
    found = enclose(inputs.engine(), inputs.ranges, inputs.moving, BOX)
    assert found.outcome == 3
    for value in np.linspace(*inputs.box[entry], 9).tolist():
        end = collide(inside(scene, {entry: value}), rtol=1e-11, ledger=False).restitution
        assert found.restitution[0] - 1e-7 <= end <= found.restitution[1] + 1e-7


def test_what_a_box_holds_is_said():
    """The Stokes number or the speed, as the scene gives it, unless the box has a range of it."""
    within = {"liquid.viscosity": ("1.9 Pa s", "2.1 Pa s")}
    stokes = prove("granulation", stokes=0.3, angle="20 deg", within=within)
    speed = prove("granulation", speed="6 m/s", angle="20 deg", within=within)
    assert (stokes.to_dict()["held"], speed.to_dict()["held"]) == ({"impact.stokes": 0.3}, {"impact.speed": 6.0})
    assert "\nat St 0.3: the speed varies with the box" in str(stokes)
    assert "\nat a normal speed of 6 m/s" in str(speed)
    assert stokes.ranges["stokes"] == (0.3, 0.3) and "stokes" not in speed.ranges
    assert prove("granulation", stokes=0.3, within=1e-4).held == {}
    assert "\nat " not in str(prove("granulation", stokes=0.3))
