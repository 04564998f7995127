"""Audit of the stick certificates: certified sticks are integrated further without certificates and must not escape."""

import math
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np

from ..certificates import NoCertificate
from ..engines.casadi.locate import EventLocator, EventSequence, PhaseRun
from ..errors import ComputationError, WetDoubletError
from ..model.dimensionless import nondimensionalise
from ..model.model import load, select_model
from ..model.phases import Phase
from ..scene.scene import Scene
from .report import Finding
from .sample import WHOLE, place, stokes_of

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
        with suppress(_Chatters):
            self._follow()
        return self.path

    def _next(self, step: PhaseRun, phase: Phase | None = None) -> None:
        super()._next(step, phase)
        if len(self.path.steps) > _PHASES:
            raise _Chatters


def stick_audit(
    scene: Scene,
    angles: tuple[float, ...] | None = None,
    impacts: int = WHOLE.audited,
    locator: type[EventLocator] = EventLocator,
) -> Iterator[Finding]:
    """Finding of the audit on a sample of impacts: counts, and the check that no certified stick escapes.

    Arguments:
        angles: angles of the sample, rad; None for 0 to STEEPEST degrees.
        impacts: number of impacts; a quarter of it if angles are given.
        locator: locator whose certificate is audited.
    """
    draw, begun = np.random.default_rng(_SEED), time.process_time()
    count = impacts if angles is None else impacts // 4
    integrated = sticks = proved = settled = cut = 0  # settled: without a theorem; cut: met a cut-off when continued
    unfinished: list[str] = []
    escaped: list[str] = []
    for _ in range(count):
        stokes = stokes_of(scene) * 10 ** draw.uniform(*DECADES)
        angle = float(math.radians(draw.uniform(0, STEEPEST)) if angles is None else draw.choice(angles))
        if time.process_time() - begun > SECONDS:
            continue
        integrated += 1
        try:
            n = nondimensionalise(scene, scene.speed_of(stokes), angle)
            start = load(select_model(scene, n.oblique)), n.groups, _RTOL
            path = locator(*start, machine_code=count >= _WORTH).run()
        except WetDoubletError:
            continue  # the scene has no certificate
        sticks += path.outcome == "stick"
        within_a_phase = bool(path.steps) and path.steps[-1].event is None
        if path.outcome != "stick" or not (path.certified or within_a_phase):
            continue
        proved, settled = proved + path.certified, settled + (not path.certified)
        further = WithoutCertificate(*start, machine_code=count >= _WORTH)
        try:
            on = further.on(path.time + LONG)
        except ComputationError as failure:
            unfinished.append(f"{place(stokes, angle)}: {failure.message}")
            continue
        if on.separated:
            escaped.append(f"{place(stokes, angle)}, certified at {path.time:.3g}, apart at {on.time:.3g} x0/v0")
        cut += bool(on.steps) and on.steps[-1].event in ("half_turn", "unwinding") and on.time < further.deadline
    tried = proved + settled
    statement = (
        f"every stick that is certified, of {integrated} seeded impacts (St over {DECADES[1] - DECADES[0]:.0f} "
        f"decades around the scene's own, 0 to {STEEPEST:.0f} deg), still sticks when continued without the certificate"
    )
    kind = "sticks by a level that is no theorem" if settled else "certified sticks"
    figure = f"{len(escaped)} of {tried} {kind} escape" if tried else "none is certified"
    counts = f"  {integrated} impacts, {sticks} sticks, {proved} certified"
    about = [f"{counts}; each continued for {LONG:.0e} x0/v0 ({cut} met a cut-off first)" if tried else counts]
    about += [f"  escapes: {text}" for text in escaped[:3]]
    about += [f"  not integrated to the end: {text}" for text in unfinished[:3]]
    if integrated < count:
        about.append(f"  {count - integrated} more impacts were left out for lack of time")
    ok = not escaped and len(unfinished) <= tried // 10 if tried else None
    where = escaped[0] if escaped else ""
    yield Finding("", "stick certificate", statement, figure, "", ok, where, tuple(about))
