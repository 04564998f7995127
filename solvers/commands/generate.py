"""`wetdoublet generate`: derive the equations and emit them, the library's or a user's model."""

from pathlib import Path

import click

from ..errors import CheckFailed, InputError
from ..host.files import write_all_in
from . import options
from .signature import as_command, passed

OWN = Path(__file__).resolve().parents[2] / "generated"  # not imported: may be stale or broken
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
        _model(model, out, check)
        return
    if check and out is not None:
        accepted = "--check alone: it compares the package's own folder"
        raise InputError("--out", str(out), accepted, "is given with --check")

    if not check and out is None and not (OWN.parent / "pyproject.toml").is_file():
        problem = f"is missing, and the emitted files of the installed package in {OWN} would be rewritten"
        raise InputError("--out", None, "--out DIR, or --check, which compares and writes nothing", problem)

    from ...derive.emit import write

    if not check:
        click.echo("\n".join(map(str, write_all_in(out or OWN, write.emitted()))))
    elif differences := write.check():
        click.echo("\n".join(differences))
        raise CheckFailed(_advice(differences))


def _model(source: str, folder: Path | None, check: bool) -> None:
    """Derive, check and emit a user's model, and print its description."""
    if folder is None:
        raise InputError("--out", None, "a folder for the emitted model")
    if folder.resolve() == OWN:
        raise InputError("--out", str(folder), "a folder of its own for a model", "is the package's own folder")

    from ..scene.user_model_derived import derived_package

    derived = derived_package(Path(source), folder)
    click.echo(derived.report)
    if not derived.files:
        raise CheckFailed(f"{source}: {derived.failed}")

    from ...derive.emit import user

    if check:
        if lines := user.differences(derived.files, folder):
            click.echo("\n".join(lines))
            remedy = f"`wetdoublet generate {source} --out {folder}` mends it"
            raise CheckFailed(f"{folder} is not what {source} gives; {remedy}")
        return
    before = user.earlier(folder)
    written = write_all_in(folder, derived.files)
    for name in before - derived.files.keys():
        (folder / name).unlink(missing_ok=True)
    click.echo(f"\n{len(written)} files in {folder}; use it with --model {folder}")


def _advice(differences: list[str]) -> str:
    """The remedy for findings of `write.check`. Emitting again repairs or creates files, but removes none."""
    extra = [str(OWN / line.removeprefix("extra: ")) for line in differences if line.startswith("extra: ")]
    parts = [f"`wetdoublet generate` would mend {OWN}"] if len(extra) < len(differences) else []
    if extra:
        more = f" and {len(extra) - _SHOWN} more" if len(extra) > _SHOWN else ""
        parts.append(f"nothing emits {', '.join(extra[:_SHOWN])}{more}: to be removed by hand")
    return f"generated/ is not what derive/ emits; {'; '.join(parts)}"
