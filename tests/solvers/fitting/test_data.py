"""Measurements as they are read."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from wetdoublet.solvers import InputError, Scene, fit
from wetdoublet.solvers.fitting.data_table import read_data
from wetdoublet.solvers.fitting.measurements import ANGLE_SD, SPEED_SD

SCENE = Scene.load("granulation")


def written(folder: Path, text: str) -> Path:
    path = folder / "impacts.csv"
    path.write_text(text)
    return path


def test_units_missing_cells_and_comments(tmp_path):
    """Units of the header give SI, empty cells are missing, restitution 0 alone is a stick."""
    text = (
        "# impacts\nspeed [cm/s],speed_sd [%],angle [deg],restitution,outcome,liquid.viscosity [mPa s]\n"
        "50,3,30,0.4,,2000 # first\n# between\n20,,45,0,,2100\n30,2,60,,SRS,2200\n"
    )
    found = read_data(written(tmp_path, text), SCENE)
    np.testing.assert_allclose(found.speed, [0.5, 0.2, 0.3])
    np.testing.assert_allclose(found.speed_sd, [0.015, SPEED_SD * 0.2, 0.006])
    np.testing.assert_allclose(found.angle, np.radians([30, 45, 60]))
    np.testing.assert_allclose(found.angle_sd, ANGLE_SD)
    assert found.outcome.tolist() == [-1, 0, 1]
    np.testing.assert_array_equal(np.isfinite(found.observed["restitution"][0]), [True, False, False])
    np.testing.assert_allclose(found.columns["liquid.viscosity"], [2.0, 2.1, 2.2])
    assert [remark.split(",")[0] for remark in found.remarks] == [
        "Scatter of the normal speed", "Scatter of the angle", "Standard deviation of restitution",
    ]  # fmt: skip


def test_per_cent():
    """A standard deviation in per cent is of its value; of a value in per cent it is in per cent too; no length is."""
    impacts = {"speed [m/s]": [2.0, 3.0], "angle [deg]": [10.0, 40.0]}
    found = read_data(
        {**impacts, "angle_sd [%]": [5.0, 5.0], "restitution": [0.5, 0.6], "e err (%)": [2.0, 2.0]}, SCENE
    )
    np.testing.assert_allclose(found.angle_sd, 0.05 * np.radians([10, 40]))
    np.testing.assert_allclose(found.observed["restitution"], [[0.5, 0.6], [0.01, 0.012]])
    found = read_data({**impacts, "e (%)": [50.0, 60.0], "e err (%)": [2.0, 2.0]}, SCENE)
    np.testing.assert_allclose(found.observed["restitution"], [[0.5, 0.6], [0.02, 0.02]])
    assert any("per cent as it is" in remark for remark in found.remarks)
    for name in ("contact_time", "rotation", "liquid.viscosity"):
        with pytest.raises(InputError, match=f"{name}.*part of nothing"):
            read_data({**impacts, "restitution": [0.5, 0.6], f"{name} [%]": [5.0, 5.0]}, SCENE)


def test_a_standard_deviation_in_per_cent_is_held_to_what_it_is_of():
    """60 % of 10 deg is little, 45 % of 80 deg more than half a radian; beside per cent a plain number is refused."""
    impacts = {"speed [m/s]": [2.0, 3.0], "restitution": [0.5, 0.6]}
    found = read_data({**impacts, "angle [deg]": [10.0, 12.0], "angle_sd [%]": [60.0, 60.0]}, SCENE)
    np.testing.assert_allclose(found.angle_sd, 0.6 * np.radians([10, 12]))
    with pytest.raises(InputError, match="row 2, column angle_sd: 45.0 of the angle is out of range"):
        read_data({**impacts, "angle [deg]": [10.0, 80.0], "angle_sd [%]": [45.0, 45.0]}, SCENE)
    for sd in (2.0, 0.02):
        with pytest.raises(InputError, match=r"has no unit beside restitution in %; accepted: .*\[%\]"):
            read_data(
                {"speed [m/s]": [2.0], "angle [deg]": [9.0], "restitution [%]": [50.0], "restitution_sd": [sd]}, SCENE
            )


def test_a_plain_angle_is_radians():
    """Degrees as plain numbers are told so; what is wrong in degrees as well is not."""
    for value, says in (
        (75.0, 'plain numbers are radians, did you mean a column "angle [deg]"?'),
        (95.0, "range; acc"),
    ):
        with pytest.raises(InputError) as refused:
            read_data({"speed": [0.5], "angle": [value], "restitution": [0.3]}, SCENE)
        assert refused.value.field == "data, row 1, column angle" and says in str(refused.value)


USUAL = "speed [m/s],angle [deg],restitution"
BAD = (
    (USUAL, "0.5,95,0.4", "row 1 (line 2), column angle", "out of range"),
    (USUAL, "0.5,x,0.4", "row 1 (line 2), column angle", "not a number"),
    (USUAL, ",30,0.4", "row 1 (line 2), column speed", "empty"),
    (USUAL, "0.5,30,0.3,1", "row 1 (line 2)", "too many"),
    (f"{USUAL},outcome", "0.5,30,0.3,S", "column restitution", "contradicts"),
    (f"{USUAL},restitution_sd", "0.5,30,0.3,-1", "column restitution_sd", "out of range"),
    (USUAL.replace(",", ";"), "0,5;30;0.3", "row 1 (line 2), column speed", "decimal comma"),
    (USUAL.replace(" [m/s]", " (m/s"), "0.5,30,0.3", "data", "no name of a column"),
    (USUAL.replace(" [m/s]", ""), "0.5,30,0.3", "header", "has no unit"),
    (USUAL.replace("m/s", "kg"), "0.5,30,0.3", "header", "a mass"),
    (USUAL.replace("speed", "sped"), "0.5,30,0.3", "header", "did you mean speed?"),
    ("speed [m/s],angle [deg]", "0.5,30", "data", "says nothing"),
    ("speed [m/s],angle [deg],outcome", "0.5,30,bouncing", "row 1 (line 2), column outcome", "not known"),
    ("speed [m/s],stokes,angle [deg],outcome", "0.5,1,30,S", "header", "together with"),
    ("speed [m/s],speed_sd [m/s],angle_sd [deg],outcome", "0.5,0,0,S", "column angle_sd", "is 0"),
)


@pytest.mark.parametrize(("header", "row", "field", "said"), BAD)
def test_bad_cells_are_named(tmp_path, header, row, field, said):
    """What is wrong is said with the file, the row, the line and the column."""
    path = written(tmp_path, f"{header}\n{row}\n")
    with pytest.raises(InputError) as error:
        read_data(path, SCENE)
    assert field in error.value.field and str(path) in error.value.field
    assert said in str(error.value)


def test_dates_and_texts_with_dots_leave_a_german_spreadsheet_german(tmp_path):
    """A date, `Temp.` and a remark are no decimal points: the commas are read; thousands with a point are named."""
    head = "Datum;Temp. (°C);Bemerkung;speed (mm/s);angle (°);outcome\n"
    rows = "12.03.2026;21,5;v. oben;500,5;30;B\n13.03.2026;;ok;200;29,5;S\n"
    found = read_data(written(tmp_path, head + rows), SCENE)
    np.testing.assert_allclose(found.speed, [0.5005, 0.2])
    assert "Columns that are not used: Datum, Temp., Bemerkung." in found.remarks
    with pytest.raises(InputError, match="is not a number") as error:
        read_data(written(tmp_path, f"{head}12.03.2026;21,5;ok;1.500,5;30,1;B\n"), SCENE)
    assert "column speed" in error.value.field
    assert error.value.value == "1.500,5"


@pytest.mark.parametrize(
    ("header", "kind"), [("speed [m/s],Winkel [°]", "angle"), ("v_imp (m/s),angle [deg]", "speed")]
)
def test_the_only_column_in_a_unit_of_speed_or_angle_is_not_passed_over(tmp_path, header, kind):
    """In its place all impacts would have the scene's; without its unit it is another column."""
    scene = SCENE.with_impact(speed=1.0, angle=0.1)
    with pytest.raises(InputError, match=f"no column is the {kind}"):
        read_data(written(tmp_path, f"{header},outcome\n0.5,30,B\n"), scene)
    bare = header.replace(" [°]", "").replace("v_imp (m/s)", "v_imp")
    assert read_data(written(tmp_path, f"{bare},outcome\n0.5,30,B\n"), scene).size == 1


