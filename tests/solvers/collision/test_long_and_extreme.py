"""What physics decides however long it takes, what ends for want of steps, and numbers that are out of range."""

import numpy as np
import pytest
from wetdoublet.solvers import ComputationError, InputError, Scene, boundary, collide_many, regime_map

from ...helpers.entries import CIRCLES
from ...helpers.reference import collide

pytestmark = pytest.mark.slow


def test_what_is_left_of_sliding_keeps_its_sign_and_digits() -> None:
    """A slide of 1e-10 of the first is as accurate as one of order 1, and positive, as the modes say."""
    wall = Scene.load("granulation").with_entries({"partner.wall": True})
    loose, sharp = (collide(wall, stokes=0.0403, angle=1.2, engine="rosenbrock", rtol=rtol) for rtol in (1e-9, 1e-12))
    for name in ("tangential_restitution", "final_spin"):
        one, exact = getattr(loose, name), getattr(sharp, name)
        assert exact > 0 and one == pytest.approx(exact, rel=1e-6)
    assert sharp.tangential_restitution is not None and sharp.tangential_restitution < 1e-9


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_one_extreme_point_leaves_the_others(engine: str) -> None:
    """A map from 1e-300 to 1e300 has its points in between; what is out of range is marked."""
    data = regime_map("granulation", stokes=[1e-300, 0.2, 1e300, 1.7e308], angle=1.0, engine=engine, of=())
    assert data.outcome.values.tolist() == [[-1, 2, -1, -1]]
    assert all("impact.speed" in reason for reason in data.reason.values[data.outcome.values == -1])


@pytest.mark.parametrize(
    ("impact", "changes"),
    [
        ({"stokes": 1e308}, {}), ({"stokes": 1e-320}, {}), ({"speed": 1e200}, {}),
        ({"stokes": 0.1}, {"liquid.viscosity": 1e250}), ({"stokes": 0.1}, {"particles.reduced_mass": 1e-300}),
        ({"stokes": 0.1}, {"bridge.surface_tension": 1e-200}),
    ],
)  # fmt: skip
def test_extreme_numbers_are_bad_input(impact: dict[str, float], changes: dict[str, float]) -> None:
    """Where groups or scales leave their range, that is said of an entry, and collisions are marked."""
    scene = Scene.load("granulation").with_entries(changes)
    with pytest.raises(InputError, match="is too far off.*; accepted: "):
        collide(scene, angle=1.0, **impact)
    found = collide_many(scene, angle=[1.0, 0.5], of=("contact_time",), **impact)
    assert found.outcome.values.tolist() == [-1, -1]


@pytest.mark.parametrize("span", [(1e-300, 1.0), (1e-3, 1e300)])
def test_extreme_spans_are_bad_input(span: tuple[float, float]) -> None:
    """A boundary is looked for among Stokes numbers that can be told apart: the range is said."""
    with pytest.raises(InputError, match=r"^impact.stokes: .* is too far off; accepted: from 1e-30 to 1e\+30$"):
        boundary("granulation", angle=0.5, stokes=span)


@pytest.mark.usefixtures("optimized")
def test_circling_is_decided_by_its_limit() -> None:
    """A doublet that dips ever less into its film has the outcome of its limit.

    The limit depends on the angular momentum and the bridge alone, so angles have one Ce*.
    """
    scene = Scene.from_dict(CIRCLES)
    angles = np.array([0.4465, 0.5])
    found = boundary(scene, angle=angles, stokes=(0.005, 0.05))
    assert not found.failed
    first, second = (line[0] for line in found.changes)
    assert (first.before, first.after) == ("stick", "stick-rotate-separate")
    assert first.centrifugal == pytest.approx(second.centrifugal, rel=1e-8)


def test_an_impact_too_oblique_to_begin_has_no_state() -> None:
    """The centrifugal force turns the approach within 1e-16 of the film: the gap has not moved, least of all to 0."""
    with pytest.raises(ComputationError, match="within a rounding error of the film thickness") as caught:
        collide("granulation", stokes=0.03, angle=np.pi / 2 - 1e-9)
    assert not caught.value.state and caught.value.time is None


@pytest.mark.parametrize("angle", [5e-324, 1e-300])
def test_an_angle_whose_rotation_rate_underflows_is_head_on(angle: float) -> None:
    """At the smallest positive numbers, too, alone and in a batch."""
    alone = [collide("granulation", stokes=stokes, angle=angle) for stokes in (0.01, 3.0)]
    batch = collide_many("granulation", stokes=[0.01, 3.0], angle=angle)
    head_on = collide_many("granulation", stokes=[0.01, 3.0], angle=0.0)
    assert [one.restitution for one in alone] == pytest.approx(head_on.restitution.values, rel=1e-9)
    assert batch.restitution.values.tolist() == head_on.restitution.values.tolist()
