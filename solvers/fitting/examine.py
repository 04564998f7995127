"""What is odd in measured impacts, before anything is fitted to them: `check_data()`, which `fit` runs first."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..boundaries.experiment import STEEPEST, Experiment, free_names
from ..boundaries.window import stokes_range
from ..errors import InputError, several
from ..formatting.tables import aligned
from ..scene.held import NAMES
from ..scene.items import item
from ..scene.origin import Record, Result
from ..scene.scene import Scene
from .data_table import read_data
from .likelihood import check_energy
from .measurements import UNKNOWN, Measurements, rows_of

RTOL = 1e-8
_TOLERATED = 0.25  # difference from the scene's restitution at which a row counts as not as observed
_POOR, _GOOD, _BETTER = 0.8, 0.75, 0.3  # shares of agreement: as given, otherwise, and the least gain
_SIGNS = 2.0  # standard deviations of the sign test from which the other kind of speed is asked about
_NOISE = 5.0  # standard deviations by which a restitution must exceed what is possible
_SPEEDS, _MOST = 48, 2000  # speeds of the search for the largest restitution; most rows
_WIDE = 3.0  # standard deviations of speed and angle that are allowed for
_NEAR_SPEED, _NEAR_ANGLE = math.log(1.5), math.radians(10)  # of neighbours
_LEAST = 4  # neighbours of a plane through them
_ODD = 6.0  # scales of the residuals from its neighbours at which a restitution is an outlier
_FACTOR, _PART = 2.0, 0.1  # by which entries are changed to see which impacts depend on them; fractions by a difference
_STICK = OUTCOMES.index(STICK)


class Finding(Record):
    """Something odd: its kind, what names the rows, and a sentence."""

    kind: str
    rows: tuple[str, ...]
    text: str


class Checkup(Result):
    """The result of `check_data`."""

    _keys = "points=data.size agreement differing findings telling notes"

    data: Measurements
    scene: Scene
    findings: tuple[Finding, ...] = item(
        'what is odd; kinds "units", "energy", "restitution", "speed", "outlier", "duplicate", "contradiction"'
    )
    agreement: float = item("share of the impacts that come out as observed with the scene as it is")
    differing: tuple[str, ...] = item("labels of the impacts that do not")
    telling: dict[str, int] = item(
        "entry -> number of impacts that would visibly differ if it were twice or half as large"
    )
    notes: tuple[str, ...] = item("sentences on how the columns were read and what the data lack")

    def __str__(self) -> str:
        lines = [*self.notes, f"As the scene is, {self.agreement:.0%} of the impacts come out as observed."]
        if self.differing and self.agreement >= _POOR:
            lines.append(f"Others do not: {several(self.differing)}.")
        nothing = "Nothing else is odd." if self.differing else "Nothing odd was found."
        lines += ["", *([f"{finding.kind}: {finding.text}" for finding in self.findings] or [nothing])]
        lines += ["", "Impacts that would differ visibly if an entry were half or twice as large (fractions: by 0.1)"]
        lines += aligned([[name, str(count)] for name, count in self.telling.items() if count] or [[""]])
        untold = ", ".join(name for name, count in self.telling.items() if not count)
        lines += [f"none: {untold}. The data cannot tell these."] if untold else []
        return "\n".join(lines)


def check_data(data: Any, scene: Scene | str | Path) -> Checkup:
    """Look through measured impacts before a fit.

    Arguments:
        data: as of `fit`: a CSV file, a DataFrame, a Dataset, a mapping of columns, or Measurements.
        scene: a Scene, a path or a preset's name; the impacts are compared with it as it is.

    Returns:
        Checkup: what is odd, and what the data can and cannot tell.

    Raises:
        InputError: a wrong column or a bad cell, named by row and column.
        ComputationError: no compiled kernel computes the scene's collisions.

    Example:
        >>> from wetdoublet.solvers import check_data
        >>> seen = {"speed": [300.0, 900.0, 3000.0], "angle": [0.0] * 3, "outcome": ["stick", "stick", "bounce"]}
        >>> [one.kind for one in check_data(seen, "granulation").findings]
        ['units']
    """
    loaded = Scene.load(scene)
    table = read_data(data, loaded)
    seen = _predicted(_as_it_is(loaded, table), table)
    findings = examine(loaded, table)
    if seen.agreement < _POOR and all(finding.kind != "units" for finding in findings):
        text = "the data contradict the scene as it is: units, the kind of speed or entries may be far off"
        findings.append(Finding("contradiction", (), text))
    differing = tuple(table.label(int(k)) for k in np.flatnonzero(~seen.agrees))
    return Checkup(
        table, loaded, tuple(findings), seen.agreement, differing, _telling(loaded, table, seen), tuple(_notes(table))
    )


def examine(scene: Scene, data: Measurements) -> list[Finding]:
    """What is odd in the data."""
    try:
        check_energy(scene, (), data)
        findings = []
    except InputError as error:
        findings = [Finding("energy", (), str(error))]
    experiment = _as_it_is(scene, data)
    seen = _predicted(experiment, data)
    units = _units(experiment, data, seen.agreement) or _kind_of_speed(experiment, data, seen)
    findings = [*units, *findings, *_beyond(experiment, data, seen)]
    return [*findings, *_outliers(experiment, data, seen), *_duplicates(data)]


def _as_it_is(scene: Scene, data: Measurements) -> Experiment:
    return rows_of(scene, (), data, RTOL).unchecked(np.zeros(0))


@dataclass(frozen=True)
class _Predicted:
    """Outcomes and restitutions of the rows' nominal impacts by a scene; NaN where there is none."""

    data: Measurements
    outcome: np.ndarray
    restitution: np.ndarray

    @property
    def misfit(self) -> np.ndarray:
        """Measured restitution less this; NaN where either is missing."""
        measured = self.data.observed.get("restitution")
        return np.full(self.data.size, np.nan) if measured is None else measured[0] - self.restitution

    @property
    def agrees(self) -> np.ndarray:
        """Mask of the rows whose outcome is that observed, with a restitution within 0.25 if one was measured."""
        allowed = self.data.allowed[np.arange(self.data.size), self.outcome]
        return np.asarray((self.outcome >= 0) & allowed & ~(np.abs(self.misfit) > _TOLERATED))

    @property
    def agreement(self) -> float:
        """Share of the rows that agree."""
        return float(np.mean(self.agrees))


