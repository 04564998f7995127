"""A kernel made by hand for one preset, in a folder that whoever measures names; it is no part of the project.

The folder holds lanes2.cpp, whose `run` takes parameters, first states, angular momenta, film and reversal of all
collisions, and model.py, whose `Case` computes them. It is compiled for several orders of its series, and each is asked
at every tolerance.
"""

from __future__ import annotations

import ctypes
import math
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from functools import lru_cache, partial
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.verify.stress.answers import Answer, Impact

from ..work import Point
from .bulk import Bulk
from .engines import Engine

PRESET = "granulation"
BY_HAND = "by hand, order "
ORDERS = (9, 10, 12, 14)
BOUND = 1e-8  # of the largest error, at which an order is chosen
FLAGS = ("-O3", "-march=native", "-ffast-math", "-fno-finite-math-only", "-shared", "-fPIC")


def by_hand(folder: Path) -> list[Engine]:
    """An engine an order."""
    missing = "" if shutil.which("g++") else "no g++"
    return [Engine(f"{BY_HAND}{n}", many=partial(_many, folder, n), fast=True, missing=missing) for n in ORDERS]


def best_order(points: Sequence[Point]) -> list[Point]:
    """All points but those of orders that cost more than another at equal error."""
    costs: dict[str, float] = {}
    for each in points:
        found = each.summary()
        good = found["error_largest"] is not None and found["error_largest"] <= BOUND
        if each.engine.startswith(BY_HAND) and good and not found["wrong"] and not found["failed"]:
            costs[each.engine] = min(costs.get(each.engine, math.inf), float(found["cpu_mean"] or 0.0))
    kept = min(costs, key=lambda name: costs[name], default="")
    return [each for each in points if not each.engine.startswith(BY_HAND) or each.engine == kept]


@lru_cache(maxsize=len(ORDERS))
def _library(folder: Path, order: int) -> ctypes.CDLL:
    with tempfile.TemporaryDirectory() as work:
        made = Path(work) / "kernel.so"
        source = str(folder / "lanes2.cpp")
        subprocess.run(["g++", *FLAGS, f"-DN={order}", source, "-o", str(made), "-lmvec", "-lm"], check=True)
        return ctypes.CDLL(str(made))


@lru_cache(maxsize=1)
def _model(folder: Path) -> Any:
    spec = spec_from_file_location("by_hand_model", folder / "model.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _many(folder: Path, order: int, scene: Scene, impacts: Sequence[Impact], rtol: float) -> Bulk:
    """All collisions in one call; their parameters are computed beforehand, for nothing."""
    if scene.name != PRESET:
        raise ComputationError(f"the kernel made by hand knows only {PRESET}")
    cases = [_model(folder).Case(PRESET, each.stokes, each.angle) for each in impacts]
    columns = [
        np.array([each.P for each in cases]),
        np.array([[each.y0[0], each.y0[1], (4 + each.y0[0]) ** 2 * each.y0[2]] for each in cases]),
        np.array([each.q["L"] for each in cases]),
        np.array([each.film0 for each in cases]),
        np.array([int(each.rev0) for each in cases], dtype=np.int32),
    ]
    count = len(cases)
    outcome, restitution = np.zeros(count, dtype=np.int32), np.zeros(count)
    unused = [np.zeros(2, dtype=np.int64), np.zeros(count, dtype=np.int32), np.zeros((count, 3))]
    place = [each.ctypes.data_as(ctypes.c_void_p) for each in (*columns, outcome, restitution, *unused)]
    run, size, tolerance, plain = (
        _library(folder, order).run,
        ctypes.c_int(count),
        ctypes.c_double(rtol),
        ctypes.c_int(0),
    )

    def call() -> None:
        run(size, *place[:7], tolerance, *place[7:9], plain, place[9])

    def read(_: None) -> list[Answer | str]:
        pairs = zip(outcome.tolist(), restitution.tolist(), strict=True)
        return [Answer(OUTCOMES[ended], e_n if ended else 0.0) for ended, e_n in pairs]

    return Bulk(call, read)
