"""One collision against closed forms, limits, similarity and the paper's statements."""

import pytest
from wetdoublet.solvers import collide_many

from ...helpers.reference import collide


@pytest.mark.parametrize("angle", [5e-324, 1e-300])
def test_an_angle_whose_rotation_rate_underflows_is_head_on(angle: float) -> None:
    """At the smallest positive numbers, too, alone and in a batch."""
    alone = [collide("granulation", stokes=stokes, angle=angle) for stokes in (0.01, 3.0)]
    batch = collide_many("granulation", stokes=[0.01, 3.0], angle=angle)
    head_on = collide_many("granulation", stokes=[0.01, 3.0], angle=0.0)
    assert [one.restitution for one in alone] == pytest.approx(head_on.restitution.values, rel=1e-9)
    assert batch.restitution.values.tolist() == head_on.restitution.values.tolist()
