"""The laws hold on the presets; the budget of e_n^2 - 1; the report and its command."""

import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.verify import Finding, Report, conserved, numeric, region, sample

from ...helpers.command import run
from ...helpers.own_arm import surface

LAWS = [
    "completed", "energy ledger", "angular momentum", "cvodes = rosenbrock", "taylor = rosenbrock", "taylor = cvodes",
    "stick certificate", "taylor = cvodes, on the grid", "e_n^2 - 1: identity", "e_n^2: ceiling", "e_n > 1",
]  # fmt: skip


# fewer impacts than a user gets, of every kind
SMALL = sample.Extent(audited=16, grid_angles=(30, 75), grid_points=6)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["granulation", "pendulum", "granulation-dry-bridge"])
def test_every_law_holds_on_the_presets(name: str) -> None:
    """Every law has a finding on every preset that has its subject, and none fails."""
    found = {finding.name: finding for finding in numeric(Scene.load(name), extent=SMALL)}
    strings = name == "pendulum"
    assert sorted(found) == sorted(LAWS)
    assert [law for law, finding in found.items() if finding.ok is False] == []
    held = [law for law, finding in found.items() if finding.ok is not None]
    assert len(held) >= len(LAWS) - 3 - strings


@pytest.mark.slow
def test_the_surface_arm_is_a_note() -> None:
    """Surface arm of a model file: the drift of L is reported, not held."""
    collisions = sample.collisions(surface("granulation"), (0.0, 0.5, 1.3))
    found = {finding.name: finding for finding in conserved.conserved(collisions)}
    assert found["angular momentum"].ok is None
    drift = float(found["angular momentum"].figure.split()[1].rstrip(":"))
    assert 1e-3 < drift < 2e-2  # x/4a is 0.2 to 1 % here
    assert not [law for law, finding in found.items() if finding.ok is False]


@pytest.mark.slow
def test_the_budget_of_spinning_spheres() -> None:
    """What the spins bring counts as rotation: the identity closes, and e_n stays below its ceiling."""
    scene = Scene.load("granulation").with_entries({"impact.spin": 5e4, "impact.partner_spin": -2e5})
    extent = sample.Extent(grid_angles=(0, 60), grid_points=8)
    found = {finding.name: finding.ok for finding in region.argument(region.grid(scene, extent))}
    assert found["e_n^2 - 1: identity"] and found["e_n^2: ceiling"]


def report() -> Report:
    """Two groups, one failure, a note, a long text, a bar in a statement."""
    return Report(
        (
            Finding("Symbolic", "inertia", "I(x) = |rigid|", "2 identities", "", True),
            Finding("Numeric: s", "energy ledger", "closes", "3.0e-06", "1.0e-08", False, "St 1, 30 deg, cvodes"),
            Finding("Numeric: s", "e_n > 1", "where", "word " * 40, "", None, about=("  a table",)),
        )
    )


def test_the_command_names_the_law_the_figure_and_the_place(monkeypatch, tmp_path) -> None:
    """Exit 1; one line on standard error: which law, by how much, where."""
    monkeypatch.setattr("wetdoublet.solvers.verify.verify", lambda scene, progress, recompute: report())
    result = run("verify", "granulation", "-o", tmp_path / "report.md")
    assert (tmp_path / "report.md").read_text().rstrip() == str(report())
    assert result.exit_code == 1
    line = "energy ledger (Numeric: s): 3.0e-06, bound 1.0e-08, at St 1, 30 deg, cvodes"
    assert result.stderr == f"verify: {line}\n"


@pytest.mark.slow
def test_strings_turn_the_pair() -> None:
    """A film so thin that glass is met at initial contact; L, which strings change, is a note that says so."""
    scene = Scene.load("pendulum").with_entries({"liquid.film_thickness": 2e-6})
    found = {finding.name: finding for finding in conserved.conserved(sample.collisions(scene, (0.0, 0.5)))}
    assert found["angular momentum"].ok is None and "torque" in found["angular momentum"].figure
