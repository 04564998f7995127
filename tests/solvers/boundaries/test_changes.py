"""Brackets, experiments and slopes of changes, beside known places and beside collisions of single scenes."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, boundary, boundary_sensitivities, collide_many
from wetdoublet.solvers.boundaries.brackets import locate
from wetdoublet.solvers.boundaries.experiment import Experiment, Rows
from wetdoublet.solvers.boundaries.slopes import Lines, outcomes_along, slopes, slopes_by_differences

ENTRIES = ("liquid.viscosity", "liquid.film_thickness")


def steps(edges: np.ndarray):
    """Labels 0, 1, 2, ... between the edges (lines, edges) of each line."""
    return lambda line, place: (place[:, None] >= edges[line]).sum(axis=1)


def test_changes_of_many_lines_are_enclosed() -> None:
    """Every change is within its bracket, which is as narrow as asked, and has the labels of its sides."""
    edges = np.sort(np.random.default_rng(0).uniform(0.05, 0.95, (50, 4)), axis=1)
    changes = locate(steps(edges), np.tile(np.linspace(0, 1, 9), (50, 1)), 1e-9)
    assert changes.size == edges.size  # strips narrower than the samples, too
    assert ((changes.low <= edges.ravel()) & (edges.ravel() <= changes.high)).all()
    assert (changes.high - changes.low).max() <= 1e-9
    assert changes.before.tolist() == [0, 1, 2, 3] * 50
    assert (changes.after == changes.before + 1).all()


def test_pieces_lie_between_the_changes() -> None:
    """Each line has one part more than changes; neighbouring parts share a change."""
    changes = locate(steps(np.array([[0.3, 0.6], [2.0, 2.0]])), np.tile(np.linspace(0, 1, 5), (2, 1)), 1e-6)
    line, label, lower, upper = changes.pieces()
    assert line.tolist() == [0, 0, 0, 1]
    assert label.tolist() == [0, 1, 2, 0]
    assert lower.tolist() == [-1, 0, 1, -1]
    assert upper.tolist() == [0, 1, -1, -1]


def test_a_width_may_depend_on_the_place() -> None:
    """Brackets are as narrow as the function of them says."""
    edges = np.array([[0.2, 0.8]])
    changes = locate(
        steps(edges), np.linspace(0, 1, 4)[None], lambda brackets: np.where(brackets.low < 0.5, 1e-3, 1e-6)
    )
    assert 1e-4 < changes.high[0] - changes.low[0] <= 1e-3
    assert changes.high[1] - changes.low[1] <= 1e-6


def test_unknown_labels_are_passed_over() -> None:
    """A bracket becomes as narrow as the band without labels within it; a change on another line is not affected."""

    def labels(line: np.ndarray, place: np.ndarray) -> np.ndarray:
        hidden = (line == 0) & (np.abs(place - 0.5) < 0.01)
        return np.where(hidden, -1, place >= np.array([0.5, 0.505])[line])

    changes = locate(labels, np.tile([0.0, 0.4, 1.0], (2, 1)), 1e-6, unknown=-1)
    assert changes.low[0] <= 0.49 < 0.51 <= changes.high[0]
    assert changes.high[0] - changes.low[0] < 0.03
    assert changes.low[1] <= 0.505 <= changes.high[1] <= changes.low[1] + 1e-6


def test_chatter_is_not_separated() -> None:
    """Of a line with more changes than wanted, further ones within a bracket are left out."""
    edges = np.linspace(0.1, 0.9, 200)[None]
    changes = locate(steps(edges), np.array([[0.0, 1.0]]), 1e-6, most=10)
    assert 5 <= changes.size <= 20


def rows(scene: Scene, viscosities: list[float], values: list[float]) -> Experiment:
    """Rows that differ in their viscosity, with the film thickness and the roughness free."""
    names = ("liquid.film_thickness", "particles.roughness")
    found = Rows(scene, names, {"liquid.viscosity": np.array(viscosities)}, len(viscosities), 1e-9).at(np.array(values))
    assert found is not None
    return found


def test_rows_collide_as_their_scenes() -> None:
    """Outcomes and results of impacts on rows are those of `collide_many` with the entries of each row."""
    scene = Scene.load("granulation")
    film, roughness = float(scene.entries["liquid.film_thickness"]), float(scene.entries["particles.roughness"])
    experiment = rows(scene, [1.8, 2.2], [1.1 * film, 0.9 * roughness])
    row, speed, angle = np.repeat([0, 1], 20), np.tile(np.linspace(0.3, 3.0, 20), 2), np.linspace(0.0, 1.2, 40)
    vary = {"liquid.viscosity": np.array([1.8, 2.2])[row], "liquid.film_thickness": np.full(40, 1.1 * film)}
    vary["particles.roughness"] = np.full(40, 0.9 * roughness)
    of = ("restitution", "contact_time")
    single = collide_many(scene, speed=speed, angle=angle, vary=vary, of=of)
    assert experiment.outcomes(row, speed, angle).tolist() == single.outcome.values.tolist()
    results = experiment.results(of, row, speed, angle)
    apart = single.outcome.values > 0
    for k, name in enumerate(of):
        assert results.value[k, apart] == pytest.approx(single[name].values[apart], rel=1e-6)
    assert np.isnan(results.value[:, ~apart]).all()
    assert {0, 1, 2} == set(single.outcome.values.tolist())


@pytest.mark.slow
def test_approximate_slopes_and_differences_are_those_of_boundary_sensitivities() -> None:
    """Critical speeds at an angle move with viscosity and film thickness as the exact derivatives say."""
    scene, angle = Scene.load("granulation"), math.radians(45)
    experiment = Rows(scene, ENTRIES, {}, 1, 1e-11).at(np.array([scene.entries[name] for name in ENTRIES]))
    assert experiment is not None
    unit = scene.speed_of(1.0)
    lines = Lines(
        np.zeros(1, int), np.array([[0.0, unit]]), np.array([[angle, 0.0]]), np.array([0.03]), np.array([0.5]), False
    )
    changes = locate(outcomes_along(experiment, lines), np.geomspace(0.03, 0.5, 60)[None], 1e-10)
    [exact] = boundary_sensitivities(scene, angle=angle, stokes=(0.03, 0.5), wrt=list(ENTRIES), rtol=1e-11).changes
    assert changes.place == pytest.approx([each.change.stokes for each in exact], rel=1e-7)
    expected = np.array([[each.elasticity["speed"][name] for name in ENTRIES] for each in exact])
    relative = (
        experiment.values / changes.place[:, None]
    )  # errors are those of the distance at which gradients are taken
    assert slopes(experiment, lines, changes, approximate=True) * relative == pytest.approx(expected, abs=1e-2)
    assert slopes_by_differences(experiment, lines, changes) * relative == pytest.approx(expected, abs=1e-3)


def test_a_boundary_at_initial_contact_has_slopes() -> None:
    """Where solids meet at once, no gradient is singular; the change is located again with displaced entries."""
    scene = Scene.load("granulation")
    lines = Lines(np.zeros(1, int), np.array([[0.0, 1.0]]), np.zeros((1, 2)), np.array([0.1]), np.array([20.0]), False)
    experiment = Rows(scene, ENTRIES[:1], {}, 1, 1e-10).at(np.array([scene.entries[ENTRIES[0]]]))
    assert experiment is not None
    changes = locate(outcomes_along(experiment, lines), np.geomspace(0.1, 20, 40)[None], 1e-9)
    viscosity = float(scene.entries[ENTRIES[0]])
    ends = [boundary(scene.with_si({ENTRIES[0]: viscosity * (1 + sign * 1e-4)}), angle=[0.0]) for sign in (1, -1)]
    critical = [each.changes[0][0].stokes / each.scene.stokes_per_speed for each in ends]
    difference = (critical[0] - critical[1]) / (2e-4 * viscosity)
    assert slopes(experiment, lines, changes)[0, 0] == pytest.approx(difference, rel=1e-4)
