"""`wetdoublet generate`: derive the equations and emit them."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import CheckFailed, InputError
from . import options

OWN = Path(__file__).resolve().parents[2] / "generated"  # found, not imported: it may be stale or broken


@click.command("generate", short_help="Derive the equations and emit them as CasADi functions.")
@click.option("--out", metavar="DIR", help="Write there instead of the package's own folder.")
@click.option("--check", is_flag=True, help="Compare the package's own folder, byte for byte, and write nothing.")
@options.debug
def command(out: str | None, check: bool) -> None:
    """Derive the equations and emit them as CasADi functions."""
    if check and out is not None:
        raise InputError("--out", out, "--check alone: it compares the package's own folder", "is given with --check")
    folder = options.check_folder(out) or OWN

    from ...derive.emit import write

    if not check:
        folder.mkdir(parents=True, exist_ok=True)
        click.echo("\n".join(str(path) for path in write.generate(folder)))
    elif differences := write.check():
        click.echo("\n".join(differences))
        raise CheckFailed(f"generated/ is not what derive/ emits; `wetdoublet generate` would mend {OWN}")
