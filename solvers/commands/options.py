"""Options shared by the commands and their checks, which precede the reading of any file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import InputError, shown
from ..host import files, outputs
from ..scene import units
from ..scene.held import check_hold
from ..scene.ranges import MOST, Ends, parse_range
from ..scene.schema import FIELDS, SPEEDS, Field, unknown_entry
from ..scene.user_model import Package, fields, unknown
from ..scene.user_model_source import open_package

if TYPE_CHECKING:
    from ..scene.scene import Scene

Command = Callable[..., Any]
_CHANGE = 'NAME=VALUE, such as liquid.viscosity="3 Pa s"'
PICTURES = outputs.PICTURES

# Not required by click, so that a bad option is reported before a missing scene.
scene_argument = click.argument("source", metavar="SCENE", required=False)
debug = click.option("--debug", is_flag=True, expose_value=False, help="Show a traceback behind an error.")
as_json = click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table.")
rtol = click.option("--rtol", metavar="R", help="Relative tolerance, 1e-13..1e-3 [1e-9].")
engine = click.option("--engine", metavar="E", help="cvodes, rosenbrock or taylor [the best for the scene].")
plot = click.option("--plot", metavar="FILE.png", help="Draw a picture: .png, .pdf or .svg.")
output = click.option("-o", "output", metavar="FILE", help="Write to FILE instead of standard output.")
priors = click.option(
    "--prior",
    "priors",
    metavar="NAME=PRIOR",
    multiple=True,
    help='What is known of an entry, as particles.roughness="2 um +- 20 %"; repeatable.',
)
model = click.option(
    "--model", "model", metavar="DIR", help="A user's model, which is run: folder of `generate`, or MODEL.py."
)
changes = click.option(
    "--set",
    "changes",
    metavar="NAME=VALUE",
    multiple=True,
    help='Another entry, as liquid.viscosity="3 Pa s"; repeatable.',
)
hold = click.option(
    "--hold",
    metavar="WHAT",
    help="What the impact keeps when entries change: speed, stokes, relative_speed [the kind of speed that it "
    "is given by; of a Stokes number the normal speed].",
)


def impact(command: Command) -> Command:
    """Add --stokes, --speed, --relative-speed and --angle to a command."""
    command = click.option("--angle", metavar="A", help='Impact angle, as 60 (degrees) or "1.05 rad".')(command)
    command = click.option("--relative-speed", metavar="V", help='Magnitude of the relative velocity, as "1.08 m/s".')(
        command
    )
    command = click.option("--speed", metavar="V", help='Normal speed with its unit, as "0.54 m/s".')(command)
    return click.option("--stokes", metavar="S", help="Normal Stokes number.")(command)


@dataclass(frozen=True)
class SceneRequest:
    """A scene as requested on the command line: options checked, scene file not read yet."""

    source: str | None
    entries: Mapping[str, str]
    impact: Mapping[str, str]  # texts with units, as given
    package: Package | None = None
    hold: str | None = None

    @classmethod
    def check(
        cls,
        source: str | None,
        changes: Sequence[str] = (),
        stokes: str | None = None,
        speed: str | None = None,
        angle: str | None = None,
        relative_speed: str | None = None,
        model: str | None = None,
        hold: str | None = None,
    ) -> SceneRequest:
        """Return the checked request; InputError naming the first wrong option."""
        given = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
        read = {key: with_degrees(FIELDS[f"impact.{key}"], text) for key, text in given.items() if text is not None}
        for key, text in read.items():
            FIELDS[f"impact.{key}"].number(text, label=_option(key))
        held = None if hold is None else check_hold(hold, "--hold")
        first, *more = [key for key in read if key != "angle"] or [""]
        if more:
            options_ = ", ".join(_option(name.partition(".")[2]) for name in SPEEDS)
            problem = f"is given together with {_option(first)} = {given[first]}"
            raise InputError(_option(more[0]), given[more[0]], f"only one of {options_}", problem)
        package = None if model is None else open_package(model)
        entries = _entries(changes, package)
        for key in read:
            same = ("impact.angle",) if key == "angle" else SPEEDS
            for entry in same:
                if entry in entries:
                    problem = f"is given together with --set {entry} = {shown(entries[entry])}"
                    raise InputError(_option(key), given[key], "only one of the two", problem)
        return cls(source, entries, read, package, held)

    @property
    def options(self) -> dict[str, str]:
        """The texts of the options that are present."""
        texts = {_option(key): text for key, text in self.impact.items()}
        if self.entries:
            texts["--set"] = "; ".join(f"{name}={value}" for name, value in self.entries.items())
        if self.hold is not None:
            texts["--hold"] = self.hold
        if self.package is not None:
            texts["--model"] = str(self.package.folder)
        return texts

    def optional_scene(self) -> Scene | None:
        """Read the scene if one is named; InputError for an option that needs a scene."""
        if self.source is not None:
            return self.scene(remark=True)
        for option, text in self.options.items():
            raise InputError(option, text, f"a SCENE with {option}", "needs a SCENE")
        return None

    def scene(self, remark: bool = False) -> Scene:
        """Read the scene and apply the changes; InputError for any wrong entry.

        Arguments:
            remark: write what was held of the impact to standard error, for commands that show no impact.
        """
        from ..scene.scene import Scene
        from ..scene.scenefile import PRESETS

        if self.source is None:
            raise InputError("SCENE", None, "a scene file (TOML) or a preset: " + ", ".join(PRESETS))
        loaded = Scene.load(self.source, self.package)
        changed = loaded.with_entries(self.entries, self.hold).with_impact(**self.impact)
        if remark and changed.held:
            click.echo(changed.held, err=True)
        return Scene.load(changed)  # checks the entries that a user's model requires


def of_scene(command: Command) -> Command:
    """Add the impact's options, --set, --hold and --model; the command receives them and SCENE as `request`."""
    return _of_scene(command, varies=False)


