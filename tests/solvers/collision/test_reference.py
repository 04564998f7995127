"""One collision against an independent high-precision implementation (tests/data, 80-bit Taylor series)."""

from typing import Any

import pytest
from wetdoublet.solvers import collide

from ...helpers.own_arm import described

RTOL = 1e-10
TOLERANCE = 1e-7  # what the engine owes at RTOL
QUANTITIES = (
    "restitution", "tangential_restitution", "rotation", "contact_time", "smallest_gap", "final_spin",
    "final_rotation_rate",
)  # fmt: skip


def _same(found: float | None, expected: float | None, tolerance: float, name: str) -> None:
    if expected is None:
        assert found is None, name
    else:
        assert found == pytest.approx(expected, rel=tolerance, abs=0.0 if expected else tolerance), name


def test_reference_collisions(reference: dict[str, Any]) -> None:
    """Outcome, separation quantities, events, energies and conservation laws equal the reference's."""
    expected = reference["results"]
    found = collide(described(reference["scene"]), **reference["impact"], rtol=RTOL, engine="rosenbrock").to_dict()
    assert found["outcome"] == expected["outcome"]
    for quantity in QUANTITIES:
        _same(found[quantity], expected[quantity], TOLERANCE, quantity)
    for number in ("stokes", "centrifugal", "capillary"):
        _same(found[number], expected[number], 1e-13, number)
    initial = found["energy"]["initial"]
    assert abs(found["energy"]["residual"]) < 1e-8 * initial
    if reference["scene"]["model"]["arm"] == "midgap" and "pendulum" not in reference["scene"]:
        assert found["angular_momentum_drift"] < 1e-9
    if expected["outcome"] == "stick":
        return
    assert found["reversal"] == expected["reversal"]
    assert [event["kind"] for event in found["events"]] == [event["kind"] for event in expected["events"]]
    for mine, theirs in zip(found["events"], expected["events"], strict=True):
        assert mine["time"] == pytest.approx(theirs["time"], rel=TOLERANCE, abs=1e-300), mine["kind"]
    for term, value in expected["energy"].items():
        assert found["energy"][term] == pytest.approx(value, abs=TOLERANCE * initial), term
