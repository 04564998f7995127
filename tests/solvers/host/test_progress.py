"""Forecasts and progress of long computations."""

import io
import json
from contextlib import redirect_stderr

import numpy as np
import pytest
from wetdoublet.solvers import collide_many, collision_averages, design, fit
from wetdoublet.solvers.commands.bar import Bar
from wetdoublet.solvers.commands.cli import main
from wetdoublet.solvers.host.progress import Estimated, duration, forecast

SPEEDS = [0.3, 0.8, 1.2, 1.6, 1.9, 2.2, 2.5, 3.0]
DATA = {"speed": SPEEDS, "angle": [0.0] * 8, "outcome": ["stick"] * 5 + ["bounce"] * 3}
WINDOW = {"stokes": (0.05, 0.3), "angle": 0.0}


class Clock:
    """A clock that a test sets."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def counted(clock, counts, **options):
    """Show counts on a bar, each ten seconds after the one before."""
    with Bar("impacts", clock=clock, **options) as bar:
        for count in counts:
            bar(count, 100)
            clock.now += 10.0


class Terminal(io.StringIO):
    """A terminal that keeps what is written."""

    def isatty(self) -> bool:
        return True


class TestForecast:
    """The sentence, from counts and seconds."""

    def test_the_rest_takes_as_long_per_item_as_the_sample(self):
        assert forecast(10, 50, 4.0, "impacts") == "about 16 s more: 10 of 50 impacts in 4.0 s"

    def test_items_of_an_earlier_run_are_not_in_the_sample(self):
        assert forecast(30, 50, 4.0, "impacts", before=20) == "about 8 s more: 10 of 30 impacts in 4.0 s"

    @pytest.mark.parametrize(
        ("done", "seconds"), [(0, 9.0), (10, 0.1), (49, 9.0)], ids=["none done", "too short", "nearly done"]
    )
    def test_there_is_none_without_a_sample_or_need(self, done, seconds):
        assert forecast(done, 50, seconds, "impacts") is None

    def test_an_estimated_total_gives_a_range(self):
        line = forecast(10, 50, 4.0, "impacts", factor=2.0)
        assert line == "about 16 s more (8 s to 32 s): 10 of about 50 impacts in 4.0 s"

    def test_uncounted_work_makes_it_a_lower_bound_and_the_cheaper_way_is_named(self):
        line = forecast(10, 50, 4.0, "impacts", at_least=True, cheaper="fewer take less")
        assert line == "at least 16 s more: 10 of 50 impacts in 4.0 s; fewer take less"

    @pytest.mark.parametrize(("seconds", "text"), [(9.96, "10 s"), (119, "120 s"), (150, "2.5 min"), (7200, "2 h")])
    def test_durations_have_two_digits_and_a_unit(self, seconds, text):
        assert duration(seconds) == text


class TestBar:
    """What a bar writes, by a clock of the test."""

    def test_the_forecast_is_written_once(self):
        with redirect_stderr(Terminal()) as terminal:
            counted(Clock(), [0, 10, 20, 30])
        assert terminal.getvalue().count(" more: ") == 1
        assert "about 90 s more: 10 of 100 impacts in 10.0 s\n" in terminal.getvalue()

    def test_time_before_the_first_item_is_counted_from_the_last_report_without_one(self):
        with redirect_stderr(Terminal()) as terminal:
            counted(Clock(), [0, 0, 0, 50])
        assert "about 10 s more: 50 of 100 impacts in 10.0 s\n" in terminal.getvalue()

    def test_in_a_pipe_there_is_neither_bar_nor_forecast(self, capsys):
        counted(Clock(), [0, 10, 20, 30])
        assert capsys.readouterr() == ("", "")


class TestEstimated:
    """Counts whose total is an estimate."""

    @pytest.mark.parametrize("expected", [3, 100])
    def test_done_rises_to_a_total_that_is_reached_at_the_end(self, expected):
        calls = []
        work = Estimated(lambda *call: calls.append(call), expected)
        for _ in range(10):
            work.add(1.0)
        work.finish()
        done = [each for each, _ in calls]
        assert done == sorted(done)
        assert all(each <= total for each, total in calls)
        assert calls[-1] == (max(expected, 10),) * 2


@pytest.mark.parametrize(
    "compute",
    [
        pytest.param(lambda tell: fit("granulation", DATA, "liquid.viscosity", progress=tell), id="fit"),
        pytest.param(lambda tell: design("granulation", "liquid.viscosity", WINDOW, 2, progress=tell), id="design"),
        pytest.param(
            lambda tell: collision_averages("granulation", speeds="1 m/s", tolerance=1e-3, progress=tell), id="averages"
        ),
    ],
)
def test_progress_never_falls_and_ends_at_the_total(compute):
    calls = []
    compute(lambda *call: calls.append(call))
    done = [each for each, _ in calls]
    assert done[0] == 0
    assert done == sorted(done)
    assert all(each <= total for each, total in calls)
    assert calls[-1][0] == calls[-1][1] > 0


def test_the_result_does_not_depend_on_progress():
    plain, told = (design("granulation", "liquid.viscosity", WINDOW, 2, progress=p) for p in (None, lambda *_: None))
    assert plain.to_dict() == told.to_dict()


def test_json_of_a_fit_is_alone_on_standard_output(tmp_path, capsys):
    rows = [f"{v},0,{o}" for v, o in zip(SPEEDS, DATA["outcome"], strict=True)]
    data = tmp_path / "impacts.csv"
    data.write_text("\n".join(["speed [m/s],angle [deg],outcome", *rows]) + "\n")
    with pytest.raises(SystemExit):
        main(["fit", "granulation", str(data), "--free", "liquid.viscosity", "--json"])
    estimates = json.loads(capsys.readouterr().out)["estimates"]
    found = fit("granulation", DATA, "liquid.viscosity")
    assert estimates["liquid.viscosity"]["value"] == found.estimates["liquid.viscosity"].value


def test_an_interrupted_fit_says_what_is_most_likely_so_far():
    def interrupt(done: int, total: int) -> None:
        if done > 0.9 * total:
            raise KeyboardInterrupt

    angle = np.full(8, 0.2)
    outcome = collide_many("granulation", speed=np.array(SPEEDS), angle=angle)["outcome"].values
    words = np.array(["stick", "stick-rotate-separate", "bounce"])[outcome]
    seen = {"speed": SPEEDS, "angle": angle, "outcome": words}
    with pytest.raises(KeyboardInterrupt, match=r"most likely are liquid\.viscosity = \S+ Pa s"):
        fit("granulation", seen, "liquid.viscosity", progress=interrupt)
