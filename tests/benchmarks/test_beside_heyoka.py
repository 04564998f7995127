"""What does not count is left out, and a kernel made by hand is called as its folder says. No time is asserted."""

from __future__ import annotations

import platform
import shutil
import time
from pathlib import Path
from typing import Any

import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.verify.stress.answers import Answer, Impact

from .measured.peers.bulk import Bulk, Partly
from .measured.peers.by_hand import best_order, by_hand
from .measured.peers.engines import Engine
from .measured.peers.heyoka_callbacks import Inside, around
from .measured.reference import Reference
from .measured.tasks import Task
from .measured.work import Point, Timed, work

TRUTH = Reference(Impact(2.0, 1.0), "bounce", 0.5, False, 1e-13, {"DOP853": 0.5})


def test_what_does_not_count_is_left_out_of_the_time() -> None:
    """A call of which an hour is left out has taken less than nothing."""

    def prepare(_: Scene, impacts: Any, __: float) -> Bulk:
        return Bulk(Partly(lambda: None, lambda: 3600.0), lambda _: [Answer("bounce", 0.5)] * len(impacts))

    (point,) = work(Task("pendulum", 1, (1.0, 3.0), 80.0), [TRUTH], [Engine("odd", many=prepare)], [1e-6], 2, sets=2)
    assert point.summary()["cpu_mean"] == pytest.approx(-1800.0, abs=10.0)


def test_callbacks_are_counted_and_what_they_wait_is_not_left_out() -> None:
    """A watched callback passes arguments and value on; one that sleeps is counted, but not the time it sleeps."""
    inside = Inside()
    assert inside.watched(lambda a, b: a - b)(5, 3) == 2
    assert inside.calls == 1
    inside.watched(time.sleep)(0.05)
    assert inside.calls == 2
    assert 0.0 < inside.seconds < 0.05
    inside.reset()
    assert (inside.calls, inside.seconds) == (0, 0.0)


def test_the_way_to_python_is_left_out_too() -> None:
    """Each call takes more than the clock notes within it."""
    pytest.importorskip("heyoka")
    assert around() > 0.0
    assert Inside(10, 1.0).left_out() == 1.0 + 10 * around()


SOURCE = """
extern "C" int run(int n, const double *P, const double *y, const double *L, const double *film, const int *reversed,
                   int *out, double *en, double tol, long *stats, int *cnt, int mode, double *yend)
{
  for (int i = 0; i < n; i++) {
    out[i] = mode ? -1 : i % 3;
    en[i] = P[14*i]+y[3*i+2]+L[i]+film[i]+reversed[i]+tol+N;
  }
  return 0;
}
"""
MODEL = """
class Case:
    def __init__(self, preset, stokes, angle):
        self.P, self.y0, self.q = [stokes]+13*[0.0], [0.0, -1.0, angle/16, 0.0], {"L": 100.0}
        self.film0, self.rev0 = 1.0, True
"""


@pytest.mark.skipif(platform.machine() != "x86_64" or not shutil.which("g++"), reason="made by hand for x86-64 by g++")
def test_a_kernel_made_by_hand_is_called_as_its_folder_says(tmp_path: Path) -> None:
    """Outcomes in the order of the automaton, e_n of those that separate; all arguments arrive in their places."""
    (tmp_path / "lanes2.cpp").write_text(SOURCE)
    (tmp_path / "model.py").write_text(MODEL)
    engine = by_hand(tmp_path)[0]
    assert engine.many is not None
    impacts = [Impact(stokes, 0.25) for stokes in (1000.0, 2000.0, 3000.0)]
    found = engine.many(Scene.load("granulation"), impacts, 0.5)()
    rest = 0.25 + 100.0 + 1.0 + 1.0 + 0.5 + 9
    assert found == [
        Answer("stick", 0.0),
        Answer("stick-rotate-separate", 2000.0 + rest),
        Answer("bounce", 3000.0 + rest),
    ]


def test_of_a_kernel_made_by_hand_the_cheapest_order_is_kept() -> None:
    """Of those whose error is small enough; other engines stay."""

    def point(engine: str, cpu: float, error: float) -> Point:
        return Point("granulation", engine, 1e-8, [Timed(cpu, cpu, 1, "bounce", 0.5 + error)], [TRUTH])

    points = [point("by hand, order 9", 1.0, 1e-7), point("by hand, order 10", 3.0, 0.0), point("taylor", 4.0, 0.0)]
    kept = best_order([*points, point("by hand, order 12", 2.0, 1e-9)])
    assert [each.engine for each in kept] == ["taylor", "by hand, order 12"]