def of_varied_scene(command: Command) -> Command:
    """The same for a command that varies entries itself, which --hold concerns as well."""
    return _of_scene(command, varies=True)


def _of_scene(command: Command, varies: bool) -> Command:

    @impact
    @changes
    @hold
    @model
    @wraps(command)
    def with_request(
        source: str | None,
        changes: Sequence[str],
        stokes: str | None,
        speed: str | None,
        angle: str | None,
        relative_speed: str | None,
        model: str | None,
        hold: str | None,
        **others: Any,
    ) -> Any:
        request = SceneRequest.check(source, changes, stokes, speed, angle, relative_speed, model, hold)
        if hold is not None and not varies:
            for key in (key for key in request.impact if key != "angle"):
                problem = f"is given together with {_option(key)}, which sets the impact anew"
                raise InputError("--hold", hold, f"--hold without {_option(key)}", problem)
        return command(request, **others)

    return with_request


def _entries(changes: Sequence[str], package: Package | None = None) -> dict[str, str]:
    """Return the entries of --set by dotted name, each checked by itself."""
    found, known = assigned(changes, "--set", _CHANGE), fields(package)
    for name, value in found.items():
        if name != "name":
            if name not in known:
                raise unknown(name, value, package) or unknown_entry(name, value)
            found[name] = with_degrees(known[name], value)
            known[name].read(found[name])
    return found


def entries(changes: Sequence[str]) -> dict[str, str]:
    """Return the entries of --set by dotted name, unchecked; each applies to a scene that is read later."""
    return typed(assigned(changes, "--set", _CHANGE))


def typed(found: Mapping[str, str]) -> dict[str, str]:
    """Entries by dotted name, a bare angle in degrees."""
    return {name: with_degrees(FIELDS[name], value) if name in FIELDS else value for name, value in found.items()}


