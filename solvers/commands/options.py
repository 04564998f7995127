"""Options that commands share: a scene with an impact and changes, settings, and where a result goes."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from ..engines.settings import check_engine, check_rtol
from ..errors import InputError, excerpt
from ..host import files
from ..scene.fields import Field
from ..scene.held import check_hold
from ..scene.schema import FIELDS, SPEEDS, SPINS
from ..scene.user_model import Package, fields, unknown
from ..scene.user_model_source import open_package
from .signature import SHARED, Group, options_of, passed
from .texts import assigned, flag, numbers, typed, with_degrees

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene

_CHANGE = 'NAME=VALUE, such as liquid.viscosity="3 Pa s"'
_DEVIATION = 'NAME=VALUE, such as liquid.viscosity="5 %"'
_PRIOR = 'NAME=PRIOR, such as particles.roughness="2 um +- 20 %"'


# ---- the scene


@dataclass(frozen=True)
class SceneRequest:
    """A scene as requested on the command line: options checked, scene file not read yet."""

    source: str | None
    entries: Mapping[str, str]
    impact: Mapping[str, str]  # texts with units
    package: Package | None = None
    hold: str | None = None

    @classmethod
    def check(
        cls,
        source: str | None,
        changes: Sequence[str] = (),
        model: str | None = None,
        hold: str | None = None,
        varies: bool = True,
        **impact_texts: str | None,
    ) -> SceneRequest:
        """Return the checked request; InputError naming the first wrong option.

        Arguments:
            varies: the command varies entries itself, which --hold concerns as well.
            impact_texts: of `impact_of`.
        """
        typed = impact_of(**impact_texts)
        impact = {key: with_degrees(FIELDS[f"impact.{key}"], text) for key, text in typed.items()}
        numbers(typed)
        if hold is not None:
            check_hold(hold, "--hold")
        package = None if model is None else open_package(model)
        entries = _entries(changes, package)
        for key in impact:
            for entry in ("impact.angle",) if key == "angle" else SPEEDS:
                if entry in entries:
                    problem = f"is given together with --set {entry} = {excerpt(entries[entry])}"
                    raise InputError(flag(key), typed[key], "only one of the two", problem)
        for key in () if varies or hold is None else (key for key in impact if key != "angle"):
            problem = f"is given together with {flag(key)}, which sets the impact anew"
            raise InputError("--hold", hold, f"--hold without {flag(key)}", problem)
        return cls(source, entries, impact, package, hold)

    @property
    def options(self) -> dict[str, str]:
        """The texts of the options that are present."""
        changes = "; ".join(f"{name}={value}" for name, value in self.entries.items()) or None
        folder = None if self.package is None else str(self.package.folder)
        return {flag(key): text for key, text in self.impact.items()} | passed(
            **{"--set": changes, "--hold": self.hold, "--model": folder}
        )

    def optional_scene(self) -> Scene | None:
        """Read the scene if one is named; InputError for an option that needs a scene."""
        if self.source is not None:
            return self.scene(remark=True)
        refuse(self.options, "a SCENE with {}", "needs a SCENE")
        return None

    def scene(self, remark: bool = False, whole: bool = True) -> Scene:
        """Read the scene and apply the changes; InputError for any wrong entry.

        Arguments:
            remark: write what was held of the impact to standard error, for commands that show no impact.
            whole: quantities of a user's model that have no default must be there.
        """
        from ..scene.scene import Scene
        from ..scene.scenefile import PRESETS

        if self.source is None:
            raise InputError("SCENE", None, "a scene file (TOML) or a preset: " + ", ".join(PRESETS))
        loaded = Scene.load(self.source, self.package)
        changed = loaded.with_entries(self.entries, self.hold).with_impact(**self.impact)
        if remark and changed.held:
            click.echo(changed.held, err=True)
        return Scene.load(changed) if whole else changed

    def scene_without_impact(self, problem: str) -> Scene:
        """Read the scene for a command with impacts of its own, of which --set may set the spins alone.

        What a user's model requires is not demanded: it may vary.
        """
        for name in self.entries:
            if name.startswith("impact.") and name not in SPINS:
                accepted = "entries that are not of the impact, or " + " and ".join(SPINS)
                raise InputError("--set", name, accepted, problem)
        return self.scene(whole=False)

    def numeric(self, name: str) -> Field | None:
        """The entry of this name if it is a number, of a user's model too."""
        entry = fields(self.package).get(name)
        return entry if entry is not None and entry.numeric else None

    def varying(self, name: str, text: str, label: str, others: Mapping[str, Any] | None = None) -> Field:
        """The entry that an option varies; InputError for another name, or one that is given otherwise too."""
        from ..many.arguments import check_varies

        check_varies(name, text, label, self.package)
        if name in (others or {}) or name in self.entries:
            other = "twice" if name in (others or {}) else "together with --set"
            raise InputError(label, name, "every entry once", f"is given {other}")
        return fields(self.package)[name]


def refuse(given: Mapping[str, Any], accepted: str, problem: str = "") -> None:
    """Raise InputError for the first of these options that is present."""
    for option, value in given.items():
        if value:
            text = ",".join(value) if isinstance(value, list) else value[0] if isinstance(value, tuple) else value
            raise InputError(option, text, accepted.format(option), problem)


def several(source: Sequence[str], **given: Any) -> list[SceneRequest]:
    """The requests of several scenes with the same options."""
    return [SceneRequest.check(name, **given) for name in source or (None,)]


def impact_of(**given: str | None) -> dict[str, str]:
    """The texts of an impact; InputError if it is set by more than one of its speeds and the Stokes number."""
    typed = passed(**given)
    first, *more = [key for key in typed if key != "angle"] or [""]
    if more:
        accepted = "only one of " + ", ".join(flag(name.partition(".")[2]) for name in SPEEDS)
        problem = f"is given together with {flag(first)} = {typed[first]}"
        raise InputError(flag(more[0]), typed[more[0]], accepted, problem)
    return typed


