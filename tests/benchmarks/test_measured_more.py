"""The benchmark's further parts: gradients, exactness, the separatrix, first use, targets. No time is asserted."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide

from .measured import cold, gradient_work, near, sharp
from .measured.answers import Impact
from .measured.gradient_task import Gradients
from .measured.gradient_work import Method
from .measured.page import beside_heyoka, plots_more, targets
from .measured.peers.engines import HEYOKA, HEYOKA_ALONE, Answer


@pytest.fixture(scope="module")
def asked() -> Gradients:
    """Two collisions, three parameters."""
    names = ("liquid.viscosity", "bridge.contact_angle", "impact.speed")
    return Gradients(Scene.load("granulation"), (Impact(0.05, 1.3), Impact(0.3, 0.9)), names)


def test_gradients_by_differences_are_the_derivatives(asked: Gradients) -> None:
    """Two collisions a parameter agree with forward derivatives to the step's error, at the edge of a range as well."""
    (method,) = (each for each in gradient_work.methods() if "differences" in each.name)
    if method.missing:
        pytest.skip(method.missing)
    found = method.prepare(asked, 2, 1e-5)()
    assert found.shape == (4, 3)
    assert found[:2] == pytest.approx(found[2:], abs=0)
    assert asked.errors(found[:2]).max() < 1e-5


def test_gradient_record_is_complete(asked: Gradients) -> None:
    """Every method that is there at each of its tolerances; what is refused counts, what is missing is named."""

    def exactly(task: Gradients, copies: int, rtol: float) -> Any:
        return lambda: np.tile(task.truth * (1 + rtol), (copies, 1))

    def refused(task: Gradients, copies: int, _: float) -> Any:
        return lambda: np.full((copies * len(task.impacts), len(task.names)), np.nan)

    which = (
        Method("exact", exactly, 2, (1e-6, 1e-9)),
        Method("refused", refused, 1, (1e-6,)),
        Method("gone", exactly, missing="gone is not installed"),
    )
    row = gradient_work._of(asked, "granulation", 1, lambda _: None, which)
    assert [(each["method"], each["rtol"]) for each in row["rows"]] == [
        ("exact", 1e-6),
        ("exact", 1e-9),
        ("refused", 1e-6),
    ]
    assert [each["error_largest"] for each in row["rows"][:2]] == pytest.approx([1e-6, 1e-9], rel=1e-3)
    assert row["rows"][2]["error_largest"] is None
    assert row["rows"][2]["failed"] == 2
    text = gradient_work.gradient_work_text([row])
    assert "gone is not installed" in text
    assert any(line.split() == ["|", "refused", *["|", "-"] * 4, "|"] for line in text.splitlines())
    figure = plots_more.gradient_curves({"gradient_work": [row]})
    assert [each.get_text() for each in figure.legends[0].get_texts()] == ["exact", "refused"]


def test_the_kernel_is_as_exact_as_its_conditioning_allows() -> None:
    """At rtol 1e-13, e_n differs from 80-bit numbers by less than 1e-13 of it, far from every boundary, on strings."""
    pytest.importorskip("heyoka")
    scene = Scene.load("pendulum")
    task = Gradients(scene, (Impact(2.5, 0.5),), ("impact.speed",))
    (exact,) = sharp.long_double(scene, task.numbers, 1e-18)
    ours = collide(scene, stokes=2.5, angle=0.5, rtol=1e-13, engine="taylor", ledger=False)
    assert ours.engine == "taylor"
    assert abs(ours.restitution / exact - 1) < 1e-13


def test_the_separatrix_is_the_traced_one() -> None:
    """The Stokes numbers that points are set beside agree with the traced boundary."""
    from wetdoublet.solvers import boundary

    degrees = 70.0
    traced = boundary("granulation", angle=np.radians(degrees), stokes=(0.01, 0.03)).changes[0][0]
    assert traced.before == "stick"
    assert near.SEPARATRIX[degrees] == pytest.approx(traced.stokes, rel=1e-8)
    sides = near.beside(1e-3)
    assert len(sides) == 2 * len(near.SEPARATRIX)
    assert sum(each.sticks for each in sides) == len(near.SEPARATRIX)


def test_failures_beside_the_separatrix_are_told() -> None:
    """A wrong outcome counts where the tolerance resolves the side, a failure everywhere; both are in the table."""
    rows = []
    for rtol, distance in ((1e-9, 1e-4), (1e-9, 1e-10)):
        sides = near.beside(distance)
        wrong = [Answer("bounce", 0.5)] * len(sides)
        rows.append(near._row("taylor", rtol, distance, sides, 1e-5, ["gave up", *wrong[1:]]))
        rows.append(near._row(near.GENERATED, rtol, distance, sides, 1e-3, wrong))
    text = near.near_text(rows)
    assert "1 failed, 3 wrong" in text
    assert text.count("wrong)") == 2
    assert "takes 1e+02 to 1e+02 times as long as taylor; taylor fails 2 times" in text
    figure = plots_more.near_curves({"near": rows})
    assert len(figure.axes) == 1


def test_first_use_is_of_whole_processes() -> None:
    """The first finds an empty cache, the second what that left in the same place."""
    seen: list[tuple[str, str]] = []

    def process(arguments: list[str], environment: Any) -> float:
        seen.append((arguments[1], environment["WETDOUBLET_CACHE"]))
        return float(len(seen))

    rows = cold.first_use(1, process)
    assert [row["preset"] for row in rows] == ["granulation", "pendulum"]
    assert len({folder for _, folder in seen}) == 2
    assert seen[0] == seen[1]
    assert "collide_many" in seen[0][0]
    assert "collide_many(" not in seen[2][0]
    assert "1.000 (-2.000)" in cold.first_table(rows)


def test_targets_are_judged_at_equal_error() -> None:
    """The ratio is of the cheapest settings within the bound that get all outcomes right."""

    def point(engine: str, cpu: float, error: float, wrong: int = 0) -> dict[str, Any]:
        return {"engine": engine, "summary": {"cpu_mean": cpu, "error_largest": error, "wrong": wrong, "failed": 0}}

    points = [
        point("taylor", 1e-6, 2e-8), point("taylor", 2e-6, 5e-9), point("taylor", 3e-6, 1e-9),
        point(HEYOKA_ALONE, 9e-6, 1e-9, wrong=1), point(HEYOKA_ALONE, 18e-6, 1e-9), point(HEYOKA, 24e-6, 1e-9),
        point("taylor, kernel alone", 1e-6, 5e-9), point("by hand, order 9", 1.5e-6, 4e-9),
    ]  # fmt: skip
    record: dict[str, Any] = {"tasks": [{"preset": "granulation", "points": points}], "cold_start": {}}
    record |= {name: [] for name in ("gradient_work", "sharp", "near", "growth", "first_use")}
    (ratio, outcomes) = targets.targets(record)
    assert ratio[2:] == ("9.0 times faster (2 us beside 18 us)", True)
    assert outcomes[2:] == ("none", True)
    assert "**no**" not in targets.target_table(record)
    assert "heyoka without its callbacks" in targets.headline(record)
    row = [cell.strip() for cell in beside_heyoka.three_ways(record).splitlines()[-1].split("|")]
    assert row[2:7] == ["24 (1e-09)", "18 (1e-09)", "2 (5e-09)", "1 (5e-09)", "1.5 (4e-09)"]
    assert row[7:9] == ["12.0", "9.0"]