def _predicted(
    experiment: Experiment, data: Measurements, speed: np.ndarray | None = None, angle: np.ndarray | None = None
) -> _Predicted:
    """At the rows' own normal speeds and angles, or at others."""
    row, speed = np.arange(data.size), data.normal_speed if speed is None else speed
    angle = data.angle if angle is None else angle
    outcome = experiment.outcomes(row, speed, angle)
    return _Predicted(data, outcome, experiment.plain(("restitution",), row, speed, angle)[0])


def _units(experiment: Experiment, data: Measurements, share: float) -> list[Finding]:
    """Whether the data agree with the scene much better in other units, or as another speed or angle."""
    speed, angle = data.normal_speed, data.angle
    if share >= _POOR:
        return []
    others = [
        (f"speeds {words}", f"Are these speeds in {unit}?", speed * factor, angle)
        for factor, words, unit in (
            (1e-3, "1000 times smaller", "mm/s"), (1e-2, "100 times smaller", "cm/s"),
            (1e-1, "10 times smaller", "mm/s, not in cm/s"), (1e1, "10 times larger", "cm/s, not in mm/s"),
            (1e2, "100 times larger", "m/s, not in cm/s"), (1e3, "1000 times larger", "m/s, not in mm/s"),
        )
    ]  # fmt: skip
    if (angle > 0).any():
        turned = np.minimum(math.pi / 2 - angle, STEEPEST)
        others.append(("angles of 90 deg less these", "Are they measured from the tangent?", speed, turned))
        other = speed / np.cos(angle) if data.relative else speed * np.cos(angle)
        either = ("the magnitude of the relative velocity", "the normal component")[:: -1 if data.relative else 1]
        others.append((f"these speeds as {either[0]}", f"Are they not {either[1]}?", other, angle))
    agreements = [(_predicted(experiment, data, v, a).agreement, words, question) for words, question, v, a in others]
    best, words, question = max(agreements)
    if best < max(_GOOD, share + _BETTER):
        return []
    text = f"{_agreements(share, words, best)} {question} Or are entries of the scene far off?"
    return [Finding("units", (), text)]


