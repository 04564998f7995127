"""Maps and boundaries of proved outcomes, against collisions."""

import ctypes
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import Scene, collide, collide_many, prove, prove_boundary, prove_map
from wetdoublet.solvers.boundaries import proved_boundary
from wetdoublet.solvers.engines.interval.build import FLAGS, Engine, engine, source
from wetdoublet.solvers.engines.interval.call import BOX, enclose
from wetdoublet.solvers.engines.interval.inputs import Inputs
from wetdoublet.solvers.engines.machine import own_sets
from wetdoublet.solvers.host.compiler import compiler, library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.model.model import select_model

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.usefixtures("released")]
OUTCOMES = ("stick", "stick-rotate-separate", "bounce")


def test_cells_cover_the_rectangle_and_hold_for_their_points(tmp_path: Path) -> None:
    """The cells add up to the rectangle, and a collision anywhere in a proved cell has its outcome.

    As a Dataset they have the word of their code and their ends; what is undecided is an attribute.
    """
    found = prove_map("granulation", stokes=[0.1, 0.11, 0.12], angle=np.radians([20, 20.5]), depth=7)
    whole = math.log(1.2) * math.radians(0.5)
    assert math.isclose(sum(cell.area for cell in found.cells), whole, rel_tol=1e-9)
    assert math.isclose(sum(found.shares.values()), 1.0, rel_tol=1e-12)
    assert 0 < found.shares["undecided"] < 0.2
    random = np.random.default_rng(1)
    for cell in (found.cells[k] for k in random.integers(0, len(found.cells), 20)):
        if cell.outcome >= 0:
            stokes, angle = random.uniform(*cell.speed), random.uniform(*cell.angle)
            assert collide("granulation", stokes=stokes, angle=angle, ledger=False).outcome == OUTCOMES[cell.outcome]
    found.to_dataset().to_netcdf(tmp_path / "cells.nc")
    data = xr.load_dataset(tmp_path / "cells.nc")
    area = (np.diff(np.log(data.stokes), axis=1) * np.diff(data.angle, axis=1)).ravel()
    assert area.sum() == pytest.approx(whole)
    assert data.undecided_area == pytest.approx(area[data.outcome.values == -1].sum() / area.sum())
    assert found.to_dict()["undecided_area"] == data.undecided_area == pytest.approx(found.shares["undecided"])


def test_cells_of_speeds_hold_for_their_points() -> None:
    """As those of Stokes numbers do; the same impacts as a map of Stokes numbers has are proved."""
    scene, angle = Scene.load("granulation"), np.radians([20, 20.5])
    edges = [scene.speed_of(stokes) / math.cos(angle[0]) for stokes in (0.1, 0.13)]
    found = prove_map(scene, relative_speed=edges, angle=angle, depth=7)
    assert (found.cells[0].speed[0], max(cell.speed[1] for cell in found.cells)) == tuple(edges)
    assert {"stick", "bounce"} <= {name for name, share in found.shares.items() if share > 0.2}
    random = np.random.default_rng(2)
    for cell in (found.cells[k] for k in random.integers(0, len(found.cells), 40)):
        impact = {"relative_speed": random.uniform(*cell.speed), "angle": random.uniform(*cell.angle)}
        if cell.outcome >= 0:
            assert collide(scene, **impact, ledger=False).outcome == OUTCOMES[cell.outcome]
    assert found.to_dataset().relative_speed.units == "m/s"
    assert "were halved 7 times; a larger depth leaves less undecided" in str(found)


