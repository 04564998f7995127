"""Options that mean the same everywhere, and their checks, which come before anything is read or missing."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import InputError, shown
from ..schema import FIELDS, unknown_entry

if TYPE_CHECKING:
    from ..scene import Scene

Command = Callable[..., Any]
PICTURES = (".png", ".pdf", ".svg")

# Not required by click: a bad option is to be reported before a scene that is missing.
scene_argument = click.argument("source", metavar="SCENE", required=False)
debug = click.option("--debug", is_flag=True, expose_value=False, help="Show a traceback behind an error.")
as_json = click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table.")
rtol = click.option("--rtol", metavar="R", help="Relative tolerance, 1e-13..1e-3 [1e-9].")
engine = click.option("--engine", metavar="E", help="cvodes or rosenbrock [the best for the scene].")
plot = click.option("--plot", metavar="FILE.png", help="Draw a picture.")
output = click.option("-o", "output", metavar="FILE", help="Write to FILE instead of standard output.")
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
    """A scene as the command line asks for it: options judged, nothing read yet."""

    source: str | None
    entries: Mapping[str, str]
    impact: Mapping[str, float]

    @classmethod
    def check(
        cls,
        source: str | None,
        changes: Sequence[str] = (),
        stokes: str | None = None,
        speed: str | None = None,
        angle: str | None = None,
    ) -> Asked:
        """Return what is asked for; InputError naming the first option that is wrong."""
        given = {"stokes": stokes, "speed": speed, "angle": angle}
        read = {
            key: FIELDS[f"impact.{key}"].number(text, label=f"--{key}")
            for key, text in given.items()
            if text is not None
        }
        if "stokes" in read and "speed" in read:
            raise InputError(
                "--speed", speed, "only one of --stokes, --speed", f"is given together with --stokes = {stokes}"
            )
        entries = _entries(changes)
        for key in read:
            same = ("impact.angle",) if key == "angle" else ("impact.stokes", "impact.speed")
            for entry in same:
                if entry in entries:
                    problem = f"is given together with --set {entry} = {shown(entries[entry])}"
                    raise InputError(f"--{key}", given[key], "only one of the two", problem)
        return cls(source, entries, read)

    @property
    def is_none(self) -> bool:
        """True if nothing at all is said about a scene."""
        return self.source is None and not self.entries and not self.impact

    def scene(self) -> Scene:
        """Read the scene and change it as asked; InputError for whatever is wrong with it."""
        from ..scene import Scene
        from ..scenefile import PRESETS

        if self.source is None:
            raise InputError("SCENE", None, "a scene file (TOML) or a preset: " + ", ".join(PRESETS))
        return Scene.load(self.source).with_entries(self.entries).with_impact(**self.impact)


def _entries(changes: Sequence[str]) -> dict[str, str]:
    """Return the entries of --set by dotted name, each right by itself."""
    entries = {}
    for change in changes:
        name, equals, value = change.partition("=")
        name = name.strip()
        if not equals:
            raise InputError("--set", change, 'NAME=VALUE, such as liquid.viscosity="3 Pa s"', "has no =")
        if name != "name":
            if name not in FIELDS:
                raise unknown_entry(name, value)
            FIELDS[name].read(value)
        entries[name] = value
    return entries


def check_file(path: str | None, option: str, suffixes: Sequence[str] = ()) -> Path | None:
    """Return the file to be written; InputError naming the option if it cannot be, or has another suffix."""
    if path is None:
        return None
    file = Path(path)
    accepted = "a file name" + (f" ending in {', '.join(suffixes)}" if suffixes else "") + " in a folder that exists"
    if suffixes and file.suffix.lower() not in suffixes:
        raise InputError(option, path, accepted, "has an unsupported suffix")
    if "\0" in path or not path.strip():
        raise InputError(option, path, accepted, "is not a file name")
    if not file.parent.is_dir():
        raise InputError(option, path, accepted, "is in a folder that does not exist")
    if file.is_dir():
        raise InputError(option, path, accepted, "is a folder")
    if not os.access(file if file.exists() else file.parent, os.W_OK):
        raise InputError(option, path, accepted, "cannot be written")
    return file


def check_folder(path: str | None, option: str = "--out") -> Path | None:
    """Return the folder to write into, which may not exist yet; InputError naming the option if it never could."""
    if path is None:
        return None
    accepted = "a folder that exists or can be made"
    if "\0" in path or not path.strip():
        raise InputError(option, path, accepted, "is not a file name")
    folder = Path(path)
    there = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    if not there.is_dir() or not os.access(there, os.W_OK):
        raise InputError(option, path, accepted, f"cannot be a folder: {there} is not one that can be written")
    return folder


def put(text: str, file: Path | None) -> None:
    """Write `text` to the file, or to standard output."""
    if file is None:
        click.echo(text)
    else:
        file.write_text(text + "\n", encoding="utf-8")
