"""Audit of the stick certificates: certified sticks are integrated further without certificates and must not escape."""

import math
import time
from collections.abc import Callable, Iterator

import numpy as np

from ..collision.by_kernel import recorded
from ..engines.taylor.record import Recorded
from ..engines.taylor.undecided import SEPARATES
from ..errors import ComputationError, WetDoubletError
from ..model.dimensionless import nondimensionalise
from ..scene.scene import Scene
from .report import Finding
from .sample import WHOLE, place, stokes_of

_SEED = 20120821
DECADES = (-1.5, 1.5)  # relative to the scene's Stokes number
STEEPEST = 85.0  # deg
LONG = 1e4  # x0/v0; time of integration beyond the certified end
_RTOL = 1e-8
SECONDS = 6.0  # s of CPU time; remaining impacts are counted but not integrated


Run = Callable[..., Recorded]
"""A scene, its groups, a tolerance and `until`: a collision by the kernel."""


def stick_audit(
    scene: Scene, angles: tuple[float, ...] | None = None, impacts: int = WHOLE.audited, run: Run = recorded
) -> Iterator[Finding]:
    """Finding of the audit on a sample of impacts: counts, and the check that no certified stick escapes.

    Arguments:
        angles: angles of the sample, rad; None for 0 to STEEPEST degrees.
        impacts: number of impacts; a quarter of it if angles are given.
        run: what computes a collision.
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
            answer = run(n, _RTOL).answers[0]
        except WetDoubletError:
            continue  # failures are reported with the sample
        if answer["outcome"] > 0:
            continue
        certified, end = bool(answer["certified"]), float(answer["time"])
        sticks, proved, settled = sticks + 1, proved + certified, settled + (not certified)
        try:
            on = run(n, _RTOL, until=end + LONG).answers[0]
        except ComputationError as failure:
            where = escaped if SEPARATES in failure.message else unfinished
            where.append(f"{place(stokes, angle)}, decided at {end:.3g} x0/v0: {failure.message}")
            continue
        cut += on["time"] < end + LONG
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
    first = escaped[0] if escaped else ""
    yield Finding("", "stick certificate", statement, figure, "", ok, first, tuple(about))
