"""What is drawn: data within the axes, no line over a jump, legends and labels of what is there, whole titles."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from wetdoublet.solvers import Scene, atlas, band, boundary, collide, plot, regime_map, sensitivities

NAME = "a-very-long-name-of-a-scene-that-somebody-has-given-to-say-all-about-it-and-its-liquid"
LONG = Scene.load("granulation").with_entries({"name": NAME})
WALL = Scene.load("lactose-pvp").with_entries({"partner.wall": True, "partner.coating_thickness": "1 um", "name": NAME})
FAST = np.geomspace(0.05, 50, 16)
STEEP = np.radians(np.linspace(0, 89, 40))
COLLISIONS = {
    "turns away": ("granulation", {}), "steep": ("granulation", {"stokes": 0.05, "angle": "85 deg"}),
    "rough": ("glass-beads-water", {}), "glass at touch": ("granulation", {"stokes": 0.3, "angle": 0.0}),
    "slow afterwards": ("pendulum", {}), "beside a wall": (WALL, {"speed": "10 m/s", "angle": "60 deg"}),
}  # fmt: skip

QUICK = ("steep", "glass at touch")


@pytest.mark.parametrize(
    "name", [each if each in QUICK else pytest.param(each, marks=pytest.mark.slow) for each in COLLISIONS]
)
def test_the_axes_of_a_collision_hold_its_curves(name: str) -> None:
    """Each curve, as far as its time is shown, lies within its axes; the velocity begins with that of the approach."""
    scene, impact = COLLISIONS[name]
    found = collide(scene, **impact, trajectory=True)
    figure = found.plot()
    for axes in figure.axes[:-1]:  # the last one has the doublet
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        for line in axes.lines:
            if line.get_transform() == axes.transData:
                x, y = np.transpose(line.get_xydata())
                y = y[(x >= left) & (x <= right)]
                assert low <= y.min() and y.max() <= high
    velocities = [axes for axes in figure.axes if "normal" in axes.get_ylabel()]
    drawn, last = velocities[0].lines[0].get_ydata(), found.trajectory["normal_velocity"][-1]
    assert drawn[0] < 0
    assert drawn[0] / drawn[-1] == pytest.approx(-found.speed / float(last), rel=1e-6)


def joined(axes: Axes) -> list[tuple[float, float]]:
    """Ends in x of everything that is joined in an axes: segments of lines, and filled areas."""
    spans = []
    for line in axes.lines:
        points = np.asarray(line.get_xydata(), float)
        if line.get_transform() == axes.transData and line.get_linestyle() != "None":
            spans += [(a[0], b[0]) for a, b in pairwise(points) if np.isfinite([*a, *b]).all()]
    for collection in axes.collections:
        for path in collection.get_paths():
            x = path.vertices[:, 0]
            spans += [(x.min(), x.max())]
    return spans


def over(spans: list[tuple[float, float]], x: np.ndarray, outcome: np.ndarray) -> list[tuple[float, float]]:
    """Those of the spans that hold points of different outcome."""
    shared = [(low, high, outcome[(x >= low) & (x <= high)]) for low, high in spans]
    return [(low, high) for low, high, inside in shared if np.unique(inside).size > 1]


def test_a_band_does_not_join_outcomes() -> None:
    """At 58 to 60 degrees the granulation changes from a stick to an escape: no line or area is over the change."""
    angle = np.radians(np.linspace(40, 80, 21))
    data = band("granulation", {"liquid.viscosity": "5 %"}, "impact.angle", angle)
    assert np.unique(data.outcome).size == 2
    spans = joined(plot(data).axes[0])
    assert len(spans) > 30
    assert over(spans, np.degrees(angle), data.outcome.values) == []


def legends(figure: Figure) -> list[Legend]:
    return [*figure.legends, *filter(None, (axes.get_legend() for axes in figure.axes))]


@pytest.mark.parametrize("scene", ["granulation", WALL])
def test_a_legend_of_a_map_has_what_occurs(scene: Scene | str) -> None:
    """Beside a wall nothing escapes by rotation, so that the legend has no colour of it."""
    data = regime_map(scene, relative_speed=FAST, angle=STEEP)
    [legend] = legends(plot(data))
    names = [text.get_text().partition(": ")[2] for text in legend.get_texts()]
    words = np.array(["stick", "stick-rotate-separate", "bounce"])
    assert [name for name in names if name] == words[np.unique(data.outcome)].tolist()


TITLED: dict[str, Callable[[], Figure]] = {
    "collision": lambda: collide(LONG, trajectory=True).plot(),
    "map": lambda: plot(regime_map(WALL, relative_speed=FAST, angle=STEEP)),
    "lines": lambda: boundary(LONG, angle="60 deg", stokes=(0.01, 0.3)).plot(),
    "atlas": lambda: atlas(WALL, span=("0 deg", "85 deg"), stokes=(1, 30)).plot(),
    "tornado": lambda: sensitivities(LONG, of=["restitution"]).plot(),
}


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=pytest.mark.slow) if each == "atlas" else each for each in TITLED]
)
def test_a_title_is_whole(name: str, tmp_path: Path) -> None:
    """A long name of a scene stands in the title as it is, on as many lines as the width takes."""
    figure = TITLED[name]()
    figure.savefig(tmp_path / "figure.png")
    title = figure._suptitle
    assert title is not None
    assert NAME in "".join(title.get_text().split())
    box = title.get_window_extent()
    assert box.x0 >= 0 and box.x1 <= figure.bbox.width and box.y1 <= figure.bbox.height
