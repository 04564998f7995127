"""The numbers that a law takes: their names, units and ranges, and the C that refuses others."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ....generated.automaton import Status
from ...engines.settings import TOLERANCE
from ...errors import CheckFailed
from ...scene import user_model
from ...scene.entry_rules import FARTHEST
from ...scene.fields import Range
from ...scene.groups import NEVER_MET, si_values
from ...scene.quantities import NO_GLASS
from ...scene.scene import Scene
from ...scene.schema import FIELDS, SHEAR_RATE
from ...scene.user_model_declared import TABLE
from .kernels import Kernel

LARGEST = 1e30
"""Largest magnitude of a number, and the inverse of the smallest: beyond it groups may leave a double's range."""
LARGE = {"glass_transition_pressure": NO_GLASS, "youngs_modulus": NEVER_MET["youngs_modulus"]}
_RATIO = Range(f"from {1 / FARTHEST:g} to {FARTHEST:g}", 1 / FARTHEST, FARTHEST, low_open=False, high_open=False)
_ALONE = {
    "reduced_radius": "reduced radius, R1 R2/(R1 + R2)",
    "reduced_mass": "reduced mass, M1 M2/(M1 + M2)",
    "volume": "bridge volume over (2 reduced_radius)^3",
}
_BESIDE_WALL = {"reduced_radius": "radius of the sphere", "reduced_mass": "mass of the sphere"}
_OK = "OK"
_PAIRS = {
    "NO_DIRECTION": "the normal is zero or not finite: the particles are at one place, or nowhere",
    "NOT_A_NUMBER": "a velocity or a spin is not finite",
    "NOT_APPROACHING": "the particles do not approach along the normal",
    "OUT_OF_RANGE": "velocities and spins are too large, too small, or too far from each other",
    "NOT_IN_CONTACT": "the particles are not at contact distance within `tolerance`, or pass each other",
    "BAD_TOLERANCE": "tolerance must be a number from 0",
    "BAD_STEP": "the length of a step must be a positive number, s",
    "BAD_HISTORY": "the history of the pair is none that a call has left: begin with zeros",
}
"""Statuses of pairs in space, from 150 on."""


@dataclass(frozen=True)
class Number:
    """A number that a host gives: name, unit, what it is, its interval in SI, and the scene's value."""

    name: str
    unit: str
    meaning: str
    range: Range
    value: float
    most: float = LARGEST
    """Largest magnitude that is accepted."""

    @property
    def status(self) -> str:
        """The enumerator of the status of a number outside its range, without the law's prefix."""
        return f"BAD_{self.name.upper()}"

    @property
    def in_words(self) -> str:
        """The interval in words, in the unit of the number."""
        if self.range.low == -math.inf and self.range.high == math.inf:
            return "any finite number"
        if self.unit != "rad":
            return self.range.text + (f" ({self.most:g}: never met)" if self.most > LARGEST else "")
        return "from 0 to pi/2" if not self.range.high_open else "at least 0, below pi/2"

    @property
    def comment(self) -> str:
        """Its unit, its interval and what it is."""
        return f"{'' if self.unit == '1' else self.unit + ', '}{self.in_words}: {self.meaning}"

    def test(self, of: str) -> str:
        """The condition, in C, that it is within its range; `of` stands before its name."""
        interval, name, tests = self.range, f"{of}{self.name}", list[str]()
        if interval.low > -math.inf:
            tests.append(f"{name} {'>' if interval.low_open else '>='} {interval.low!r}")
        if interval.high < math.inf:
            tests.append(f"{name} {'<' if interval.high_open else '<='} {interval.high!r}")
        return " && ".join([*tests, f"is_usual({name}, {self.most!r})"])


@dataclass(frozen=True)
class Result:
    """A status: its number, its enumerator without the law's prefix, and its message."""

    number: int
    name: str
    message: str


def material(scene: Scene, kernels: Iterable[Kernel]) -> tuple[Number, ...]:
    """The numbers of a material, in the order of the vocabulary."""
    from ....derive.vocabulary.quantities import VOCABULARY

    values = {"poisson_ratio": 0.0, **NEVER_MET, **si_values(scene, None, None)}
    names = {name for kernel in kernels for name in kernel.material}
    words = [name for name in VOCABULARY if name in names]
    result = []
    for name in [*words, *sorted(names - {*words})]:
        if name in words:
            unit, meaning = VOCABULARY[name].unit, meaning_of(name, scene)
        else:
            field = user_model.fields(scene.package)[f"{_table(scene)}.{name}"]
            unit, meaning = field.unit or "1", field.what
            unit = "1/s" if field.what == SHEAR_RATE else unit
        most = LARGE.get(name, LARGEST)
        result.append(Number(name, unit, meaning, _range(name, scene), float(values[name]), most))
    return tuple(result)


