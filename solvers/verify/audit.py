"""Audit of the stick certificates: certified sticks are integrated further without certificates and must not escape."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ..certificates import NoCertificate
from ..engines.casadi.locate import EventLocator, EventSequence
from ..errors import ComputationError, WetDoubletError
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.model import load, select_model
from ..model.phases import Phase
from ..scene.scene import Scene
from .report import Finding
from .sample import WHOLE, own_stokes, place

_SEED = 20120821
DECADES = (-1.5, 1.5)  # relative to the scene's Stokes number
STEEPEST = 85.0  # deg
LONG = 1e4  # x0/v0; time of integration beyond the certified end
_RTOL = 1e-8
_PHASES = 300  # most phases of a trajectory that chatters
_WORTH = 100  # impacts from which integrators compiled to C pay, in a first run as well
SECONDS = 6.0  # s of CPU time; remaining impacts are counted but not integrated


class _Chatters(Exception):
    """The trajectory has more phases than are worth following."""


class WithoutCertificate(EventLocator):
    """A locator without certificates: a trajectory ends at a final event or at a given time."""

    def on(self, until: float) -> EventSequence:
        """Integrate until time `until` (x0/v0); the path is `separated` if the doublet escaped before."""
        self.proof, self.watch, self.deadline = NoCertificate(), replace(self.watch, certificate=None), until
        try:
            return self._followed()
        except _Chatters:
            return self.path

    def _next(self, step: object, phase: Phase) -> None:
        super()._next(step, phase)  # type: ignore[arg-type]  # a Step
        if len(self.path.steps) > _PHASES:
            raise _Chatters


@dataclass
class Audit:
    """Counts of the outcomes of a sample of impacts."""

    impacts: int = 0
    sticks: int = 0
    proved: int = 0  # certified by a theorem
    settled: int = 0  # ended early without a theorem (surface lever arm)
    cut: int = 0  # reached a cut-off of the experiment when continued
    unfinished: list[str] = field(default_factory=list)  # could not be integrated further
    escaped: list[str] = field(default_factory=list)
    left: int = 0


def stick_audit(
    group: str,
    scene: Scene,
    angles: tuple[float, ...] | None = None,
    impacts: int = WHOLE.audited,
    locator: type[EventLocator] = EventLocator,
) -> Iterator[Finding]:
    """Findings of the audit: counts, and the check that no certified stick escapes.

    Arguments:
        angles: angles of the sample, rad; None for 0 to STEEPEST degrees.
        impacts: number of impacts; a quarter of it if angles are given.
        locator: locator whose certificate is audited.
    """
    found = audit(scene, angles, impacts, locator)
    statement = (
        f"every stick that is certified, of {found.impacts} seeded impacts (St over {DECADES[1] - DECADES[0]:.0f} "
        f"decades around the scene's own, 0 to {STEEPEST:.0f} deg), still sticks when continued without the certificate"
    )
    tried = found.proved + found.settled
    kind = "sticks by a level that is no theorem" if found.settled else "certified sticks"
    figure = f"{len(found.escaped)} of {tried} {kind} escape" if tried else "none is certified"
    counts = f"  {found.impacts} impacts, {found.sticks} sticks, {found.proved} certified"
    about = [f"{counts}; each continued for {LONG:.0e} x0/v0 ({found.cut} met a cut-off first)" if tried else counts]
    about += [f"  escapes: {text}" for text in found.escaped[:3]]
    about += [f"  not integrated to the end: {text}" for text in found.unfinished[:3]]
    if found.left:
        about.append(f"  {found.left} more impacts were left out for lack of time")
    where = found.escaped[0] if found.escaped else ""
    ok = not found.escaped and len(found.unfinished) <= tried // 10 if tried else None
    yield Finding(group, "stick certificate", statement, figure, "", ok, where, tuple(about))


def audit(
    scene: Scene,
    angles: tuple[float, ...] | None = None,
    impacts: int = WHOLE.audited,
    locator: type[EventLocator] = EventLocator,
) -> Audit:
    """Sample impacts, locate each with its certificate, and continue the certified ones without it."""
    draw = np.random.default_rng(_SEED)
    found, begun = Audit(), time.process_time()
    count = impacts if angles is None else impacts // 4
    compiled = count >= _WORTH
    for _ in range(count):
        stokes = own_stokes(scene) * 10 ** draw.uniform(*DECADES)
        angle = float(math.radians(draw.uniform(0, STEEPEST)) if angles is None else draw.choice(angles))
        if time.process_time() - begun > SECONDS:
            found.left += 1
            continue
        found.impacts += 1
        try:
            n = nondimensionalise(scene, scene.speed_of(stokes), angle)
            path = locator(load(select_model(scene, n.oblique)), n.groups, _RTOL, machine_code=compiled).run()
        except WetDoubletError:
            continue  # the scene has no certificate
        found.sticks += path.outcome == "stick"
        if path.outcome == "stick" and (path.certified or _ended_early(path)):
            _without_proof(found, scene, n, path, place(stokes, angle), compiled)
    return found


def _ended_early(path: EventSequence) -> bool:
    """True if the trajectory stopped within a phase, by a certificate or a criterion without proof."""
    return bool(path.steps) and path.steps[-1].event is None


def _without_proof(
    found: Audit, scene: Scene, n: DimensionlessGroups, path: EventSequence, where: str, compiled: bool
) -> None:
    found.proved += path.certified
    found.settled += not path.certified
    locator = WithoutCertificate(load(select_model(scene, n.oblique)), n.groups, _RTOL, machine_code=compiled)
    try:
        on = locator.on(path.time + LONG)
    except ComputationError as failure:
        found.unfinished.append(f"{where}: {failure.message}")
        return
    if on.separated:
        found.escaped.append(f"{where}, certified at {path.time:.3g}, apart at {on.time:.3g} x0/v0")
    elif on.steps and on.steps[-1].event in ("half_turn", "unwinding") and on.time < locator.deadline:
        found.cut += 1