def test_rows_that_are_left_out_are_counted_where_not_all_are_named(tmp_path):
    """Eight are named."""
    text = "speed [m/s],angle [deg],outcome\n0.5,30,B\n" + "0.5,30,\n" * 11
    [remark] = [one for one in read_data(written(tmp_path, text), SCENE).remarks if one.startswith("Left out")]
    assert remark.endswith("row 9 (line 10) and 3 more.")


def test_empty_columns_at_the_right_are_no_columns(tmp_path):
    """A spreadsheet's file, with a byte order mark, semicolons and empty columns at the right, is read."""
    text = "\ufeffspeed [m/s];angle [deg];outcome;;\n0.5;30;Bounce;;\n0.2;30;Stick Rotate Separate;;\n"
    assert read_data(written(tmp_path, text), SCENE).outcome.tolist() == [2, 1]


def test_tables_of_python_are_read_alike(tmp_path):
    """A DataFrame, a mapping and a Dataset give what the file gives."""
    columns = {"speed": [0.5, 0.2], "angle": [0.5, 0.8], "restitution": [0.4, np.nan], "outcome": ["bounce", "stick"]}
    text = "speed [m/s],angle [rad],restitution,outcome\n0.5,0.5,0.4,bounce\n0.2,0.8,,stick\n"
    expected = read_data(written(tmp_path, text), SCENE)
    frame = pd.DataFrame(columns)
    for source in (columns, frame, frame.convert_dtypes(), frame.to_xarray()):
        found = read_data(source, SCENE)
        np.testing.assert_array_equal(found.speed, expected.speed)
        np.testing.assert_array_equal(found.outcome, expected.outcome)
        np.testing.assert_array_equal(found.observed["restitution"][0], expected.observed["restitution"][0])
    with pytest.raises(InputError, match="row 1, column outcome"):
        read_data({"speed": [0.5], "angle": [0.5], "outcome": [True]}, SCENE)  # of which three outcomes?


