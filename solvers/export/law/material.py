"""The numbers that a law takes: their names, units and ranges, and the C that refuses others."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from ....generated.automaton import Status
from ...engines.settings import TOLERANCE
from ...errors import CheckFailed
from ...scene import user_model
from ...scene.contact import NEVER_MET
from ...scene.entry_rules import FARTHEST
from ...scene.fields import Range
from ...scene.groups import si_values
from ...scene.quantities import NO_GLASS
from ...scene.scene import Scene
from ...scene.schema import FIELDS
from ...scene.user_model_declared import TABLE
from .kernels import HEAD_ON, PLANE, Kernel

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


_IEEE = """\
/* Whether sums are rounded as they stand, and comparisons know NaN and infinity: clang has no macros for options that
   change this. The numbers are read at run time, so that the options act on them as on all others. */
static int is_ieee(void)
{
    const volatile double quarter = 0.25;
    double x = quarter, infinite = x < 1.0 ? INFINITY : x, none = infinite - infinite, magic = 6755399441055744.0;
    return (x + magic) - magic == 0.0 && infinite > 1e308 && !(none >= 0.0 || none <= 0.0);
}

"""


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


def results(numbers: Iterable[Number], entries: Iterable[Number] = ()) -> tuple[Result, ...]:
    """Every status: of numbers of a material and an impact, and of entries of a pair."""
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
    return tuple(statuses)


def checks(scene: Scene, of_material: Iterable[Number], of_impact: Iterable[Number], kernels: Iterable[Kernel]) -> str:
    """C functions that refuse a material, an impact and a tolerance."""
    tolerance = Number("rtol", "1", "", TOLERANCE.range, 1e-9)
    body = refusals(of_material, "m->")
    never = [f"m->{name} {'>=' if value > 1 else '<='} {value!r}" for name, value in NEVER_MET.items()]
    stops = " && ".join(never)
    if scene.attraction is not None:
        stops += " && m->hamaker > 0.0"
    else:
        stops += f" && m->glass_transition_pressure >= {NO_GLASS!r}"
    body += [f"if ({stops})", "    return LAW_NOTHING_STOPS;", "if (!is_ieee())", "    return LAW_BAD_ARITHMETIC;"]
    *others, last = (f"{kernel.prefix}_inconsistent(m)" for kernel in kernels if kernel.prefix in (HEAD_ON, PLANE))
    for other in others:
        body += [f"if ({other} != LAW_OK)", f"    return {other};"]
    lines = c_function("static int check_material(const law_material *m)", [*body, f"return {last};"])
    refused = [*refusals(of_impact, "impact->"), "return LAW_OK;"]
    lines += c_function("static int check_impact(const law_impact *impact)", refused)
    settings = [*refusals([tolerance], ""), "return budget >= 0 ? LAW_OK : LAW_BAD_BUDGET;"]
    lines += c_function("static int check_settings(double rtol, int budget)", settings)
    intro = "/* Numbers outside their ranges, NaN among them, are refused. */\n\n"
    usual = [
        "/* Whether a number is zero, or of a size with which the groups stay within a double's range. */",
        *c_function(
            "static int is_usual(double x, double most)",
            [f"return x == 0.0 || (fabs(x) >= {1 / LARGEST!r} && fabs(x) <= most);"],
        ),
    ]
    return _IEEE + intro + "\n".join([*usual, *lines])


def refusals(numbers: Iterable[Number], of: str) -> list[str]:
    """Lines of C that return the status of the first number outside its range; `of` stands before their names."""
    lines = []
    for number in numbers:
        interval, name, tests = number.range, f"{of}{number.name}", []
        if interval.low > -math.inf:
            tests.append(f"{name} {'>' if interval.low_open else '>='} {interval.low!r}")
        if interval.high < math.inf:
            tests.append(f"{name} {'<' if interval.high_open else '<='} {interval.high!r}")
        tests.append(f"is_usual({name}, {number.most!r})")
        lines += [f"if (!({' && '.join(tests)}))", f"    return LAW_{number.status};"]
    return lines


def c_function(head: str, body: Iterable[str]) -> list[str]:
    """Lines of a C function and an empty one."""
    return [head, "{", *(f"    {line}" for line in body), "}", ""]


def _range(name: str, scene: Scene) -> Range:
    """The interval of a quantity, as the schema of a scene has it."""
    if name in ("radius_ratio", "mass_ratio"):
        return _RATIO
    field = next((entry for entry in FIELDS.values() if entry.quantity == name), None)
    field = field or user_model.fields(scene.package).get(f"{_table(scene)}.{name}")
    if field is None:
        raise CheckFailed(f"no range of {name} is known")
    return field.range
