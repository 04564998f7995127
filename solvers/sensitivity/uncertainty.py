"""Propagation of uncertain inputs to results: first-order standard deviations, and quasi-random sampling."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..errors import InputError
from ..host.arguments import check_function, check_mapping, check_name, check_whole
from ..host.pictures import register
from ..host.progress import Progress
from ..many.arguments import checked_numbers
from ..many.collide_many import collide_many
from ..results import BY_DEFAULT, attributes
from ..scene.held import held_quantity, impact_value
from ..scene.quantities import normal_speed
from ..scene.scene import Scene
from ..scene.schema import DEFAULTS, FIELDS, MEETING, SPEEDS, Field
from .gradients_many import gradients_many
from .parameters import RELATIVE, check_wrt
from .result import Sensitivities

if TYPE_CHECKING:
    import xarray

_MOST = 2**20  # most samples
LEVELS = (0.025, 0.975)
_BLOCK = 64  # values that are computed together where progress is reported


def deviations(scene: Scene, uncertainty: Mapping[str, Any], label: str = "uncertainty") -> dict[str, float]:
    """Standard deviations of parameters, SI: `"5 %"` is a part of the value, text with a unit and numbers are absolute.

    Raises:
        InputError: a name that the scene does not have, or a value that is no uncertainty.
    """
    check_mapping(uncertainty, label, "standard deviations by dotted name")
    check_wrt(scene, tuple(uncertainty), label)
    result = {}
    for name, text in uncertainty.items():
        accepted = f'{name} = "5 %", or a standard deviation with its unit, such as {scene.fields[name].example}'
        if isinstance(text, str) and text.strip().endswith("%"):
            try:
                value = float(text.strip()[:-1]) / 100 * value_of(scene, name)
            except ValueError:
                raise InputError(label, text, accepted, "is no percentage") from None
        else:
            try:
                value = scene.si_number(name, text, f"{label} of {name}")
            except InputError as error:
                raise InputError(error.field, text, accepted, error.problem) from None
        if not 0 < value < np.inf:
            raise InputError(label, text, accepted, f"is no standard deviation of {name}")
        result[name] = value
    return result


def value_of(scene: Scene, name: str) -> float:
    """The value of a parameter, SI, as the scene has it or by default."""
    if name in ("impact.stokes", "impact.speed"):
        return float((scene.stokes if name == "impact.stokes" else scene.speed) or 0.0)
    if name == RELATIVE:
        speed, angle = scene.need_impact()
        return speed / float(normal_speed(1.0, angle))
    return float(scene.entries[name] if name in scene.entries else DEFAULTS[name])


def first_order(gradients: Sensitivities, deviation: Mapping[str, float]) -> dict[str, float | None]:
    """Standard deviation of each result for independent parameters: sqrt(sum (dy/dp sigma_p)^2)."""
    return {
        name: None if gradients.value[name] is None else float(np.sqrt(sum(
            (float(row[p] or 0.0) * sigma) ** 2 for p, sigma in deviation.items()
        )))
        for name, row in gradients.gradient.items()
    }  # fmt: skip


def in_words(gradients: Sensitivities, spread: Mapping[str, float | None]) -> str:
    """The standard deviations as text, one line each."""
    known = {name: value for name, value in gradients.value.items() if value is not None and spread[name] is not None}
    return "\n".join(f"{name} = {value:.6g} ± {spread[name]:.2g} (first order)" for name, value in known.items())


def band(
    scene: Scene | str | FilePath,
    uncertainty: Mapping[str, Any],
    over: str,
    values: Sequence[float],
    *,
    of: str = "restitution",
    samples: int = 64,
    hold: str | None = None,
    rtol: float = 1e-8,
    progress: Progress | None = None,
) -> xarray.Dataset:
    """A result over the Stokes number, speed or angle, with its uncertainty.

    Arguments:
        scene: a Scene with an impact, a path or a preset's name.
        uncertainty: standard deviations by dotted name, as for `deviations`.
        over: "impact.stokes", "impact.speed", "impact.relative_speed" or "impact.angle".
        values: values of `over`, SI and radians.
        of: restitution, tangential_restitution, rotation, contact_time or smallest_gap.
        samples: number of scrambled Sobol points for each value (a power of two); normal distributions, truncated to
            valid values.
        hold: what each impact keeps while other parameters vary, as for `sensitivities`.
        progress: called with (values done, values in all).

    Returns:
        Dataset over `over`: the result, `first_order` (its standard deviation; NaN where no derivative exists, with the
        `reason`), `outcome`, `low` and `high` (2.5 and 97.5 % of the samples) and `sampled` (their standard deviation).

    Raises:
        InputError: an invalid name or value.

    Example:
        >>> from wetdoublet.solvers import band
        >>> found = band("granulation", {"impact.angle": "1 deg"}, "impact.stokes", [0.05], samples=4)
        >>> bool(found.low[0] < found.restitution[0] < found.high[0])
        True
    """
    import xarray as xr

    register()
    over, of = check_name(over, MEETING, "over"), check_name(of, BY_DEFAULT, "of")
    loaded = Scene.load(scene)
    check_mapping(uncertainty, "uncertainty", "standard deviations by dotted name")
    where = checked_numbers(over, values).reshape(-1)
    if not where.size:
        raise InputError("values", values, "one value at least", "is empty")
    check_samples(samples)
    check_function(progress, "progress")
    if progress is not None:
        parts = []
        for k in range(0, where.size, _BLOCK):
            progress(k, where.size)
            block = where[k : k + _BLOCK].tolist()
            parts.append(band(loaded, uncertainty, over, block, of=of, samples=samples, hold=hold, rtol=rtol))
        progress(where.size, where.size)
        return xr.concat(parts, over, combine_attrs="override")
    at = [loaded.with_impact(**{over.partition(".")[2]: value}) for value in where.tolist()]
    impacts = [one.need_impact() for one in at]
    sigma = deviations(at[0], uncertainty)
    relative = {name: str(text).strip().endswith("%") for name, text in uncertainty.items()}
    speeds, angles = np.array(impacts).T
    hold = held_quantity(at[0], hold)
    gradients = gradients_many(at[0], speed=speeds, angle=angles, wrt=tuple(sigma), of=[of], rtol=rtol, hold=hold)
    spreads = np.tile(list(sigma.values()), (len(at), 1))
    if any(relative.values()):
        for k, one in enumerate(at):
            spreads[k] = list(deviations(_held(one, hold), uncertainty).values())
    known = gradients.outcome.values >= 0
    drawn = _sampled(at, impacts, uncertainty, of, samples, rtol, hold)
    low, high = np.nanquantile(drawn, LEVELS, axis=1)
    unit = FIELDS[over].unit or "1"
    return xr.Dataset(
        {
            of: (over, gradients.value.values[0], attributes(of)),
            "first_order": (over, np.sqrt(((gradients.gradient.values[0] * spreads) ** 2).sum(axis=1))),
            "low": (over, low),
            "high": (over, high),
            "sampled": (over, np.nanstd(drawn, axis=1)),
            "reason": (over, np.where(known, "", gradients.reason.values)),
            "outcome": (over, np.array([OUTCOMES[code] if code >= 0 else "" for code in gradients.outcome.values])),
        },
        {over: (over, where, {"units": unit})},
        {
            "uncertainty": ", ".join(f"{name}: {text}" for name, text in uncertainty.items()),
            "samples": samples,
            "hold": hold,
        },
    )


def _sampled(
    at: Sequence[Scene],
    impacts: Sequence[tuple[float, float]],
    uncertainty: Mapping[str, Any],
    of: str,
    samples: int,
    rtol: float,
    hold: str,
) -> np.ndarray:
    """Results of the samples, (values, samples); a stick has restitution 0 and NaN for other results."""
    normal = normal_deviates(samples, len(uncertainty))
    columns: dict[str, list[np.ndarray]] = {name: [] for name in uncertainty}
    speeds, angles = [], []
    for one, (speed, angle) in zip(at, impacts, strict=True):
        held = _held(one, hold)
        varied = {
            name: possible_values(held.fields[name], value_of(held, name), sigma * normal[:, k])
            for k, (name, sigma) in enumerate(deviations(held, uncertainty).items())
        }
        for name, column in varied.items():
            columns[name].append(column)
        moved = varied.get("impact.speed", np.full(samples, speed))
        if "impact.stokes" in varied:
            moved = np.array([held.speed_of(float(stokes)) for stokes in varied["impact.stokes"]])
        angles.append(varied.get("impact.angle", np.full(samples, angle)))
        relative = held.impact.relative_speed
        if RELATIVE in varied or (relative is not None and not {*SPEEDS} & {*varied}):
            moved = normal_speed(varied.get(RELATIVE, np.full(samples, relative)), angles[-1])
        speeds.append(moved)
    vary = {name: at[0].as_given(name, np.concatenate(parts)) for name, parts in columns.items() if name not in MEETING}
    names = ("outcome", "restitution", *(() if of == "restitution" else (of,)))
    meeting: dict[str, Any] = {"speed": np.concatenate(speeds), "angle": np.concatenate(angles)}
    if hold == "stokes":
        meeting["stokes"] = meeting.pop("speed") * at[0].stokes_per_speed
    collisions = collide_many(at[0], **meeting, vary=vary, rtol=rtol, of=names)
    return np.asarray(collisions[of].values, dtype=float).reshape(len(at), samples)


def _held(scene: Scene, hold: str) -> Scene:
    return scene.with_impact(**{hold: impact_value(scene, hold)})


def check_samples(samples: object) -> int:
    """Return the number of points of a Sobol sequence; InputError unless it is a power of two in range."""
    count = check_whole(samples, "samples", 2, _MOST)
    if count & (count - 1):
        raise InputError("samples", samples, "a power of two", "does not fill a Sobol sequence")
    return count


def normal_deviates(samples: int, count: int) -> np.ndarray:
    """Standard normal deviates of a scrambled Sobol sequence with a fixed seed."""
    from scipy.stats import norm, qmc

    return np.asarray(norm.ppf(qmc.Sobol(count, seed=0).random(samples)))


def possible_values(entry: Field, value: float, deviation: np.ndarray) -> np.ndarray:
    """The value plus its deviations; a deviation is halved until the schema accepts it, and is zero at a limit."""
    holds = entry.range.holds
    moved = np.array(deviation)
    for _ in range(60):
        bad = np.array([not holds(float(value + each)) for each in moved])
        if not bad.any():
            return value + moved
        moved[bad] /= 2
    return value + np.where(bad, 0.0, moved)
