"""The terms of e_n^2 - 1 of a collision, over time, as a table and as a picture."""

import json

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.collision.budget import over_time

from ...helpers.command import run

GAINS = {"stokes": 0.02, "angle": "75 deg"}


def test_a_stick_has_no_budget():
    """A stick has no e_n: the budget is empty and says so, JSON has null; without the ledger there is none."""
    stick = collide("granulation", stokes=0.002, angle="75 deg")
    assert stick.outcome == "stick" and len(stick.budget) == 0 and not stick.budget
    assert "a stick never separates" in str(stick.budget)
    assert collide("granulation", **GAINS, ledger=False).budget is None
    shown = run("collide", "granulation", "--stokes", 0.002, "--angle", 75, "--why")
    assert shown.exit_code == 0 and "a stick never separates" in shown.stdout
    assert json.loads(run("collide", "granulation", "--stokes", 0.002, "--why", "--json").stdout)["budget"] is None


@pytest.mark.parametrize(
    ("engine", "name", "entries"),
    [
        ("taylor", "granulation", {"impact.stokes": 0.02, "impact.angle": "75 deg"}),
        ("rosenbrock", "granulation", {"impact.stokes": 0.14, "impact.angle": "40 deg"}),
        ("taylor", "granulation", {"impact.stokes": 0.2, "impact.angle": 0.0}),
        ("taylor", "pendulum", {}), ("rosenbrock", "pendulum", {}),
        ("rosenbrock", "granulation", {"impact.stokes": 0.3, "impact.angle": "50 deg", "partner.wall": True}),
    ],
)  # fmt: skip
@pytest.mark.slow
def test_the_terms_over_time_end_as_the_budget(engine, name, entries):
    """They begin at 0 or with a rebound, sum to u^2/v0^2 - 1 all along, and at the end each is the budget's."""
    one = collide(Scene.load(name).with_entries(entries), trajectory=True, engine=engine, rtol=1e-10)
    terms, shares = over_time(one, one.trajectory), dict(one.budget)
    size = max(1.0, *map(abs, shares.values()))
    first = {term: values[0] for term, values in terms.items() if term != "dry_contact" or one.events[0].time > 0}
    assert list(first.values()) == pytest.approx([0.0] * len(first), abs=1e-12 * size)
    velocity = one.trajectory["normal_velocity"].values / one.speed
    assert sum(terms.values()) == pytest.approx(velocity**2 - 1, abs=1e-12 * size)
    for term, values in terms.items():
        expected = shares[term] + (shares["residual"] if term == "dry_contact" else 0.0)
        assert values[-1] == pytest.approx(expected, abs=1e-8 * size), term
    losses = [terms[term] for term in ("normal_lubrication", "tangential_lubrication") if term in terms]
    assert all(np.all(np.diff(values) <= 1e-9 * size) for values in losses)  # a loss only grows


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_what_declared_events_take_is_not_the_solids(tmp_path, engine):
    """A jump to 0.7 of the velocity takes (1 - 0.49) u^2/v0^2 when it happens, the solids their own at contact; the
    gap at the end is that of the event which parts them.
    """
    path = tmp_path / "tug.py"
    tug = 'event("tug", guard=3*x0 - x, jump={u: u*0.7}, where="opening")'
    end = 'event("end", guard=4*x0 - x, where="opening", ends="separated")'
    path.write_text(f"from wetdoublet.derive.user import *\n{tug}\n{end}\n")
    one = collide(Scene.load("granulation", model=path), stokes=1.0, angle="60 deg", trajectory=True, engine=engine)
    terms, data, shares = over_time(one, one.trajectory), one.trajectory, dict(one.budget)
    (at,) = [event.time for event in one.events if event.kind == "tug"]
    time, before = data["time"].values, data["normal_velocity"].values[data["time"].values <= at].max() / one.speed
    assert set(terms["own_events"][time < at]) == {0.0}
    assert terms["own_events"][time > at] == pytest.approx(-(1 - 0.49) * before**2, rel=1e-6)
    assert terms["own_events"][-1] == pytest.approx(shares["own_events"], rel=1e-6)
    assert terms["dry_contact"] == pytest.approx(-(1 - 0.99**2), abs=1e-6)  # at contact
    assert one.final_gap == pytest.approx(32e-6, rel=1e-9)
    assert sum(shares.values()) == pytest.approx(one.restitution**2 - 1, abs=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "impact", "panels"),
    [("granulation", GAINS, 4), ("pendulum", {}, 4), ("granulation", {"stokes": 0.2, "angle": 0.0}, 2)],
)
def test_the_picture_has_the_terms_and_the_momentum(name, impact, panels, tmp_path):
    """A curve for each term that is not zero, and the sum; above them L, constant but for strings; nothing head-on."""
    one = collide(name, **impact, trajectory=True)
    figure = one.budget.plot(tmp_path / "why.png")
    assert (tmp_path / "why.png").stat().st_size > 10_000
    assert len(figure.axes) == panels
    labels = {line.get_label() for line in figure.axes[-1].lines}
    assert "rigid rotation" in labels or impact.get("angle") == 0.0
    (total,) = [line for line in figure.axes[-1].lines if line.get_label().startswith("sum")]
    assert total.get_ydata()[-1] == pytest.approx(one.restitution**2 - 1, abs=1e-8)
    if impact.get("angle") != 0.0:
        momentum = figure.axes[0].lines[0].get_ydata()
        assert momentum[0] == 1.0
        assert (abs(momentum - 1) < 1e-9).all() == (name == "granulation")
