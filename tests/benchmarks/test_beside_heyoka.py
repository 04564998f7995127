"""What does not count is left out of a time. No time is asserted."""

from __future__ import annotations

import time
from typing import Any

import pytest
from wetdoublet.solvers import Scene

from .measured.answers import Answer, Impact
from .measured.peers.bulk import Bulk, Partly
from .measured.peers.engines import Engine
from .measured.peers.heyoka_callbacks import Inside, around
from .measured.reference import Reference
from .measured.tasks import Task
from .measured.work import work

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