def _kind_of_speed(experiment: Experiment, data: Measurements, seen: _Predicted) -> list[Finding]:
    """Whether speeds whose column does not say which they are agree better as magnitudes, by a sign test."""
    if not data.kind_unsaid:
        return []
    other = _predicted(experiment, data, data.speed * np.cos(data.angle))
    gained, lost = (int(np.count_nonzero(mask)) for mask in (other.agrees & ~seen.agrees, seen.agrees & ~other.agrees))
    if gained - lost <= _SIGNS * math.sqrt(gained + lost):
        return []
    text = _agreements(seen.agreement, "these speeds as the magnitude of the relative velocity", other.agreement)
    return [Finding("speed", (), f"{text} Which are they? Name the column v_n or v_rel")]


def _agreements(share: float, words: str, best: float) -> str:
    return f"as the scene is, {share:.0%} of the impacts come out as observed; with {words} it is {best:.0%}."


def _beyond(experiment: Experiment, data: Measurements, seen: _Predicted) -> list[Finding]:
    """Restitutions that no speed gives at their angle, with the scene as it is."""
    if "restitution" not in data.observed:
        return []
    values, sd = data.observed["restitution"]
    row = np.flatnonzero(values - _NOISE * sd > np.nan_to_num(seen.restitution))[:_MOST]
    if not row.size:
        return []
    steeper = np.minimum(data.angle[row] + _WIDE * data.angle_sd[row], STEEPEST)
    low, high = stokes_range(experiment.scene, {*data.angle[row].tolist()})
    speed = np.geomspace(low, high, _SPEEDS) / experiment.scene.stokes_per_speed
    rows, speeds = np.repeat(np.tile(row, 2), _SPEEDS), np.tile(speed, 2 * row.size)
    angles = np.repeat(np.concatenate([data.angle[row], steeper]), _SPEEDS)
    predictions = experiment.plain(("restitution",), rows, speeds, angles)[0].reshape(2, row.size, _SPEEDS)
    most = np.nan_to_num(predictions).max(axis=(0, 2))
    wrong = np.flatnonzero(values[row] - _NOISE * sd[row] > most)
    if not wrong.size:
        return []
    k = wrong[np.argmax(values[row[wrong]] - most[wrong])]
    words = f"such as {values[row[k]]:.3g} where it is at most {most[k]:.3g}"
    text = f"more than any speed gives at the impact angle, as the scene is, {words}"
    return [_finding("restitution", data, row[wrong], text)]


def _outliers(experiment: Experiment, data: Measurements, seen: _Predicted) -> list[Finding]:
    """Rows unlike their neighbours in speed and angle: an outcome between others alike, a restitution off the trend."""
    if data.size > _MOST:
        return []
    log_speed, findings = np.log(data.speed), []
    apart = log_speed - log_speed[:, None], data.angle - data.angle[:, None]
    near = (np.abs(apart[0]) < _NEAR_SPEED) & (np.abs(apart[1]) < _NEAR_ANGLE) & ~np.eye(data.size, dtype=bool)
    odd, explained = [], _within_scatter(experiment, data)
    for k in np.flatnonzero(data.outcome != UNKNOWN).tolist():
        around = np.flatnonzero(near[k] & (data.outcome != UNKNOWN))
        alike = np.unique(data.outcome[around])
        enclosed = (apart[0][k, around] < 0).any() and (apart[0][k, around] > 0).any() and around.size > 2
        if enclosed and alike.size == 1 and alike[0] != data.outcome[k] and not explained[k]:
            odd.append((k, int(alike[0])))
    if odd:
        rows, (k, other) = [k for k, _ in odd], odd[0]
        words = f"such as {OUTCOMES[data.outcome[k]]} where others have {OUTCOMES[other]}"
        findings.append(_finding("outlier", data, rows, f"unlike all slower and faster impacts nearby, {words}"))
    values, sd = data.observed.get("restitution", (np.full(data.size, np.nan),) * 2)
    mask, residual = np.isfinite(values) & (data.outcome != _STICK), np.full(data.size, np.nan)
    misfit = np.where(np.isfinite(seen.misfit), seen.misfit, values)
    for k in np.flatnonzero(mask).tolist():
        around = np.flatnonzero(near[k] & mask & (data.outcome == data.outcome[k]))
        if around.size > _LEAST:  # a plane through the neighbours, of the values and of their distances from the model
            plane = np.stack([np.ones(around.size), apart[0][k, around], apart[1][k, around]], axis=1)
            weight = np.linalg.pinv(plane)[0]
            off = [float(column[k] - weight @ column[around]) for column in (values, misfit)]
            residual[k] = min(off, key=abs) / math.sqrt(1 + float(weight @ weight))
    if np.isfinite(residual).any():
        scale = np.maximum(1.4826 * np.nanmedian(np.abs(residual)), sd)
        far = np.flatnonzero(np.abs(residual) > _ODD * scale)
        if far.size:
            k = far[np.argmax(np.abs(residual[far]))]
            words = f"such as {values[k]:.3g} where they suggest {values[k] - residual[k]:.3g}"
            findings.append(_finding("outlier", data, far, f"restitution off the trend of impacts nearby, {words}"))
    return findings


