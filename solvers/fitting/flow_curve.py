"""The law of a liquid from its flow curve: Newtonian, power law, Cross, Carreau or Herschel and Bulkley.

Logarithms of viscosities are fitted by least squares: the scatter is a part of the value, of unknown size. The law has
the fewest parameters among those whose information criterion of Bayes is at most 2 above the least; intervals are those
of the profile of the likelihood.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..formatting.tables import aligned
from ..host.pictures import Drawn
from ..scene.items import item
from ..scene.origin import Record, Result
from ..scene.schema import FIELDS
from .rheometer import flow_curve_of

_CONFIDENCE = 0.95
_WORTH = 2.0  # difference of criteria that is worth a mention (Kass & Raftery, J. Am. Stat. Assoc. 90, 773, 1995)
_RAMP, _HYSTERESIS = 3, 0.05  # least points of a ramp; difference of logarithms between two that is worth a mention
_FARTHEST = 12.0  # of the logarithm of a parameter from its estimate: an interval that goes on is open
Curve = Callable[[np.ndarray, Mapping[str, float], float], np.ndarray]


def _constant(rate: np.ndarray, p: Mapping[str, float], _: float) -> np.ndarray:
    return np.full(rate.shape, p["viscosity"])


def _power(rate: np.ndarray, p: Mapping[str, float], reference: float) -> np.ndarray:
    return np.asarray(p["viscosity"] * (rate / reference) ** (p["flow_index"] - 1))


def _plateaus(p: Mapping[str, float], thinning: np.ndarray) -> np.ndarray:
    last = p.get("infinite_shear_viscosity", 0.0)
    return np.asarray(last + (p["viscosity"] - last) * thinning)


def _cross(rate: np.ndarray, p: Mapping[str, float], _: float) -> np.ndarray:
    return _plateaus(p, 1 / (1 + (p["relaxation_time"] * rate) ** (1 - p["flow_index"])))


def _carreau(rate: np.ndarray, p: Mapping[str, float], _: float) -> np.ndarray:
    return _plateaus(p, (1 + (p["relaxation_time"] * rate) ** 2) ** ((p["flow_index"] - 1) / 2))


def _yielding(rate: np.ndarray, p: Mapping[str, float], reference: float) -> np.ndarray:
    return np.asarray(p["yield_stress"] / rate + _power(rate, p, reference))


_PLATEAUS = ("viscosity", "relaxation_time", "flow_index")
_LAWS: tuple[tuple[str, Curve, tuple[str, ...]], ...] = (
    ("newtonian", _constant, ("viscosity",)),
    ("power-law", _power, ("viscosity", "flow_index")),
    ("cross", _cross, _PLATEAUS),
    ("cross", _cross, (*_PLATEAUS, "infinite_shear_viscosity")),
    ("carreau", _carreau, _PLATEAUS),
    ("carreau", _carreau, (*_PLATEAUS, "infinite_shear_viscosity")),
    ("herschel-bulkley", _yielding, ("viscosity", "yield_stress", "flow_index")),
)
_MOST = {"cross": 1.0, "carreau": 1.0}  # of the flow index


class Parameter(Record):
    """An entry of `[liquid]`, SI, with its 95 % interval; None for an end that the curve does not determine."""

    value: float
    low: float | None
    high: float | None


class FlowCurve(Result, Drawn):
    """A law fitted to a flow curve."""

    _picture = "fitting.plot_flow_curve.draw"
    _keys = "law parameters criteria scatter points=rate.size rates reference_rate entries remarks"

    law: str = item("as `liquid.law`")
    parameters: Mapping[str, Parameter] = item("by entry of `[liquid]`")
    criteria: Mapping[str, float] = item("information criterion of every law less the least")
    scatter: float = item("standard deviation of the viscosity, a part of it")
    reference_rate: float = item("of `viscosity` where the law has none of its own", "1/s")
    rate: np.ndarray = item("shear rates of the curve, ascending", "1/s", repr=False)
    viscosity: np.ndarray = item("viscosities of the curve", "Pa s", repr=False)
    remarks: tuple[str, ...] = item(
        "what to know of the curve: a difference of its ramps, laws for which it has too few points", default=()
    )

    def __call__(self, rate: np.ndarray) -> np.ndarray:
        """The viscosity by the law, Pa s."""
        values = {name: parameter.value for name, parameter in self.parameters.items()}
        return next(curve for law, curve, _ in _LAWS if law == self.law)(np.asarray(rate), values, self.reference_rate)

    @property
    def rates(self) -> tuple[float, float]:
        """Lowest and highest shear rate, 1/s."""
        return float(self.rate[0]), float(self.rate[-1])

    @property
    def entries(self) -> dict[str, str | float]:
        """The entries of a scene."""
        result: dict[str, str | float] = {"liquid.law": self.law}
        for name, parameter in self.parameters.items():
            unit = FIELDS[f"liquid.{name}"].unit
            result[f"liquid.{name}"] = f"{parameter.value:.6g} {unit}" if unit else float(f"{parameter.value:.6g}")
        if self.law in ("power-law", "herschel-bulkley"):
            result["liquid.reference_rate"] = f"{self.reference_rate:.6g} 1/s"
            result["liquid.plateau_rate"] = f"{self.rate[0]:.6g} 1/s"
        return result | {"liquid.measured_to": f"{self.rate[-1]:.6g} 1/s"}

    def to_toml(self) -> str:
        """The table `[liquid]` of a scene, without the film; intervals are comments."""
        lines = ["[liquid]"]
        for name, value in self.entries.items():
            key = name.partition(".")[2]
            text = f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value!r}"
            lines.append(text + (f"  # {self._interval(key)}" if key in self.parameters else ""))
        return "\n".join(lines)

    def _interval(self, name: str) -> str:
        parameter = self.parameters[name]
        ends = ["open" if end is None else f"{end:.4g}" for end in (parameter.low, parameter.high)]
        return f"95 %: {ends[0]} to {ends[1]}"

    def __str__(self) -> str:
        """The table to paste, and how the laws compare."""
        span = f"{self.rate[0]:.4g} to {self.rate[-1]:.4g} 1/s"
        lines = [f"# {len(self.rate)} points from {span}, scatter {self.scatter:.2%}; beyond {span} the law is a guess"]
        rows = [(f"# {law}", f"{above:.4g}") for law, above in sorted(self.criteria.items(), key=lambda item: item[1])]
        return "\n".join(
            [
                *lines,
                *(f"# note: {remark}" for remark in self.remarks),
                f"# information criterion less the least (up to {_WORTH:g}, fewer parameters count):",
                *aligned(rows),
                "",
                self.to_toml(),
            ]
        )


def flow_curve(source: str | Path | tuple[Any, Any]) -> FlowCurve:
    """Fit the laws to a flow curve and take the best.

    Arguments:
        source: a rheometer's file, or shear rates (1/s) and viscosities (Pa s).

    Raises:
        InputError: no such file or columns, or fewer than three rates.

    Example:
        >>> from wetdoublet.solvers import flow_curve
        >>> found = flow_curve(([1, 10, 100, 1000], [5.0, 4.0, 3.2, 2.56]))
        >>> found.law, round(found.parameters["flow_index"].value, 4)
        ('power-law', 0.9031)
    """
    if not isinstance(source, (tuple, str, Path)):
        accepted = "a file, or a tuple of shear rates and viscosities, SI"
        raise InputError("source", type(source).__name__, accepted, "is neither")
    rate, viscosity = source if isinstance(source, tuple) else flow_curve_of(source)
    rate, viscosity = np.asarray(rate, float), np.asarray(viscosity, float)
    if rate.shape != viscosity.shape or rate.ndim != 1 or len(set(rate.tolist())) < 3:
        raise InputError("CURVE.csv", rate.size, "three rates at least, each with its viscosity", "is no flow curve")
    for name, values in (("rate", rate), ("viscosity", viscosity)):
        wrong = values[~((values > 0) & np.isfinite(values))]
        if wrong.size:
            raise InputError(f"CURVE.csv, {name}", float(wrong[0]), "positive numbers", "is none")
    ramps = _ramps(rate, viscosity)
    order = np.argsort(rate, kind="stable")
    rate, viscosity = rate[order], viscosity[order]
    fits = [_Fit(law, curve, names, rate, viscosity) for law, curve, names in _LAWS if len(names) + 1 < len(rate)]
    least = min(fit.criterion for fit in fits)
    near = [fit for fit in fits if fit.criterion - least <= _WORTH]
    best = min(near, key=lambda fit: (len(fit.names), fit.criterion))
    criteria: dict[str, float] = {}
    for fit in fits:
        above = fit.criterion - least
        criteria[fit.law] = min(above, criteria.get(fit.law, math.inf))
    scatter = math.sqrt(2 * best.cost / (len(rate) - len(best.names)))
    untried = ", ".join(dict.fromkeys(law for law, _, names in _LAWS if len(names) + 1 >= len(rate)))
    few = (f"{len(rate)} points are too few for all parameters of {untried}",) if untried else ()
    remarks = (*few, *ramps)
    return FlowCurve(best.law, best.parameters(), criteria, scatter, best.reference, rate, viscosity, remarks)


def _ramps(rate: np.ndarray, viscosity: np.ndarray) -> tuple[str, ...]:
    """A remark if the viscosities of two ramps, up and down or down and up, differ where both have rates."""
    for side in (1, -1):
        turn = int(np.argmax(side * rate))
        first, second = (slice(0, turn + 1), slice(turn, None))
        parts = [(np.log(rate[half]), np.log(viscosity[half])) for half in (first, second)]
        if any(len(x) < _RAMP or not (np.diff(x) * way * side >= 0).all() for (x, _), way in zip(parts, (1, -1))):
            continue
        (x, y), (other_x, other_y) = parts
        x, y, other_x, other_y = x[::side], y[::side], other_x[::-side], other_y[::-side]
        shared = (x >= other_x[0]) & (x <= other_x[-1])
        ratio = math.exp(float(np.mean(np.interp(x[shared], other_x, other_y) - y[shared])))
        if abs(math.log(ratio)) > _HYSTERESIS:
            names = ("up", "down") if side > 0 else ("down", "up")
            return (
                (
                    f"on the way {names[1]} the viscosity is {ratio:.3g} times that on the way {names[0]}: the liquid "
                    "remembers its shear, or has changed; the law is of both ramps together"
                ),
            )
    return ()


class _Fit:
    """A law fitted in the logarithms of its parameters."""

    def __init__(self, law: str, curve: Curve, names: tuple[str, ...], rate: np.ndarray, viscosity: np.ndarray) -> None:
        self.law, self.names, self._curve, self._rate = law, names, curve, rate
        self._logarithms = np.log(viscosity)
        self.reference = float(np.exp(np.log(rate).mean()))
        self._scale = {"viscosity": viscosity.max(), "relaxation_time": 1 / self.reference, "flow_index": 0.5}
        self._scale |= {"infinite_shear_viscosity": viscosity.min() / 3, "yield_stress": (rate * viscosity).min() / 2}
        ends = (self._search(start) for start in self._starts())
        self.cost, self.best = min(ends, key=lambda end: end[0])

    @property
    def criterion(self) -> float:
        points = len(self._rate)
        return points * math.log(max(self.cost, 1e-300)) + (len(self.names) + 1) * math.log(points)

    def _starts(self) -> list[np.ndarray]:
        middle = np.log([self._scale[name] for name in self.names])
        span = (-0.4, 0.0, 0.4) if "relaxation_time" in self.names else (0.0,)
        width = math.log(self._rate.max() / self._rate.min())
        moved = [(time * width, index) for time in span for index in (0.3, 0.7)]
        starts = []
        for time, index in moved:
            given = dict(zip(self.names, middle)) | {"flow_index": math.log(index)}
            given["relaxation_time"] = given.get("relaxation_time", 0.0) + time
            starts.append(np.array([given[name] for name in self.names]))
        return starts

    def _search(self, start: np.ndarray, fixed: int | None = None) -> tuple[float, np.ndarray]:
        """Half the sum of squares and the logarithms, one of them held."""
        from scipy.optimize import least_squares

        free = [k for k in range(len(start)) if k != fixed]
        most = [math.log(_MOST.get(self.law, 2.0)) if name == "flow_index" else math.inf for name in self.names]

        def residuals(some: np.ndarray) -> np.ndarray:
            whole = start.copy()
            whole[free] = some
            values = dict(zip(self.names, np.exp(np.clip(whole, -200, 200)), strict=True))
            with np.errstate(all="ignore"):
                curve = self._curve(self._rate, values, self.reference)
                off: np.ndarray = np.log(curve) - self._logarithms
            return np.where(np.isfinite(off), off, 1e3)

        if not free:
            return float((residuals(np.empty(0)) ** 2).sum() / 2), start
        upper = np.array(most)[free]
        optimum = least_squares(
            residuals, np.minimum(start[free], upper - 1e-9), bounds=(-np.inf, upper), xtol=1e-12, ftol=1e-12
        )
        whole = start.copy()
        whole[free] = optimum.x
        return float(optimum.cost), whole

    def parameters(self) -> dict[str, Parameter]:
        """The estimates with the intervals of their profiles."""
        from scipy.stats import f

        freedom = len(self._rate) - len(self.names)
        most = self.cost * (1 + f.ppf(_CONFIDENCE, 1, freedom) / freedom)
        result = {}
        for k, name in enumerate(self.names):
            low, high = (self._end(k, side, most) for side in (-1, 1))
            result[name] = Parameter(float(np.exp(self.best[k])), low, high)
        return result

    def _end(self, k: int, side: int, most: float) -> float | None:
        """Where the profile of a parameter leaves the interval; None where it does not."""
        from scipy.optimize import brentq

        inside, step, last = self.best, 0.02, 0.0
        limit = math.log(_MOST.get(self.law, 2.0)) - self.best[k] if self.names[k] == "flow_index" else math.inf

        def held(moved: float) -> tuple[float, np.ndarray]:
            start = inside.copy()
            start[k] = self.best[k] + side * moved
            cost, at = self._search(start, k)
            return cost - most, at

        while True:
            if side > 0 and step >= limit:
                return None
            above, at = held(step)
            if above > 0:
                break
            if step > _FARTHEST:
                return None
            inside, last, step = at, step, 2 * step
        return float(np.exp(self.best[k] + side * brentq(lambda moved: held(moved)[0], last, step, xtol=1e-6)))
