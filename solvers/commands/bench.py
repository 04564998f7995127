"""`wetdoublet bench`: run time against achieved error."""

from __future__ import annotations

import sys

import click

from . import options


@click.command("bench", short_help="Run time against error, beside the peers that are installed.")
@click.option("--out", metavar="DIR", default="bench", help="Folder for bench.json, bench.md and plots [bench].")
@options.debug
def command(out: str) -> None:
    """Measure our engines and scipy's LSODA and Radau on the same collisions, with the same stop rule.

    Takes a minute or two, the first time longer: integrators are compiled. How busy the machine was is in the record.
    """
    folder = options.check_folder(out)
    assert folder is not None  # --out has a default

    from ..benchmarks.record import write
    from ..benchmarks.run import bench

    record = bench(tell=_tell if sys.stderr.isatty() else lambda _: None)
    if sys.stderr.isatty():
        _tell("")
    text, files = write(record, folder)
    click.echo(text)
    click.echo("written: " + ", ".join(map(str, files)))


def _tell(what: str) -> None:
    """Say what goes on, in one line of the terminal."""
    click.echo(f"\r\x1b[K{what}", nl=False, err=True)
