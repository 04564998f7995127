"""`bench`: cost and error of the engines on a scene's collisions, and the setting recommended. No time is asserted."""

from dataclasses import replace

import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.verify.work_precision import Row, WorkPrecision, work_precision

RTOLS = (1e-5, 1e-8)
PENDULUM = Scene.load("pendulum")


@pytest.fixture(scope="module")
def measured() -> WorkPrecision:
    """The pendulum's impacts at two tolerances."""
    return work_precision(PENDULUM, tolerances=RTOLS, size=4)


@pytest.mark.slow
def test_errors_are_those_of_collisions_asked_for_one_by_one(measured: WorkPrecision) -> None:
    """Largest differences in e_n of Rosenbrock to CVODES at 1e-12, a reference that bench has not."""
    assert measured.separate > 1
    assert measured.left_out == 0
    for rtol in RTOLS:
        errors = []
        for impact in measured.impacts:
            asked = {"stokes": impact.stokes, "angle": impact.angle, "ledger": False}
            one = collide(PENDULUM, **asked, rtol=rtol, engine="rosenbrock")
            truth = collide(PENDULUM, **asked, rtol=1e-12, engine="cvodes")
            if truth.contact_time and one.contact_time:
                errors.append(abs(one.restitution - truth.restitution))
        (row,) = (row for row in measured.rows if (row.engine, row.rtol) == ("rosenbrock", rtol))
        assert row.error == pytest.approx(max(errors), rel=0.1)


@pytest.mark.slow
def test_every_engine_is_measured_at_every_tolerance(measured: WorkPrecision) -> None:
    """All outcomes right; errors fall with the tolerance, are above the references' own, and fill the picture."""
    assert [(row.engine, row.rtol) for row in measured.rows] == [(e, rtol) for e in measured.engines for rtol in RTOLS]
    assert {"cvodes", "rosenbrock"} <= set(measured.engines)
    for loose, tight in zip(measured.rows[::2], measured.rows[1::2], strict=True):
        assert loose.wrong == loose.failed == tight.wrong == tight.failed == 0
        assert loose.error is not None
        assert tight.error is not None
        assert loose.error > tight.error > measured.uncertainty
        assert tight.seconds > 0
    left, right = measured.plot().axes[0].get_xlim()
    assert 1 < left / max(row.error or 0 for row in measured.rows) < 10
    assert 0.1 < right / min(measured.wanted, measured.uncertainty) < 1


def _row(engine: str, rtol: float, error: float | None, cost: float, **more: int) -> Row:
    return Row(engine, rtol, error, cost, **{"wrong": 0, "failed": 0} | more)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wanted", "setting"),
    [
        (1e-3, ("cvodes", 1e-4)),  # the cheapest engine
        (1e-5, ("rosenbrock", 1e-6)),  # cvodes' luck at 1e-5 does not last
        (1e-9, (None, None)),  # nothing reaches it
        (1e-14, (None, None)),  # the references do not tell
    ],
)
def test_the_cheapest_setting_that_keeps_the_error_is_recommended(
    measured: WorkPrecision, wanted: float, setting: tuple[str, float]
) -> None:
    """Of each engine the loosest tolerance from which on it keeps the error; wrong outcomes disqualify."""
    rows = (
        _row("cvodes", 1e-4, 1e-4, 1.0), _row("cvodes", 1e-5, 1e-6, 1.5), _row("cvodes", 1e-6, 2e-5, 2.0),
        _row("rosenbrock", 1e-4, 1e-6, 3.0, wrong=1), _row("rosenbrock", 1e-6, 1e-8, 4.0),
    )  # fmt: skip
    found = replace(measured, rows=rows, uncertainty=1e-13, wanted=wanted).recommended
    assert (found.engine, found.rtol) == setting
    assert found.reason
