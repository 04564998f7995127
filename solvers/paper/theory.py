"""The paper's scenes with the choices that it leaves open, and where their outcomes change."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from scipy.optimize import bisect, root_scalar

from ...generated.automaton import STICK
from ..boundaries.boundary import boundary
from ..boundaries.changes import Change
from ..collision.collide import collide
from ..engines.settings import RTOL
from ..engines.taylor.build import compile_all
from ..engines.taylor.record import variant_to_record
from ..errors import ComputationError
from ..formatting.document import Table
from ..scene.scene import Scene

BRIDGED, DRY, PENDULUM = "granulation", "granulation-dry-bridge", "pendulum"
PRESSURE = "liquid.glass_transition_pressure"
_SHARED: dict[str, dict[str, Any]] = {
    "preset": {}, "log film": {"model.tangential": "film"}, "glass film-corrected": {"model.glass": "film-corrected"},
}  # fmt: skip
BRIDGE_VARIANTS = _SHARED | {"mikami-log10": {"bridge.law": "mikami-log10"}}
STRING_VARIANTS = _SHARED | {
    **{f"l = {length} m": {"pendulum.length": f"{length} m"} for length in ("0.4", "0.7", "1")},
    "small-angle strings": {"pendulum.law": "small-angle"},
}


def described(scene: Scene) -> str:
    """The choices that the paper leaves open, by the names of a scene file."""
    text = f"tangential {scene.model.tangential}, glass {scene.model.glass}"
    text += "" if scene.bridge is None else f"; bridge {scene.bridge.law}"
    return text if scene.pendulum is None else f"{text}; {scene.pendulum.law} strings, l = {scene.pendulum.length:g} m"


def changes_at(scene: Scene, angle: float) -> tuple[Change, ...]:
    """The changes of outcome at an angle (rad), by the Stokes number; ComputationError where they are not traced."""
    traced = boundary(scene, angle=angle)
    for at, reason in traced.failed:
        raise ComputationError(f"{scene.name} at {degrees(at)}: {reason}")
    return traced.changes[0]


def outcomes(changes: Sequence[Change]) -> tuple[str, ...]:
    """The outcomes between changes, in order of St."""
    return (changes[0].before, *(change.after for change in changes)) if changes else ()


def end_of_sticking(scene: Scene, angle: float = 0.0) -> Change:
    """The change at which sticking ends: its Stokes number is St*, its centrifugal number Ce*."""
    for change in changes_at(scene, angle):
        if change.before == STICK:
            return change
    raise ComputationError("no boundary at which stick ends was found where the paper has one")


def critical_stokes(scene: Scene) -> float:
    """St* of head-on collisions."""
    return end_of_sticking(scene).stokes


def critical_centrifugal(scene: Scene, angle: float) -> float:
    """Ce* of a scene with a bridge."""
    return float(end_of_sticking(scene, angle).centrifugal or math.nan)


def criterion_met(scene: Scene) -> float:
    """The Stokes number from which a rebound criterion is met head-on; at most just above St*, which it decides."""
    escapes = critical_stokes(scene)

    def met(stokes: float) -> float:
        return 1.0 if collide(scene, stokes=stokes, angle=0.0, ledger=False).reversal else -1.0

    return float(bisect(met, 0.8 * escapes, (1 + 1e-6) * escapes, xtol=1e-6 * escapes))


def pressure_for(scene: Scene, stokes: float) -> str:
    """The glass-transition pressure with which St* is `stokes`, in place of the printed one."""

    def apart(log_pressure: float) -> float:
        return math.log(critical_stokes(scene.with_entries({PRESSURE: math.exp(log_pressure)})) / stokes)

    printed = float(scene.entries[PRESSURE])
    start = math.log(printed)
    pressure = math.exp(root_scalar(apart, x0=start, x1=start + 0.05, method="secant", xtol=1e-6).root)
    return f"p_gt = {pressure / 1e6:.3g} MPa in place of the printed {printed / 1e6:.3g} MPa"


def number(value: float | None) -> str:
    """A number with four or more significant digits; a dash for None or NaN."""
    return "-" if value is None or not math.isfinite(value) else f"{value:#.4g}"


def degrees(angle: float) -> str:
    """An angle in rad as degrees, without trailing zeros."""
    return f"{math.degrees(angle):.4g}°"


def under_variants(
    caption: str, preset: str, variants: Mapping[str, dict[str, Any]],
    readings: Mapping[str, Callable[[Scene], str | float]], printed: Sequence[str],
) -> Table:  # fmt: skip
    """What is read of a preset with each choice changed alone, and as the paper prints it; `failed` where it cannot."""

    def cell(read: Callable[[Scene], str | float], scene: Scene) -> str:
        try:
            value = read(scene)
        except ComputationError:
            return "failed"
        return value if isinstance(value, str) else number(value)

    scenes = {name: Scene.load(preset).with_entries(entries) for name, entries in variants.items()}
    compile_all({variant_to_record(scene, True, RTOL, False, trajectory=True, fold=False) for scene in scenes.values()})
    rows = [[name, *(cell(read, scene) for read in readings.values())] for name, scene in scenes.items()]
    return Table(caption, ["variant", *readings], [*rows, ["paper", *printed]])
