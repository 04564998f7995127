"""What a certificate, a ledger and a trajectory cost: switched on one at a time, as ratios to the bare collision."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from wetdoublet.solvers.certificates import NoProof, Proof
from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.engines.casadi import locate as locating
from wetdoublet.solvers.engines.taylor import call as engine
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.collide_many import OUTCOMES, collide_many
from wetdoublet.solvers.model.model import Model
from wetdoublet.solvers.model.phases import Phase
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.settings import RTOL
from wetdoublet.solvers.verify.stress.impacts import Impact, Task

from .reference import Reference

FEATURES = ("certificate", "ledger", "trajectory", "rotation")
TOGETHER = FEATURES[:3]
IN_BULK = {"rosenbrock, compiled": "rosenbrock", "taylor": "taylor"}
_FEW = 100  # collisions in one call that are not compiled for
_MANY = 40  # times the collisions in one call of the kernel, so that what a call costs does not show
_CUT = 3  # stretches of a phase without an event
HORIZON = sum(locating.FIRST_STRETCH * locating.GROWTH**k for k in range(_CUT))  # x0/v0


class TimeCut(NoProof):
    """No certificate: a flight without an event for HORIZON x0/v0 is given up as a stick, unproved."""

    def __init__(self) -> None:
        self._phase: Phase | None = None
        self._asked = 0

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        """Asked where a phase starts, then after every stretch without an event."""
        self._phase, self._asked = phase, self._asked + 1 if phase == self._phase else 0
        return self._asked >= _CUT


@contextmanager
def certificate(on: bool) -> Iterator[None]:
    """Collide with the proofs that hold for a scene, or with none."""
    module: Any = locating  # the flight asks this module for its proof
    kernels: Any = engine
    usual, variant = module.proof_for, kernels.Variant

    def none(_model: Model, _p: np.ndarray, _rtol: float) -> Proof:
        return TimeCut()

    if not on:
        module.proof_for, kernels.Variant = none, partial(variant, certificate=False)
    try:
        yield
    finally:
        module.proof_for, kernels.Variant = usual, variant


@dataclass(frozen=True)
class Cost:
    """Mean CPU time (s) of a collision with some features on, best of the repeats, and its ratio to none."""

    task: str
    engine: str
    outcome: str  # "separating" or "stick"
    collisions: int
    on: tuple[str, ...]
    cpu: float
    ratio: float
    changed: int  # outcomes that the features changed; a cut on time may take a slow separation for a stick


Setup = tuple[str, ...]
_SETUPS: tuple[Setup, ...] = ((), *((name,) for name in TOGETHER), TOGETHER)
_OF_MANY: tuple[Setup, ...] = ((), ("certificate",), ("rotation",))


def costs(task: Task, references: Sequence[Reference], repeats: int = 3) -> list[Cost]:
    """The table of a task at the default tolerance."""
    found = []
    for outcome in ("separating", "stick"):
        impacts = [
            each.impact for each in references if each.counts and (each.outcome == "stick") == (outcome == "stick")
        ]
        if impacts:
            for name in ("cvodes", "rosenbrock", *IN_BULK):
                found += _of_engine(task, name, outcome, impacts, repeats)
    return found


def _of_engine(task: Task, name: str, outcome: str, impacts: list[Impact], repeats: int) -> list[Cost]:
    """One engine's rows; those of many collisions have neither ledger nor trajectory."""
    compiled = name in IN_BULK
    if compiled and compiler() is None:
        return []
    setups = _OF_MANY if compiled else _SETUPS
    copies = (_MANY if name == "taylor" else 1 + _FEW // len(impacts)) if compiled else 1
    runs = {
        on: _in_bulk(task.scene, impacts * copies, name, on) if compiled else _chained(task.scene, impacts, name, on)
        for on in setups
    }
    best = dict.fromkeys(setups, float("inf"))
    changed = dict.fromkeys(setups, 0)
    for turn in range(repeats + 1):  # the first pass builds
        for on, run in runs.items():
            with certificate("certificate" in on):
                start = time.process_time()
                outcomes = run()
                taken = time.process_time() - start
            best[on] = min(best[on], taken) if turn else best[on]
            changed[on] = sum((each == "stick") != (outcome == "stick") for each in outcomes) // copies
    count = len(impacts)
    return [
        Cost(task.preset, name, outcome, count, on, best[on] / (count * copies), best[on] / best[()], changed[on])
        for on in setups
    ]


def _chained(scene: Scene, impacts: list[Impact], plugin: str, on: Setup) -> Callable[[], list[str]]:
    def run() -> list[str]:
        return [
            collide(
                scene,
                stokes=impact.stokes,
                angle=impact.angle,
                rtol=RTOL,
                engine=plugin,
                ledger="ledger" in on,
                trajectory="trajectory" in on,
            ).outcome
            for impact in impacts
        ]

    return run


def _in_bulk(scene: Scene, impacts: list[Impact], name: str, on: Setup) -> Callable[[], list[str]]:
    stokes, angle = (np.array([getattr(each, what) for each in impacts]) for what in ("stokes", "angle"))
    of = ("outcome", "restitution", *(["rotation"] if "rotation" in on else []))

    def run() -> list[str]:
        found = collide_many(scene, stokes=stokes, angle=angle, engine=IN_BULK[name], of=of)["outcome"].values
        return [OUTCOMES[each] if each >= 0 else "" for each in found.tolist()]

    return run
