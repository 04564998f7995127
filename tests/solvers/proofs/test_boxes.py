"""Boxes of every entry of every structure: proofs at their ends and collisions inside do not contradict them."""

import itertools
import json
from collections import Counter

import numpy as np
import pytest
from wetdoublet.solvers import ComputationError, InputError, Scene, collide, prove
from wetdoublet.solvers.engines.interval.call import BOX, enclose
from wetdoublet.solvers.engines.interval.inputs import Inputs
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.held import impact_quantity
from wetdoublet.solvers.scene.schema import FIELDS

from ...helpers.command import run

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
    """Of every entry: scenes with it at either end have the outcome of the box, and a restitution of its range."""
    scene, proved = scene_of(structure, np.random.default_rng(2)), 0
    for name in boxed(scene):
        try:
            proof = prove(scene, within={name: 1e-4})
        except InputError:
            continue
        for point in (prove(inside(scene, {name: end})) for end in proof.box[name]):
            if proof and point:
                proved += 1
                assert point.outcome == proof.outcome
                assert proof.restitution[0] <= point.restitution[1]
                assert point.restitution[0] <= proof.restitution[1]
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


def contradictions(
    count: int, seed: int, structures: list[str], more: int = 2, narrowest: float = 1e-5
) -> Counter[str]:
    """Numbers of boxes that are proved, refused, not proved, and contradicted by one of 25 collisions inside.

    Each is of the structure's next entry, and of up to `more` others; its relative width is up to 0.2.
    """
    random, counts = np.random.default_rng(seed), Counter[str]()
    for k in range(count):
        scene = scene_of(structures[k % len(structures)], random)
        names = boxed(scene)
        chosen = [names[k // len(structures) % len(names)]]
        chosen += set(random.choice(names, random.integers(more + 1)).tolist()) - {*chosen}
        width = float(np.exp(random.uniform(np.log(narrowest), np.log(0.2))))
        try:
            proof = prove(scene, within=dict.fromkeys(chosen, width))
        except InputError:
            counts["refused"] += 1
            continue
        if not proof:
            counts["not proved"] += 1
            continue
        counts["proved"] += 1
        assert proof.restitution is not None
        low, high = proof.restitution
        points = [dict(zip(chosen, corner, strict=True)) for corner in itertools.product(*proof.box.values())]
        while len(points) < 25:
            points.append({name: float(random.uniform(*proof.box[name])) for name in chosen})
        for at in points:
            try:
                found = collide(inside(scene, at), rtol=1e-11, ledger=False)
            except ComputationError:
                counts["undecided"] += 1
                continue
            slack = 1e-7 * (1 + high)
            if found.outcome != proof.outcome or not low - slack <= found.restitution <= high + slack:
                counts["contradicted"] += 1
                break
    return counts


@pytest.mark.slow
def test_collisions_inside_of_boxes_agree() -> None:
    """Wide boxes of every entry of granulation: outcome and restitution of 25 collisions in each, ends among them.

    Of boxes of other structures `tests/harness` has it.
    """
    counts = contradictions(45, 4, ["reduced quantities"], more=0, narrowest=0.03)
    assert counts["contradicted"] == 0
    assert counts["proved"] > 20


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


def test_a_box_on_the_command_line() -> None:
    """A percentage is that part of the value; what is no width of a box is refused by the entry's name."""
    proved = [run("prove", "granulation", "--stokes", "0.01", "--json", "--within", f"liquid.viscosity={width}")
              for width in ("5 %", "0.05", "1.9:2.1 Pa s")]  # fmt: skip
    boxes = [json.loads(done.stdout)["inputs"]["viscosity"] for done in proved]
    assert boxes == [pytest.approx([1.9, 2.1])] * 3
    refused = run("prove", "granulation", "--within", "liquid.viscosity=2 Pa s +- 5 %")
    assert refused.exit_code == 2
    assert refused.stderr.startswith('--within liquid.viscosity: "2 Pa s +- 5 %" is no number')