def _entries(changes: Sequence[str], package: Package | None) -> dict[str, str]:
    """The entries of --set by dotted name, each checked by itself."""
    values, schema = assigned(_CHANGE, changes, "--set"), fields(package)
    for name, value in values.items():
        if name != "name":
            if name not in schema:
                raise unknown(name, value, package)
            values[name] = with_degrees(schema[name], value)
            schema[name].read(values[name])
    return values


SHARED |= options_of(
    """
    SCENE (source):
    --stokes S: Normal Stokes number.
    --speed V: Normal speed with its unit, as "0.54 m/s".
    --relative-speed V: Magnitude of the relative velocity, as "1.08 m/s".
    --angle A: Impact angle, as 60 (degrees) or "1.05 rad".
    --set NAME=VALUE (changes): Another entry, as liquid.viscosity="3 Pa s"; repeatable.
    --hold WHAT: What the impact keeps when entries change: speed, stokes, relative_speed [the kind of speed that it
        is given by; of a Stokes number the normal speed].
    --model DIR: A user's model, which is run: folder of `generate`, or MODEL.py.
    --json (as_json): One JSON object instead of a table.
    --plot FILE.png: Draw a picture: .png, .pdf or .svg.
    -o FILE (output): Write to FILE instead of standard output.
    --rtol R: Relative tolerance, 1e-13..1e-3 [1e-9].
    --engine E: taylor, or cvodes or rosenbrock, which integrate and check what it has found [taylor; for
        derivatives that it lacks, rosenbrock].
    --uncertainty NAME=VALUE: A standard deviation, as liquid.viscosity="5 %" or impact.angle="1 deg"; repeatable.
    --prior NAME=PRIOR: What is known of an entry, as particles.roughness="2 um +- 20 %"; repeatable.
""".strip("\n")
)
for _name, _read in (
    ("uncertainty", lambda given: typed(assigned(_DEVIATION, given))),
    ("prior", partial(assigned, _PRIOR)),
    ("rtol", check_rtol),
    ("engine", check_engine),
):
    SHARED[_name] = replace(SHARED[_name], read=_read)
_IMPACT = ("source", "stokes", "speed", "relative_speed", "angle", "changes", "hold", "model")


def group(read: Any, *names: str) -> Group:
    """Options that commands share, read together."""
    return Group(read, {name: SHARED[name] for name in names})


Request = Annotated[SceneRequest, group(partial(SceneRequest.check, varies=False), *_IMPACT)]
Varied = Annotated[SceneRequest, group(SceneRequest.check, *_IMPACT)]
"""For a command that varies entries itself, which --hold concerns as well."""
Entries = Annotated[SceneRequest, group(SceneRequest.check, "source", "changes", "model")]
Impact = Annotated[dict[str, str], group(impact_of, *_IMPACT[1:5])]
"""The texts of an impact, or of ranges of impacts, for a command that reads them itself."""
Changes = Annotated[dict[str, str], lambda given: typed(assigned(_CHANGE, given))]
"""Entries of --set, unchecked; they apply to a scene that is read later."""


# ---- results


@dataclass(frozen=True)
class Output:
    """Where a result goes, and in which form."""

    as_json: bool = False
    picture: Path | None = None
    file: Path | None = None

    @classmethod
    def check(cls, as_json: bool = False, plot: str | None = None, output: str | None = None) -> Output:
        """Check the two files; InputError naming the option that cannot be written."""
        picture = None if plot is None else files.check_file(plot, "--plot", files.PICTURES)
        file = None if output is None else files.check_file(output, "-o")
        check_apart(file, picture, "--plot")
        return cls(as_json, picture, file)

    def put(self, text: str, record: Mapping[str, Any] | None = None, drawn: Any = None) -> None:
        """Write the text, or the record as JSON if that is requested, and draw the picture as far as requested."""
        if self.as_json and record is not None:
            text = json_text(record)
        if self.file is None:
            click.echo(text)
        else:
            files.write(self.file, text + "\n")
        if self.picture is not None and drawn is not None:
            drawn.plot(self.picture)

    def show(self, result: Any, drawn: Any = None) -> None:
        """Write a result and draw its picture, or that of another result, as far as requested.

        A result that has `to_csv` goes to FILE.csv as that, and is shown as well.
        """
        output = self
        if self.file is not None and self.file.suffix == ".csv" and hasattr(result, "to_csv"):
            files.write(self.file, result.to_csv())
            output = replace(self, file=None)
        if self.as_json:
            output.put("", result.to_dict(), drawn or result)
        else:
            output.put(str(result), drawn=drawn or result)


def json_text(record: Mapping[str, Any], ensure_ascii: bool = True) -> str:
    """A record as JSON, in which a number is finite."""
    return json.dumps(record, indent=2, allow_nan=False, ensure_ascii=ensure_ascii)


def dataset_text(data: xarray.Dataset) -> str:
    """A dataset as JSON, which `xarray.Dataset.from_dict` reads; null where there is no value."""
    from ..scene.origin import plain

    return json_text(plain(data.to_dict(), gaps=True))


Shown = Annotated[Output, group(Output.check, "as_json", "plot", "output")]
Written = Annotated[Output, group(Output.check, "as_json", "output")]
WrittenText = Annotated[Output, group(Output.check, "output")]


def check_apart(file: Path | None, other: Path | None, option: str) -> None:
    """Raise InputError if -o and another option name the same file."""
    if file is not None and other is not None and file.resolve() == other.resolve():
        raise InputError("-o", str(file), "two different files", f"is given to {option} as well")
