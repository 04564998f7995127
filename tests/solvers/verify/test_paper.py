"""The paper's figures and numbers: computed in the run, complete, and beside the printed ones."""

import math
import re

import numpy as np
import pytest
from matplotlib.image import imread
from matplotlib.mathtext import MathTextParser
from wetdoublet.solvers import collide_many
from wetdoublet.solvers.host.files import write_all_in
from wetdoublet.solvers.verify.paper.printed import DOUBLED, PRINTED, SHOTS
from wetdoublet.solvers.verify.paper.report import PENDULUM, report
from wetdoublet.solvers.verify.paper.reproduce import PARTS

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("optimized")]

FACTORS = {"V": 1.038, "x₀": 0.762, "μ": 0.983, "σ": 1.010, "m": 1.010, "a": 1.136}  # an independent prototype's


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Every part in one folder with the report."""
    folder = tmp_path_factory.mktemp("paper")
    parts = {name: part(folder) for name, part in PARTS.items()}
    text = report(list(parts.values()), "In a test.")
    write_all_in(folder, {"report.md": text})
    return folder, parts


@pytest.fixture
def compared(made):
    """Comparisons by key."""
    return {one.key: one for part in made[1].values() for one in part.comparisons}


def test_every_printed_number_is_compared_once(made):
    """The paper's data table and the comparisons have the same entries, each once."""
    keys = [one.key for part in made[1].values() for one in part.comparisons]
    assert sorted(keys) == sorted(PRINTED)


def test_figure_1_has_the_papers_outcomes(compared):
    """S, SRS and B with the preset's strings."""
    for shot in SHOTS:
        one = compared[f"fig1{shot.panel}"]
        assert one.ours == shot.outcome
        assert one.verdict == "agrees"


@pytest.mark.parametrize(("key", "value"), [("stokes_3", 1.44666), ("stokes_4", 0.115321), ("centrifugal", 4.121)])
def test_critical_numbers(compared, key, value):
    """St* and Ce* are those of an independent prototype."""
    assert compared[key].ours == pytest.approx(value, rel=2e-4)


def test_the_angle_from_which_doublets_rotate(compared):
    """Half a degree below it collisions stick or bounce; half a degree above it some rotate first."""
    for aside, rotates in ((-0.5, False), (0.5, True)):
        angle = math.radians(compared["angle_3"].ours + aside)
        outcome = collide_many(PENDULUM, stokes=np.linspace(1.3, 1.42, 500), angle=angle).outcome.values
        assert set(outcome) == ({0, 1, 2} if rotates else {0, 2})


def test_both_readings_of_stokes_3(compared):
    """A criterion is met from St 1.348 on, well before the doublet escapes."""
    assert "1.348" in compared["stokes_3"].why


@pytest.mark.parametrize("symbol", FACTORS)
def test_factors(compared, symbol):
    """Ce* factors are those of the independent prototype, and on the paper's side of 1."""
    entry, printed = DOUBLED[symbol]
    assert compared[entry].ours == pytest.approx(FACTORS[symbol], abs=6e-4)
    assert (compared[entry].ours > 1) == (float(printed) >= 1)


@pytest.mark.parametrize("key", ["dry", "two_at_15", "same_at_15", "above_one"])
def test_findings_in_words(compared, key):
    """Only theta0 = 0 sticks without F_c; S and B at 15 deg, as head-on; e_n > 1."""
    assert compared[key].verdict == "agrees"


def test_table_1_can_be_read(made):
    """The table's formulas have every force and parse as mathtext."""
    parser = MathTextParser("path")
    formulas = re.findall(r"^\$\$ (.*) \$\$$", made[1]["table1"].text, re.MULTILINE)
    for force in ("F_{L,n}", "F_{L,t}", "F_c", "F_{S,n}", "F_{S,t}"):
        assert sum(formula.startswith(f"{force} =") for formula in formulas) == 1
    for formula in formulas:
        parser.parse(f"${formula}$")


@pytest.mark.parametrize("name", ["fig1", "fig3", "fig4a", "fig4b"])
def test_pictures_are_not_clipped(made, name):
    """Every picture is there at print resolution, with a white margin all around."""
    [picture] = made[1][name].pictures
    pixels = imread(made[0] / picture)[..., :3]
    assert pixels.shape[1] == pytest.approx(8.8 / 2.54 * 300, abs=2)
    for edge in (pixels[:3], pixels[-3:], pixels[:, :3], pixels[:, -3:]):
        assert np.all(edge == 1)
