"""Options shared by the commands and their checks, which precede the reading of any file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import InputError, shown
from ..host import files, outputs
from ..scene import units
from ..scene.ranges import parse_range
from ..scene.schema import FIELDS, unknown_entry
from ..scene.user_model import Package, fields, unknown
from ..scene.user_model_source import open_package

if TYPE_CHECKING:
    from ..scene.scene import Scene

Command = Callable[..., Any]
Reader = Callable[[str], float]
PICTURES = outputs.PICTURES

# Not required by click, so that a bad option is reported before a missing scene.
scene_argument = click.argument("source", metavar="SCENE", required=False)
debug = click.option("--debug", is_flag=True, expose_value=False, help="Show a traceback behind an error.")
as_json = click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table.")
rtol = click.option("--rtol", metavar="R", help="Relative tolerance, 1e-13..1e-3 [1e-9].")
engine = click.option("--engine", metavar="E", help="cvodes, rosenbrock or taylor [the best for the scene].")
plot = click.option("--plot", metavar="FILE.png", help="Draw a picture: .png, .pdf or .svg.")
output = click.option("-o", "output", metavar="FILE", help="Write to FILE instead of standard output.")
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


def impact(command: Command) -> Command:
    """Add --stokes, --speed and --angle to a command."""
    command = click.option("--angle", metavar="A", help='Impact angle with its unit, as "60 deg".')(command)
    command = click.option("--speed", metavar="V", help='Normal speed with its unit, as "0.54 m/s".')(command)
    return click.option("--stokes", metavar="S", help="Normal Stokes number.")(command)


@dataclass(frozen=True)
class Asked:
    """A scene as requested on the command line: options checked, scene file not read yet."""

    source: str | None
    entries: Mapping[str, str]
    impact: Mapping[str, str]  # texts with units, as given
    package: Package | None = None

    @classmethod
    def check(
        cls,
        source: str | None,
        changes: Sequence[str] = (),
        stokes: str | None = None,
        speed: str | None = None,
        angle: str | None = None,
        model: str | None = None,
    ) -> Asked:
        """Return the checked request; InputError naming the first wrong option."""
        given = {"stokes": stokes, "speed": speed, "angle": angle}
        read = {key: text for key, text in given.items() if text is not None}
        for key, text in read.items():
            FIELDS[f"impact.{key}"].number(text, label=f"--{key}")
        if "stokes" in read and "speed" in read:
            raise InputError(
                "--speed", speed, "only one of --stokes, --speed", f"is given together with --stokes = {stokes}"
            )
        package = None if model is None else open_package(model)
        entries = _entries(changes, package)
        for key in read:
            same = ("impact.angle",) if key == "angle" else ("impact.stokes", "impact.speed")
            for entry in same:
                if entry in entries:
                    problem = f"is given together with --set {entry} = {shown(entries[entry])}"
                    raise InputError(f"--{key}", given[key], "only one of the two", problem)
        return cls(source, entries, read, package)

    def optional_scene(self) -> Scene | None:
        """Read the scene if one is named; InputError for an option that needs a scene."""
        if self.source is None:
            for option, value in (
                *((f"--{key}", text) for key, text in self.impact.items()),
                *(("--set", f"{name}={value}") for name, value in self.entries.items()),
            ):
                raise InputError(option, value, f"a SCENE with {option}", "needs a SCENE")
            if self.package is not None:
                raise InputError("--model", str(self.package.folder), "a SCENE with --model", "needs a SCENE")
            return None
        return self.scene()

    def scene(self) -> Scene:
        """Read the scene and apply the changes; InputError for any wrong entry."""
        from ..scene.scene import Scene
        from ..scene.scenefile import PRESETS

        if self.source is None:
            raise InputError("SCENE", None, "a scene file (TOML) or a preset: " + ", ".join(PRESETS))
        changed = Scene.load(self.source, self.package).with_entries(self.entries).with_impact(**self.impact)
        return Scene.load(changed)  # checks the entries that a user's model requires


def _entries(changes: Sequence[str], package: Package | None = None) -> dict[str, str]:
    """Return the entries of --set by dotted name, each checked by itself."""
    entries, known = {}, fields(package)
    for change in changes:
        name, equals, value = change.partition("=")
        name = name.strip()
        if not equals:
            raise InputError("--set", change, 'NAME=VALUE, such as liquid.viscosity="3 Pa s"', "has no =")
        if name != "name":
            if name not in known:
                raise unknown(name, value, package) or unknown_entry(name, value)
            known[name].read(value)
        entries[name] = value
    return entries


def entries(changes: Sequence[str]) -> dict[str, str]:
    """Return the entries of --set by dotted name, unchecked; each applies to a scene that is read later."""
    found = {}
    for change in changes:
        name, equals, value = change.partition("=")
        if not equals:
            raise InputError("--set", change, 'NAME=VALUE, such as liquid.viscosity="3 Pa s"', "has no =")
        found[name.strip()] = value
    return found


def angles(text: str, option: str = "--angle") -> list[float]:
    """Return the impact angles (rad) of a range in degrees; InputError naming the option."""

    def read(end: str) -> float:
        units.number(end, option, "LO:HI:N or log:LO:HI:N in degrees, without a unit")
        return FIELDS["impact.angle"].number(f"{end.strip()} deg", label=option)

    return parse_range(text, option, read, unit="in degrees")


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


def put(text: str, file: Path | None) -> None:
    """Write `text` to the file, or to standard output."""
    if file is None:
        click.echo(text)
    else:
        files.write(file, text + "\n")