def _within_scatter(experiment: Experiment, data: Measurements) -> np.ndarray:
    """Mask of the rows whose outcome the scene gives at the impact or within three deviations in speed and angle."""
    matches = np.zeros(data.size, bool)
    for side, turn in ((0, 0), (_WIDE, 0), (-_WIDE, 0), (0, _WIDE), (0, -_WIDE), (2, 2), (2, -2), (-2, 2), (-2, -2)):
        angle = np.clip(data.angle + turn * data.angle_sd, 0, STEEPEST)
        speed = np.maximum(data.normal_speed * (1 + side * data.speed_sd / data.speed), 1e-3 * data.normal_speed)
        matches |= _predicted(experiment, data, speed, angle).outcome == data.outcome
    return matches


def _duplicates(data: Measurements) -> list[Finding]:
    """Rows with the same impact and the same measured results; outcomes alone may well agree."""
    columns = [data.speed, data.angle, data.outcome, *data.columns.values()]
    columns += [values for values, _ in data.observed.values()]
    same: dict[str, list[int]] = {}
    for k in np.flatnonzero(data.separated).tolist():
        same.setdefault(str([column[k].item() for column in columns]), []).append(k)
    text = "the same to the last digit: copied?"
    return [_finding("duplicate", data, rows, text) for rows in same.values() if len(rows) > 1]


def _telling(scene: Scene, data: Measurements, seen: _Predicted) -> dict[str, int]:
    """Entry -> number of rows of which the outcome, or what was measured beyond its noise, differs if it is changed."""
    impacts, measured = (np.arange(data.size), data.normal_speed, data.angle), tuple(data.observed)
    noise = [np.where(np.isnan(values), np.inf, sd) for values, sd in data.observed.values()]
    before = _as_it_is(scene, data).plain(measured, *impacts) if measured else np.zeros((0, data.size))
    counts = {}
    for name in (entry for entry in free_names(scene) if entry not in data.columns):
        rows = rows_of(scene, (name,), data, RTOL)
        value, bounded = float(scene.entries[name]), np.isfinite(scene.fields[name].range.high)
        differs = np.zeros(data.size, bool)
        for moved in (value - _PART, value + _PART) if bounded else (value / _FACTOR, value * _FACTOR):
            experiment = rows.at(np.array([moved])) if scene.fields[name].range.holds(moved) else None
            if experiment is not None:
                outcome = experiment.outcomes(*impacts)
                differs |= (outcome != seen.outcome) & (outcome >= 0)
                for after, of_seen, sd in zip(experiment.plain(measured, *impacts) if measured else (), before, noise):
                    differs |= np.abs(np.nan_to_num(after - of_seen)) > sd
        counts[name] = int(np.count_nonzero(differs))
    return counts


def _notes(data: Measurements) -> list[str]:
    count = {name: int(np.count_nonzero(data.outcome == code)) for code, name in enumerate(OUTCOMES)}
    count["outcome not recorded"] = int(np.count_nonzero(data.outcome == UNKNOWN))
    speeds, angles = data.speed, np.degrees(data.angle)
    notes = [
        f"{data.size} impacts: " + ", ".join(f"{number} {name}" for name, number in count.items() if number) + ".",
        f"{NAMES[data.speed_name]} {speeds.min():.4g} to {speeds.max():.4g} m/s, "  # noqa: ISC004 # one sentence
        f"angle {angles.min():.4g} to {angles.max():.4g} deg.",
    ]
    if not data.measured.any():
        notes.append("No restitution or other result was measured: only changes of outcome tell anything.")
    return [*notes, *data.remarks]


def _finding(kind: str, data: Measurements, rows: Sequence[int] | np.ndarray, text: str) -> Finding:
    labels = tuple(data.label(int(k)) for k in rows)
    return Finding(kind, labels, f"{several(labels)}: {text}")