def listed(text: str, label: str) -> list[str]:
    """The names of a list NAME,NAME; InputError for a name that is given twice."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        raise InputError(label, text, "names, separated by commas", "names nothing")
    for name in names:
        if names.count(name) > 1:
            raise InputError(label, text, "every name once", f"has {shown(name)} twice")
    return names


def assigned(given: Sequence[str], label: str, accepted: str) -> dict[str, str]:
    """The texts of a repeatable option NAME=TEXT, by name; InputError for a name that is given twice."""
    found: dict[str, str] = {}
    for text in given:
        name, equals, value = text.partition("=")
        name = name.strip()
        if not equals or name in found:
            raise InputError(label, text, accepted, "is given twice: every name once" if equals else "has no =")
        found[name] = value
    return found


def _option(key: str) -> str:
    return f"--{key.replace('_', '-')}"


def with_degrees(entry: Field, text: str) -> str:
    """An angle as it is typed: a bare number is in degrees."""
    return f"{text.strip()} deg" if entry.unit == "rad" and units.is_number(text) else text


def entry_range(entry: Field, text: str, label: str, *, most: int = MOST) -> list[float]:
    """The values (SI) of a range of an entry, either end of which may carry the unit; bare angles are in degrees."""
    return parse_range(text, label, entry_ends(entry, label), unit=_in_units(entry), most=most)


def varied(entry: Field, text: str, label: str) -> list[float] | list[str]:
    """The values of a range of an entry; as text where a plain number is something else than a quantity."""
    if entry.or_unit and not all(units.is_number(end) for end in text.removeprefix("log:").split(":")):
        return [f"{value!r} {entry.or_unit}" for value in entry_range(entry.measured, text, label)]
    return entry_range(entry, text, label)


def entry_ends(entry: Field, label: str) -> Ends:
    """What reads both ends of a range of an entry (SI): an end without a unit has that of the other."""

    def read(low: str, high: str) -> tuple[float, float]:
        bare = [units.is_number(end) for end in (low, high)]
        if all(bare) and entry.unit and entry.unit != "rad":
            unit = units.unit_of(entry.example.strip('"'))
            text = low.strip() if low == high else f"{low.strip()}:{high.strip()}"
            raise InputError(label, text, f'a number with its unit, as "{text} {unit}"', "has no unit")
        if bare[0] != bare[1]:
            unit = units.unit_of(high if bare[0] else low)
            low, high = (f"{end.strip()} {unit}" if units.is_number(end) else end for end in (low, high))
        first, last = (entry.number(with_degrees(entry, end), label=label) for end in (low, high))
        return first, last

    return read


def _in_units(entry: Field) -> str:
    if entry.unit == "rad":
        return "in degrees, or with a unit"
    return "with a unit at either end" if entry.unit else ""


def check_file(path: str | None, option: str, suffixes: Sequence[str] = (), *, replaced: bool = False) -> Path | None:
    """Return the output file, or None; InputError naming the option if it cannot be written."""
    return None if path is None else outputs.check_file(path, option, suffixes, replaced=replaced)


def check_apart(file: Path | None, option: str, other: Path | None, its_option: str) -> None:
    """Raise InputError if two options name the same file."""
    if file is not None and other is not None and file.resolve() == other.resolve():
        raise InputError(option, str(file), "two different files", f"is given to {its_option} as well")


def check_folder(path: str | None, option: str = "--out") -> Path | None:
    """Return the output folder, or None; InputError naming the option if it cannot be created or used."""
    return None if path is None else outputs.check_folder(path, option)


@contextmanager
def arguments_as_options(named: Mapping[str, str]) -> Iterator[None]:
    """Errors of a Python function name the command's options, by its arguments."""
    try:
        yield
    except InputError as error:
        argument, _, rest = error.field.partition(" ")
        if argument not in named:
            raise
        raise InputError(f"{named[argument]} {rest}".strip(), error.value, error.accepted, error.problem) from None


def put(text: str, file: Path | None) -> None:
    """Write `text` to the file, or to standard output."""
    if file is None:
        click.echo(text)
    else:
        files.write(file, text + "\n")
