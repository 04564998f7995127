"""The picture of a regime map, by its artists."""

import numpy as np
import pytest
from wetdoublet.solvers import boundary, regime_map
from wetdoublet.solvers.boundaries.on_map import map_curves
from wetdoublet.solvers.many.plot_map import draw_map


@pytest.fixture(scope="module")
def chart():
    """A map of granulation with all outcomes, from head-on to a fly-by."""
    return regime_map("granulation", stokes=np.geomspace(0.01, 0.5, 30), angle=np.radians(np.linspace(0, 85, 30)))


def _of(axes, gid):
    """Return the artists of a panel with this name."""
    return [artist for artist in axes.get_children() if artist.get_gid() == gid]


@pytest.mark.slow
@pytest.mark.usefixtures("optimized")
def test_a_picture_has_the_exact_boundaries(chart):
    """Over the cells run the curves: each passes between the outcomes that `boundary` has at an angle between cells."""
    curves = map_curves(chart)
    left = next(axes for axes in draw_map(chart, curves).axes if axes.get_ylabel().startswith("Stokes"))
    drawn = [line.get_xydata() for line in _of(left, "boundary")]
    angle = 61.0
    (changes,) = boundary("granulation", angle=np.radians([angle]), stokes=(0.01, 0.5)).changes
    heights = sorted(
        float(np.interp(angle, *curve[np.argsort(curve[:, 0])].T)) for curve in drawn if np.ptp(curve[:, 0]) > 5
        if curve[:, 0].min() < angle < curve[:, 0].max()
    )  # fmt: skip
    assert heights == pytest.approx([change.stokes for change in changes], rel=2e-3)


def test_stick_rotate_separate_and_the_range_are_hatched(chart):
    """Cells of stick-rotate-separate have a hatch, those outside the range another, and both are in the legend."""
    figure = draw_map(chart)
    left = next(axes for axes in figure.axes if axes.get_ylabel().startswith("Stokes"))
    areas = {}
    for name in ("cells of stick-rotate-separate", "cells outside the range"):
        (hatched,) = _of(left, name)
        areas[name] = hatched.get_hatch(), hatched.get_path()
    assert len({hatch for hatch, _ in areas.values()}) == 2
    flagged = np.argwhere(chart.validity.values != 0)
    outside = areas["cells outside the range"][1].vertices
    assert np.degrees(chart.angle.values[flagged[:, 0].min()]) >= outside[:, 0].min() > 60
    (words,) = [[text.get_text() for text in axes.get_legend().texts] for axes in figure.axes if axes.get_legend()]
    assert "outside the model's range" in words


def test_a_spin_is_an_axis_of_the_picture():
    """Of one Stokes number over a spin, the spin goes upwards with its sign and unit; over more, each has a panel."""
    spins, angle = np.linspace(-2e4, 2e4, 5), np.radians([10.0, 40.0, 70.0])
    single = regime_map("granulation", stokes=0.03, angle=angle, vary={"impact.spin": spins})
    axes = draw_map(single).axes[0]
    assert axes.get_ylabel() == "spin (rad/s)"
    assert axes.get_ylim() == (-2e4, 2e4)
    [cells] = [each for each in axes.collections if hasattr(each, "get_coordinates")]
    assert np.array_equal(cells.get_array().reshape(5, 3), single.outcome.values[:, 0, :].T)
    several = regime_map("granulation", stokes=[0.03, 0.1], angle=angle, vary={"impact.spin": spins})
    titles = [axes.get_title() for axes in draw_map(several).axes]
    assert {"spin -20000 rad/s", "spin 0 rad/s", "spin 20000 rad/s"} <= set(titles)