def _table(scene: Scene) -> str:
    """The table of a scene that has the quantities of its model."""
    return TABLE if scene.package is None else scene.package.table


def meaning_of(name: str, scene: Scene) -> str:
    """The vocabulary's, but for numbers whose R and M the header does not explain."""
    from ....derive.vocabulary.quantities import VOCABULARY

    meanings = {**_ALONE, **_BESIDE_WALL} if scene.wall else _ALONE
    return meanings.get(name, VOCABULARY[name].meaning)


def impact(scene: Scene) -> tuple[Number, ...]:
    """The numbers of an impact."""
    still = Range("0", 0.0, 0.0, low_open=False, high_open=False)
    spins = "angular velocity before the impact about the normal of the plane, positive as the line of centres turns"
    sphere, other = ("spin", "partner_spin")
    meanings = {sphere: f"the sphere's {spins}", other: f"the partner's {spins}"}
    ranges = {name: FIELDS[f"impact.{name}"].range for name in meanings}
    if scene.pendulum is not None:
        ranges = dict.fromkeys(ranges, still)
        meanings = dict.fromkeys(meanings, "spheres on strings do not spin before the impact")
    elif scene.wall:
        meanings[sphere] = "the sphere's angular velocity before the impact, positive as it rolls along its velocity"
        ranges[other], meanings[other] = still, "a wall does not spin"
    return (
        Number("speed", "m/s", "normal approach speed at initial contact", FIELDS["impact.speed"].range, 1.0),
        Number("angle", "rad", "impact angle, 0 along the line of centres", FIELDS["impact.angle"].range, 0.0),
        *(Number(name, "rad/s", meanings[name], ranges[name], 0.0) for name in meanings),
    )


def results(numbers: Iterable[Number], entries: Iterable[Number] = (), in_space: bool = False) -> tuple[Result, ...]:
    """Every status: of numbers of a material and an impact, of entries of a pair, and of pairs in space."""
    failed = {
        Status.NO_BUDGET: "not decided within `budget` steps",
        Status.NOT_FINITE: "the state is not finite, or energy has grown",
        Status.CHATTER: "not decided: the pair goes in and out of contact again and again",
        Status.TOO_OBLIQUE: "the centrifugal force is too large beside the approach to be resolved",
        Status.WITHIN_ROUNDING: "not decided: the pair separates so slowly that rounding decides",
        Status.UNDECLARED: "a declared event creates energy that it does not declare",
        Status.ESCAPED: "a pair that was proved to stick has separated: please report it",
    }
    statuses = [Result(0, _OK, "decided")]
    statuses += [Result(int(status), f"UNDECIDED_{status.name}", sentence) for status, sentence in failed.items()]
    rules = {
        "BAD_RTOL": f"rtol must be {TOLERANCE.range.text}",
        "BAD_TIME": "a contact is advanced to a finite time that is not before its own",
        "ROUGHNESS_BEYOND_FILM": "roughness is not below film_thickness",
        "RUPTURE_WITHIN_FILM": "the bridge ruptures within film_thickness: a larger volume is needed",
        "STRINGS_TOO_SHORT": "string_length is too short for two spheres to swing around each other",
        "NOTHING_STOPS": "nothing stops the approach: roughness is 0 and there is no elastic length",
        "BAD_BUDGET": "budget must be a number of steps from 0",
        "BAD_ARITHMETIC": "compiled with options that reorder sums or leave out NaN and infinity, as -ffast-math does",
    }
    statuses += [Result(100 + k, name, sentence) for k, (name, sentence) in enumerate(rules.items())]
    for first, those in ((200, numbers), (300, entries)):
        for k, number in enumerate(those, first):
            unit = "" if number.unit == "1" else f", {number.unit}"
            statuses.append(Result(k, number.status, f"{number.name} must be {number.in_words}{unit}"))
    if in_space:
        statuses += [Result(150 + k, name, sentence) for k, (name, sentence) in enumerate(_PAIRS.items())]
    return tuple(statuses)


def endless(scene: Scene) -> str:
    """The condition, in C, under which nothing stops the approach of a material `m`."""
    never = [f"m->{name} {'>=' if value > 1 else '<='} {value!r}" for name, value in NEVER_MET.items()]
    last = "m->hamaker > 0.0" if scene.attraction is not None else f"m->glass_transition_pressure >= {NO_GLASS!r}"
    return " && ".join([*never, last])


def _range(name: str, scene: Scene) -> Range:
    """The interval of a quantity, as the schema of a scene has it."""
    if name in ("radius_ratio", "mass_ratio"):
        return _RATIO
    field = next((entry for entry in FIELDS.values() if entry.quantity == name), None)
    field = field or user_model.fields(scene.package).get(f"{_table(scene)}.{name}")
    if field is None:
        raise CheckFailed(f"no range of {name} is known")
    return field.range
