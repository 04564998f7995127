"""Propagation of uncertain inputs to results: first-order standard deviations, and quasi-random sampling."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..errors import InputError
from ..host.arguments import check_mapping, check_name, check_whole
from ..host.pictures import register
from ..many.arguments import checked_numbers
from ..many.collide_many import collide_many
from ..results import BY_DEFAULT, attributes
from ..scene.fields import Field
from ..scene.held import held_quantity, impact_value
from ..scene.origin import provenance
from ..scene.scene import Scene
from ..scene.schema import DEFAULTS, FIELDS, MEETING, SPEEDS
from .gradients_many import gradients_many
from .parameters import check_wrt
from .sensitivities import Sensitivities

if TYPE_CHECKING:
    import xarray

_MOST = 2**20  # most samples
LEVELS = (0.025, 0.975)


def deviations(scene: Scene, uncertainty: Mapping[str, Any]) -> dict[str, float]:
    """Standard deviations of parameters, SI: `"5 %"` is a part of the value, text with a unit and numbers are absolute.

    Raises:
        InputError: a name that the scene does not have, or a value that is no uncertainty.
    """
    check_mapping(uncertainty, "uncertainty", "standard deviations by dotted name")
    check_wrt(scene, tuple(uncertainty), "uncertainty")
    result = {}
    for name, text in uncertainty.items():
        accepted = f'{name} = "5 %", or a standard deviation with its unit, such as {scene.fields[name].example}'
        try:
            if isinstance(text, str) and text.strip().endswith("%"):
                value = float(text.strip()[:-1]) / 100 * value_of(scene, name)
            else:
                value = scene.si_number(name, text, f"uncertainty of {name}")
        except InputError as error:
            raise InputError(error.field, text, accepted, error.problem) from None
        except ValueError:
            raise InputError("uncertainty", text, accepted, "is no percentage") from None
        if not 0 < value < np.inf:
            raise InputError("uncertainty", text, accepted, f"is no standard deviation of {name}")
        result[name] = value
    return result


def value_of(scene: Scene, name: str) -> float:
    """The value of a parameter, SI, as the scene has it or by default."""
    if name in MEETING and name != "impact.angle":
        return float(impact_value(scene, name.partition(".")[2]) or 0.0)
    return float(scene.entries[name] if name in scene.entries else DEFAULTS[name])


def drawn(scene: Scene, uncertainty: Mapping[str, Any], normal: np.ndarray) -> dict[str, np.ndarray]:
    """Values of the uncertain entries of a scene, SI, for normal deviates (samples, entries)."""
    return {
        name: possible_values(scene.fields[name], value_of(scene, name), sigma * normal[:, k])
        for k, (name, sigma) in enumerate(deviations(scene, uncertainty).items())
    }


def first_order(gradients: Sensitivities, deviation: Mapping[str, float]) -> dict[str, float | None]:
    """Standard deviation of each result for independent parameters: sqrt(sum (dy/dp sigma_p)^2)."""
    return {
        name: None
        if gradients.value[name] is None
        else float(np.sqrt(sum((float(row[p] or 0.0) * sigma) ** 2 for p, sigma in deviation.items())))
        for name, row in gradients.gradient.items()
    }


def in_words(gradients: Sensitivities, spread: Mapping[str, float | None]) -> str:
    """The standard deviations as text, one line each."""
    results = {name: value for name, value in gradients.value.items() if value is not None and spread[name] is not None}
    return "\n".join(f"{name} = {value:.6g} ± {spread[name]:.2g} (first order)" for name, value in results.items())


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
    at = [loaded.with_impact(**{over.partition(".")[2]: value}) for value in where.tolist()]
    deviations(at[0], uncertainty)
    hold = held_quantity(at[0], hold)
    held = [scene.with_impact(**{hold: impact_value(scene, hold)}) for scene in at]
    speeds, angles = np.array([scene.need_impact() for scene in at]).T
    spreads = np.array([[*deviations(scene, uncertainty).values()] for scene in held])
    gradients = gradients_many(at[0], speed=speeds, angle=angles, wrt=tuple(uncertainty), of=[of], rtol=rtol, hold=hold)
    valid = gradients.outcome.values >= 0
    samples_of = _sampled(held, uncertainty, of, samples, rtol, hold)
    low, high = np.nanquantile(samples_of, LEVELS, axis=1)
    given = ", ".join(f"{name}: {text}" for name, text in uncertainty.items())
    return xr.Dataset(
        {
            of: (over, gradients.value.values[0], attributes(of)),
            "first_order": (over, np.sqrt(((gradients.gradient.values[0] * spreads) ** 2).sum(axis=1))),
            "low": (over, low),
            "high": (over, high),
            "sampled": (over, np.nanstd(samples_of, axis=1)),
            "reason": (over, np.where(valid, "", gradients.reason.values)),
            "outcome": (over, np.where(valid, np.array(OUTCOMES)[gradients.outcome.values], "")),
        },
        {over: (over, where, {"units": FIELDS[over].unit or "1"})},
        provenance(loaded, uncertainty=given, samples=samples, hold=hold),
    )


def _sampled(
    held: Sequence[Scene], uncertainty: Mapping[str, Any], of: str, samples: int, rtol: float, hold: str
) -> np.ndarray:
    """Results of the samples, (scenes, samples); a stick has restitution 0 and NaN for other results."""
    normal, rows = normal_deviates(samples, len(uncertainty)), []
    for scene in held:
        row = drawn(scene, uncertainty, normal)
        scaled = np.full(samples, impact_value(scene, hold))
        for name in [name for name in SPEEDS if name in row]:  # scales what is held
            scaled *= row.pop(name) / value_of(scene, name)
        rows.append({"impact.angle": np.full(samples, scene.angle), **row, f"impact.{hold}": scaled})
    columns = {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}
    meeting: dict[str, Any] = {name.partition(".")[2]: columns.pop(name) for name in MEETING if name in columns}
    vary = {name: held[0].as_given(name, column) for name, column in columns.items()}
    names = ("outcome", "restitution", *(() if of == "restitution" else (of,)))
    collisions = collide_many(held[0], **meeting, vary=vary, rtol=rtol, of=names)
    return np.asarray(collisions[of].values, dtype=float).reshape(len(held), samples)


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
        bad = np.array([not holds(float(value + offset)) for offset in moved])
        if not bad.any():
            return value + moved
        moved[bad] /= 2
    return value + np.where(bad, 0.0, moved)
