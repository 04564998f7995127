"""`wetdoublet generate`: derive the equations and emit them, the library's or a user's model."""

import json
import re
from pathlib import Path

import click

from ..errors import CheckFailed, InputError
from ..formatting.markdown import aligned
from ..host.files import differing, write_all_in
from . import options
from .signature import as_command, passed

OWN = Path(__file__).resolve().parents[2] / "generated"  # not imported: may be stale or broken
_READS = re.compile(rb"^\s*(import|from)\s(?!wetdoublet)|\b(open|exec|eval|__import__)\(", re.MULTILINE)
"""What a model file has that may depend on other files."""
_SHOWN = 5  # most extra files named in the message; the listing names all


@as_command("Derive the equations and emit them as CasADi functions.")
def command(model: str | None, out: options.Folder, check: bool, template: bool, names: bool) -> None:
    """Derive the equations and emit them as CasADi functions.

    With MODEL.py, which is run as Python, its laws are derived, checked and emitted into DIR, for --model DIR of the
    other commands.

    \b
    Example:
      wetdoublet generate --template > mine.py
      wetdoublet generate mine.py --out mine
      wetdoublet collide granulation --model mine --set custom.yield_stress="50 Pa"

    Options:
        [MODEL.py] (model):
        --out DIR: Output folder; required for a model.
        --check: Compare with the files there, byte for byte, and write nothing.
        --template: Print a model file that runs as it is.
        --names: Print the names that a model file has, with units.
    """  # noqa: D301 # click wants the character itself
    if template or names:
        alone = "--template" if template else "--names"
        others = {"MODEL.py": model, "--out": out, "--check": check or None, "--names": (names and template) or None}
        for option, value in passed(**others).items():
            raise InputError(option, value, f"{alone} alone: it prints and writes nothing", f"is given with {alone}")
        from ...derive import user
        from ...derive.user.names import listed
        from ...derive.user.template import TEMPLATE

        click.echo(TEMPLATE.rstrip("\n") if template else listed(vars(user)))
        return
    if model is not None:
        _model(Path(model), out, check)
        return
    if check and out is not None:
        accepted = "--check alone: it compares the package's own folder"
        raise InputError("--out", str(out), accepted, "is given with --check")

    if not check and out is None and not (OWN.parent / "pyproject.toml").is_file():
        problem = f"is missing, and the emitted files of the installed package in {OWN} would be rewritten"
        raise InputError("--out", None, "--out DIR, or --check, which compares and writes nothing", problem)

    from ...derive.emit import write

    if not check:
        files, folder = write.emitted(), out or OWN
        written = write_all_in(folder, differing(folder, files))
        as_before = [f"{len(files) - len(written)} files as before"] * (len(files) > len(written))
        click.echo("\n".join([*map(str, written), *as_before]))
    elif differences := write.check():
        click.echo("\n".join(differences))
        raise CheckFailed(_advice(differences))


def _model(source: Path, folder: Path | None, check: bool) -> None:
    """Derive, check and emit a user's model, and print its description and what has changed."""
    if folder is None:
        raise InputError("--out", None, "a folder for the emitted model")
    if folder.resolve() == OWN:
        raise InputError("--out", str(folder), "a folder of its own for a model", "is the package's own folder")

    from ..host.user_cache import fetch, lookup
    from ..scene.user_model_derived import derived_package, origin_of
    from ..scene.user_model_source import key_of

    content = source.read_bytes() if source.is_file() else b""
    key = "" if _READS.search(content) else key_of(content, origin_of(source, folder))
    before = lookup(key) if key and not check else None
    if before is not None and not differing(folder, files := json.loads(before)):
        click.echo(f"nothing has changed: the {len(files)} files in {folder} are what {source} gives")
        return
    derived = derived_package(source, folder)
    click.echo(derived.report)
    if not derived.files:
        raise CheckFailed(f"{source}: {derived.failed}")
    new = differing(folder, derived.files)
    if check:
        if new:
            click.echo("\n".join(f"{'differs' if (folder / name).is_file() else 'missing'}: {name}" for name in new))
            remedy = f"`wetdoublet generate {source} --out {folder}` mends it"
            raise CheckFailed(f"{folder} is not what {source} gives; {remedy}")
        return
    removed = [folder / name for name in _listed(folder) - derived.files.keys()]
    rows = [("written", path) for path in write_all_in(folder, new)] + [("removed", path) for path in removed]
    for path in removed:
        path.unlink(missing_ok=True)
    if key:
        fetch(key, json.dumps(dict(derived.files)).encode)
    times = aligned([(step, f"{took:.1f} s") for step, took in derived.seconds.items()])
    click.echo("\n".join(["", *(f"{word}  {path}" for word, path in rows), "", *times, ""]))
    click.echo(f"{len(derived.files)} files in {folder}; use it with --model {folder}")
    click.echo(f"its effect on the map: wetdoublet diff library {folder}")


def _listed(folder: Path) -> set[str]:
    """Relative paths of the files of a package in a folder, according to its manifest; other files are not listed."""
    try:
        listed = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError):
        return set()
    inside = folder.resolve()
    return {name for name in listed if inside in (folder / name).resolve().parents}


def _advice(differences: list[str]) -> str:
    """The remedy for findings of `write.check`. Emitting again repairs or creates files, but removes none."""
    extra = [str(OWN / line.removeprefix("extra: ")) for line in differences if line.startswith("extra: ")]
    parts = [f"`wetdoublet generate` would mend {OWN}"] if len(extra) < len(differences) else []
    if extra:
        more = f" and {len(extra) - _SHOWN} more" if len(extra) > _SHOWN else ""
        parts.append(f"nothing emits {', '.join(extra[:_SHOWN])}{more}: to be removed by hand")
    return f"generated/ is not what derive/ emits; {'; '.join(parts)}"