def test_stokes_numbers_are_speeds_of_the_scene():
    """A Stokes number gives the speed that it has with the row's own viscosity."""
    found = read_data(
        {"stokes": [0.1, 0.1], "angle": [0.5, 0.5], "outcome": ["S", "S"], "liquid.viscosity": [2.0, 4.0]}, SCENE
    )
    np.testing.assert_allclose(found.speed * SCENE.stokes_per_speed, [0.1, 0.2])


def test_a_restitution_beyond_the_energy_is_refused() -> None:
    """e_n above 1/cos(angle) by six standard deviations is more than the impact's energy: the rows are named."""
    rows = {"speed": [1.0, 2.0, 3.0, 4.0], "angle": [0.2, 0.2, 1.4, 0.2], "restitution": [0.8, 3.2, 3.2, 1.05]}
    with pytest.raises(
        InputError, match=r"restitution: 3.2 is more than .* \(row 2\); accepted: at most .* 1.02 there"
    ):
        fit("granulation", rows, "liquid.viscosity")


def test_restitution_below_zero_is_noise():
    """Of a doublet that separates slowly a restitution may be measured below 0, by some standard deviations."""
    columns = {"speed": [0.5], "angle": [0.5], "restitution": [-0.03], "restitution_sd": [0.02], "outcome": ["bounce"]}
    found = read_data(columns, SCENE)
    assert [float(each[0]) for each in found.observed["restitution"]] == [-0.03, 0.02]
    for changes, words in (
        ({"restitution": [-0.2]}, "standard deviations of noise"),
        ({"outcome": [None]}, "which may be a stick's"),
        ({"outcome": ["stick"]}, "contradicts the outcome"),
    ):
        with pytest.raises(InputError, match=words):
            read_data(columns | changes, SCENE)


TABLE = "speed,angle,restitution,outcome\n{}0.4,30,0.5,\n0.5,40,,stick\n"


@pytest.mark.parametrize("row", ["m/s,deg,-,\n", "[m/s],[deg],[-],[-]\n", "m/s,°,,\n"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_units_in_a_row_below_the_names(row: str, encoding: str, tmp_path: Path):
    """As rheometers and spreadsheets write them, in Unicode of either width: what the units in brackets say."""
    file, usual = tmp_path / "rows.csv", tmp_path / "usual.csv"
    file.write_text(TABLE.format(row), encoding=encoding)
    usual.write_text(TABLE.format("").replace("speed,angle", "speed [m/s],angle [deg]"))
    scene = Scene.load("granulation")
    found, same = (read_data(path, scene) for path in (file, usual))
    assert (found.speed == same.speed).all() and (found.angle == same.angle).all()
    assert (found.outcome == same.outcome).all()
    assert found.labels == ("row 1 (line 3)", "row 2 (line 4)")


def test_a_first_row_without_numbers_is_no_row_of_units(tmp_path: Path):
    """The cell "s" is short for a stick."""
    file = tmp_path / "rows.csv"
    file.write_text("restitution,outcome\n-,s\n0.5,bounce\n")
    assert len(read_data(file, Scene.load("granulation-dry-bridge")).speed) == 2
