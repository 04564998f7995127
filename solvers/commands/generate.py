"""`wetdoublet generate`: derive the equations and emit them."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import CheckFailed, InputError
from . import options

OWN = Path(__file__).resolve().parents[2] / "generated"  # found, not imported: it may be stale or broken


_SHOWN = 5  # extra files named in the message; the listing has them all


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
        raise CheckFailed(_advice(differences))


def _advice(differences: list[str]) -> str:
    """What to do about lines of `write.check`: emitting again mends a file and makes one, but removes none."""
    extra = [str(OWN / line.removeprefix("extra: ")) for line in differences if line.startswith("extra: ")]
    parts = []
    if len(extra) < len(differences):
        parts.append(f"`wetdoublet generate` would mend {OWN}")
    if extra:
        more = f" and {len(extra) - _SHOWN} more" if len(extra) > _SHOWN else ""
        parts.append(f"nothing emits {', '.join(extra[:_SHOWN])}{more}: to be removed by hand")
    return f"generated/ is not what derive/ emits; {'; '.join(parts)}"
