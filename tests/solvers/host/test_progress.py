"""Progress of long computations."""

import io
import threading
from contextlib import redirect_stderr

import numpy as np
import pytest
from wetdoublet.solvers import collide_many, collision_averages, fit
from wetdoublet.solvers.commands.bar import AtWork, Bar
from wetdoublet.solvers.host.remarks import say_after

SPEEDS = [0.3, 0.8, 1.2, 1.6, 1.9, 2.2, 2.5, 3.0]
DATA = {"speed": SPEEDS, "angle": [0.0] * 8, "outcome": ["stick"] * 5 + ["bounce"] * 3}


class Clock:
    """A clock that a test sets."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


class Terminal(io.StringIO):
    """A terminal that keeps what is written."""

    def isatty(self) -> bool:
        return True


def test_a_bar_is_seen_on_a_terminal_only(capsys):
    """In a pipe there is none."""
    with redirect_stderr(Terminal()) as terminal, Bar("impacts") as bar:
        bar(25, 100)
    assert "25/100" in terminal.getvalue()
    with Bar("impacts") as bar:
        bar(50, 100)
    assert capsys.readouterr() == ("", "")


def test_a_wait_is_explained_on_a_terminal():
    """What takes longer says why, there alone; what does not says nothing."""
    for stream, patience, said in ((Terminal(), 0.0, "a\n"), (io.StringIO(), 0.0, ""), (Terminal(), 1e3, "")):
        with redirect_stderr(stream), say_after(patience, said.strip() or "b"):
            for each in threading.enumerate():
                if isinstance(each, threading.Timer) and each.interval == 0:
                    each.join()
        assert stream.getvalue() == said


@pytest.mark.usefixtures("optimized")
@pytest.mark.slow
def test_progress_never_falls_and_ends_at_the_total():
    """Of averages; that of fits and designs is held by their tests."""
    calls = []
    collision_averages("granulation", speeds="1 m/s", tolerance=1e-3, progress=lambda *call: calls.append(call))
    done = [each for each, _ in calls]
    assert done[0] == 0
    assert done == sorted(done)
    assert all(each <= total for each, total in calls)
    assert calls[-1][0] == calls[-1][1] > 0


@pytest.mark.usefixtures("optimized")
@pytest.mark.slow
def test_an_interrupted_fit_says_what_is_most_likely_so_far():
    def interrupt(done: int, total: int) -> None:
        if done > 0.6 * total:  # an estimate, which the last call jumps to
            raise KeyboardInterrupt

    angle = np.full(8, 0.2)
    outcome = collide_many("granulation", speed=np.array(SPEEDS), angle=angle)["outcome"].values
    words = np.array(["stick", "stick-rotate-separate", "bounce"])[outcome]
    seen = {"speed": SPEEDS, "angle": angle, "outcome": words}
    with pytest.raises(KeyboardInterrupt, match=r"most likely are liquid\.viscosity = \S+ Pa s"):
        fit("granulation", seen, "liquid.viscosity", progress=interrupt)


@pytest.mark.parametrize("counted_too", [False, True])
def test_a_line_in_a_pipe_says_what_is_waited_for(counted_too):
    """While a kernel is compiled it names that, with or without a count; before and behind it does not."""
    clock, pipe = Clock(), io.StringIO()
    at_work = AtWork(clock)

    def lines(now):
        clock.now = now
        with redirect_stderr(pipe):
            at_work.look()
        return pipe.getvalue().splitlines()[-1]

    with Bar("impacts") as bar:
        bar.shown = None
        Bar.latest = bar if counted_too else None
        before = ": 0 of 0 impacts" if counted_too else ""
        assert lines(10.0) == f"at work for 10 s{before}"
        with say_after(60, "a kernel is compiled"):
            assert lines(20.0) == "at work for 20 s: a kernel is compiled"
        assert lines(40.0) == f"at work for 40 s{before}"
