"""The picture of a regime map, by its artists."""

import numpy as np
import pytest
from wetdoublet.solvers import Scene, boundary, regime_map
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


@pytest.mark.slow
def test_panels_over_a_volume_in_its_unit_have_boundaries():
    """A panel of V = 0.1 R^3 in m^3 has the curves of the same bridge given as V/R^3."""
    scene = Scene.load("granulation")
    volume = 0.1 * (2 * scene.reduced_radius) ** 3
    impact = {"stokes": np.geomspace(0.01, 0.5, 8), "angle": np.radians(np.linspace(40, 70, 8))}
    by_ratio = map_curves(regime_map(scene, vary={"bridge.volume": [0.1]}, **impact))
    by_volume = map_curves(regime_map(scene, vary={"bridge.volume": [f"{volume!r} m^3"]}, **impact))
    assert by_ratio[0] and len(by_ratio[0]) == len(by_volume[0])
    for (x, y), (other_x, other_y) in zip(by_ratio[0], by_volume[0], strict=True):
        assert [x[0], x[-1], y[0], y[-1]] == pytest.approx([other_x[0], other_x[-1], other_y[0], other_y[-1]], rel=1e-6)


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


def test_colours_of_restitution_say_where_they_end(chart):
    """The highest colour is labelled as a limit, and above it stands the largest e_n."""
    bar = draw_map(chart).axes[2]
    assert [text.get_text() for text in bar.get_yticklabels()][-1] == "≥ 2"
    assert float(bar.get_title().removeprefix("up to ")) == pytest.approx(float(chart.restitution.max()), rel=0.01)


@pytest.mark.parametrize(
    ("partner", "words"),
    [
        ({"partner.wall": True}, "against a wall"),
        ({"partner.radius": 3e-4, "partner.mass": 1e-7}, "of 3 times the radius"),
    ],
)
def test_a_title_says_what_the_sphere_meets(partner, words):
    """A map of a wall, or of unequal spheres, says so; one of equal spheres has nothing to say."""
    scene = Scene.load("granulation").with_entries(partner)
    assert words in draw_map(regime_map(scene, stokes=[0.1, 0.2], angle=[0.5, 1.0])).get_suptitle()


def test_labels_of_contours_are_upright_and_apart(chart):
    """Labels of e_n are not rotated, have a halo, and none touches another."""
    figure = draw_map(chart)
    figure.draw_without_rendering()
    labels = [text for axes in figure.axes for text in axes.texts if text.get_text() in ("1", "3", "5")]
    assert len(labels) >= 2
    assert all(text.get_rotation() == 0 and text.get_path_effects() for text in labels)
    boxes = [text.get_window_extent() for text in labels]
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])


def test_a_spin_is_an_axis_of_the_picture():
    """Of one Stokes number over a spin, the spin goes upwards with its sign and unit; over more, each has a panel."""
    spins, angle = np.linspace(-2e4, 2e4, 5), np.radians([10.0, 40.0, 70.0])
    single = regime_map("granulation", stokes=0.03, angle=angle, vary={"impact.spin": spins}, rtol=1e-6)
    axes = draw_map(single).axes[0]
    assert axes.get_ylabel() == "spin (rad/s)"
    assert axes.get_ylim() == (-2e4, 2e4)
    [cells] = [each for each in axes.collections if hasattr(each, "get_coordinates")]
    assert np.array_equal(cells.get_array().reshape(5, 3), single.outcome.values[:, 0, :].T)
    several = regime_map("granulation", stokes=[0.03, 0.1], angle=angle, vary={"impact.spin": spins}, rtol=1e-6)
    titles = [axes.get_title() for axes in draw_map(several).axes]
    assert {"spin -20000 rad/s", "spin 0 rad/s", "spin 20000 rad/s"} <= set(titles)
