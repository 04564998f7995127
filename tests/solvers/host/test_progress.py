"""Forecasts and progress of long computations."""

import io
import json
import signal
import subprocess
import sys
from contextlib import redirect_stderr

import numpy as np
import pytest
from wetdoublet.solvers import collide_many, collision_averages, design, fit
from wetdoublet.solvers.commands.bar import AtWork, Bar
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


class TestAtWork:
    """Lines of long work where no bar is seen, by a clock of the test."""

    def test_a_pipe_gets_a_line_at_ten_seconds_and_whenever_the_time_has_doubled(self, capsys):
        clock = Clock()
        work = AtWork(clock)
        with Bar("impacts", clock=clock) as bar:
            for second in range(100):
                bar(second, 1000)
                work.look()
                clock.now += 1.0
        lines = capsys.readouterr().err.splitlines()
        assert [line.partition(":")[0] for line in lines] == [f"at work for {n} s" for n in (10, 20, 40, 80)]
        assert lines[0] == "at work for 10 s: about 16 min more: 10 of 1000 impacts in 10.0 s"

    def test_work_without_counts_is_said_as_well(self, capsys):
        clock = Clock()
        work = AtWork(clock)
        assert work.look() == 10.0
        clock.now = 9.0
        assert work.look() == 1.0
        assert capsys.readouterr().err == ""
        clock.now = 10.0
        assert work.look() == 10.0
        assert capsys.readouterr().err == "at work for 10 s\n"

    def test_uncounted_items_are_named(self, capsys):
        clock = Clock()
        work = AtWork(clock)
        with Bar("scenes", clock=clock) as bar:
            bar(0, 500)
            clock.now = 10.0
            work.look()
        assert capsys.readouterr().err == "at work for 10 s: 0 of 500 scenes\n"

    def test_a_terminal_has_its_bar(self):
        clock = Clock()
        with redirect_stderr(Terminal()) as terminal, Bar("impacts", clock=clock) as bar:
            work = AtWork(clock)
            for done in (0, 10, 20):
                bar(done, 100)
                work.look()
                clock.now += 10.0
        assert "at work" not in terminal.getvalue()

    @pytest.mark.slow
    def test_a_command_that_is_piped_says_how_long_it_will_be_at_work(self, tmp_path):
        """Ten seconds after its start, though it writes nothing else; it is interrupted then."""
        command = [sys.executable, "-m", "wetdoublet", "verify", "--stress", "5000", "--out", str(tmp_path)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            line = process.stderr.readline()
            process.send_signal(signal.SIGINT)
            process.communicate()
        assert line.startswith("at work for 10 s: ") and "of 5000 scenes" in line


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


@pytest.mark.slow
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


@pytest.mark.slow
def test_the_result_does_not_depend_on_progress():
    plain, told = (design("granulation", "liquid.viscosity", WINDOW, 2, progress=p) for p in (None, lambda *_: None))
    assert plain.to_dict() == told.to_dict()


@pytest.mark.slow
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