def test_a_box_of_angles_is_printed_in_degrees() -> None:
    """With singular and plural."""
    text = str(prove("granulation", stokes=0.3, angle="20 deg", within={"impact.angle": ("19.9 deg", "20.1 deg")}))
    assert "\nfor every impact.angle between 19.9 and 20.1 deg\n" in text
    assert "\n1 rebound, " in text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("angle", "stokes", "outcomes", "width", "halvings"),
    [
        ("10 deg", (0.113, 0.119), ("stick", "bounce"), 1e-12, 60),
        ("45 deg", (0.0487, 0.0495), ("stick", "stick-rotate-separate"), 1e-8, 20),  # each of the last takes a second
    ],
    ids=["bounce", "saddle"],
)
def test_a_change_lies_between_proved_outcomes(
    angle: str, stokes: tuple[float, float], outcomes: tuple[str, str], width: float, halvings: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """Two proved Stokes numbers lie near each other, and the kernel agrees a little outside of them."""
    monkeypatch.setattr(proved_boundary, "_MOST", halvings)
    (change,) = prove_boundary("granulation", angle=angle, stokes=stokes).changes
    assert change.outcomes == outcomes
    assert change.width < width
    below, above = (collide("granulation", stokes=change.stokes[0] * f, angle=angle) for f in (1 - 1e-7, 1 + 1e-7))
    assert (below.outcome, above.outcome) == outcomes


def test_a_part_of_a_box_may_rebound_at_initial_contact() -> None:
    """Where the glass criterion is met at initial contact by a part of a box, all of it bounces nevertheless."""
    below, above = (collide("granulation", stokes=stokes, angle=0.5) for stokes in (0.2344, 0.2364))
    assert below.events[0].time > 0.0
    assert above.events[0].time == 0.0
    proof = prove("granulation", stokes=0.2354, angle=0.5, within=6e-3)
    assert proof.outcome == "bounce"
    low, high = proof.restitution
    assert low < below.restitution < high
    assert low < above.restitution < high


@pytest.mark.slow
def test_cells_from_head_on_impacts_on_hold_both() -> None:
    """From 0 deg on: sticks and bounces on either side of the film's limit, head-on and at up to 2 deg."""
    scene = Scene.load("granulation")
    for stokes, outcome in ((0.05, "stick"), (0.3, "bounce")):
        edges = [stokes, 1.01 * stokes]
        found = prove_map(scene, stokes=edges, angle=np.radians([0, 2]), depth=4)
        assert found.shares[outcome] == 1.0
        computed = collide_many(scene, stokes=edges, angle=np.radians([[0.0], [1e-6], [2]]))
        assert {OUTCOMES[code] for code in computed.outcome.values.ravel().tolist()} == {outcome}
    dry = prove_map("granulation-dry-bridge", stokes=[0.05, 0.051], angle=np.radians([0, 2]), depth=2)
    assert dry.shares["stick"] == 0.0  # head-on the film alone decides, and at any angle the pair separates
    box = prove(scene, stokes=0.3, angle=0.1, within={"impact.angle": ("0 deg", "2 deg")})
    ends = [collide(scene, stokes=0.3, angle=angle, ledger=False).restitution for angle in (0.0, math.radians(2))]
    assert box.restitution[0] <= min(ends) < max(ends) <= box.restitution[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "about", "entry"),
    [
        ("granulation", 0.3, "impact.angle"),
        ("granulation", 0.3, "liquid.viscosity"),
        ("lactose-pvp", 10, "impact.stokes"),
    ],
)
def test_a_narrow_box_has_the_restitutions_of_its_ends(name: str, about: float, entry: str) -> None:
    """Followed step by step through all events: the ends lie within, and the range is little wider.

    A box of viscosities keeps the Stokes number.
    """
    random, tried, near = np.random.default_rng(3), 0, 2e-6
    for _ in range(8):
        scene = Scene.load(name).with_impact(stokes=about * 3 ** random.uniform(-1, 1), angle=random.uniform(0.1, 1.4))
        inputs = Inputs.of(scene, {entry: near})
        settings = BOX._replace(funnels=0, steps=5000, tolerance=1e-13)
        found = enclose(inputs.engine(), inputs.ranges, inputs.moving, settings)
        (quantity,) = inputs.moving
        same = {"impact.stokes": scene.entries["impact.stokes"]}
        at = [scene.with_entries(same | {entry: scene.entries[entry] * f}) for f in (1 - near, 1 + near)]
        ends = sorted(collide(each, rtol=1e-12, ledger=False).restitution for each in at)
        low, high = found.restitution
        if found.outcome < 2 or ends[1] - ends[0] < 1e-9:
            continue
        tried += 1
        assert low - 1e-11 <= ends[0] < ends[1] <= high + 1e-11, quantity
        assert high - low < 1.1 * (ends[1] - ends[0]) + 1e-9
    assert tried > 2


NEAR = Scene.load("lactose-pvp").with_impact(stokes=7.3, angle="57 deg")
"""Pairs that rebound, open beyond the film, turn and fall back; from St 7.331 on they bounce."""


def boxes(count: int, farthest: float) -> list[dict[str, tuple[float, float]]]:
    """Boxes of random widths at random distances from the change of outcome, on both sides of it."""
    random, angle = np.random.default_rng(count), math.radians(57)
    found = []
    for _ in range(count):
        away, width = farthest * random.uniform(-1, 1), 10 ** random.uniform(-4, -2)
        stokes = 7.331 * (1 + away)
        found.append({
            "stokes": (stokes * (1 - width / 2), stokes * (1 + width / 2)),
            "angle": (angle - width / 4, angle + width / 4),
        })  # fmt: skip
    return found


def wrong(tried: Engine, farthest: float, inputs: Inputs) -> tuple[int, int]:
    """Numbers of boxes that are proved, and of those in which a collision, also at a corner, has another outcome."""
    proved, contradicted, random = 0, 0, np.random.default_rng(7)
    for box in boxes(40, farthest):
        found = enclose(tried, {**inputs.ranges, **box}, inputs.moving, BOX)
        stokes = [*box["stokes"], *random.uniform(*box["stokes"], 3)]
        angles = [*box["angle"], *random.uniform(*box["angle"], 3)]
        if found.outcome:
            proved += 1
            outcome = collide_many(
                NEAR, stokes=np.array(stokes)[:, None], angle=np.array(angles), of=("outcome",)
            ).outcome
            contradicted += bool((outcome != found.outcome - 1).any())
    return proved, contradicted


@pytest.mark.slow
def test_boxes_of_pairs_that_fall_back_are_proved() -> None:
    """Within 3 % of the change of outcome most boxes of up to 1 % are proved, and collisions in them agree."""
    inputs = Inputs.of(NEAR, {"impact.stokes": 1e-6, "impact.angle": 1e-6})
    proved, contradicted = wrong(inputs.engine(), 0.03, inputs)
    assert proved > 25
    assert contradicted == 0


@pytest.mark.slow
def test_a_barrier_that_is_wrong_is_contradicted() -> None:
    """Collisions near the change of outcome contradict one that holds twice the work of the bridge."""
    inputs = Inputs.of(NEAR, {"impact.stokes": 1e-6, "impact.angle": 1e-6})
    key = select_model(NEAR, True, fold=True)
    text, known = source(key, False, 2), engine(key, False, 2)
    right = "return iv_sub(energy, work(b, x[GAP], gap));"
    assert text.count(right) == 1
    doubled = text.replace(right, "return iv_sub(energy, iv_mul(iv_point(2.0), work(b, x[GAP], gap)));")
    mutant = loaded(library(doubled, (*own_sets()[0].flags, *FLAGS)), ctypes.CDLL)
    assert mutant.interval_start()
    mutant.interval_prove.argtypes, mutant.interval_prove.restype = [ctypes.c_void_p] * 5, None
    assert wrong(Engine(mutant, known.quantities, known.room), 0.005, inputs)[1] > 0
