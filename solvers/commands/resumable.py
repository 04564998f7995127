"""The journal of a command that continues an interrupted run, and what the command reports of it."""

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path

import click

from ..many.journal import Journal, beside
from .bar import Bar


@contextmanager
def resumable(
    file: Path | None, unit: str, stored: bool = False, cheaper: str = ""
) -> Iterator[tuple[Journal | None, Bar]]:
    """The journal beside the file, locked, and a progress bar; after an interrupt finished work stays in the journal.

    Arguments:
        unit: name of what is counted.
        stored: the file is a Zarr store, which is kept with its journal.
        cheaper: what a forecast names as the cheaper way.
    """
    journal = None if file is None else beside(file)
    created = journal is not None and not journal.path.exists()
    try:
        with journal.locked("-o", file) if journal else nullcontext(), Bar(unit, cheaper) as progress:
            yield journal, progress
    except (KeyboardInterrupt, OSError) as error:
        count = 0 if journal is None else journal.count()  # of the file: progress may lag
        if journal is None or not count:
            if isinstance(error, OSError) and journal is not None and created:
                journal.path.unlink(missing_ok=True)  # it holds no finished block
            raise
        where = f"{file}.*.unfinished and {journal.path}" if stored else str(journal.path)
        kept = f"{count} of {progress.total} {unit} are kept in {where}"
        if isinstance(error, KeyboardInterrupt):
            raise KeyboardInterrupt(f"interrupted: {kept}; the same command computes the rest") from None
        rest = f"the same command computes {'the rest' if count < (progress.total or 0) else 'nothing again'}"
        raise OSError(error.errno, f"{error.strerror or error} ({kept}; {rest})", error.filename) from error
    if journal is not None and journal.path.exists():
        others, lines = journal.others()
        content = [f"{others} finished {unit} of another request"] if others else []
        content += [f"{lines} lines that are no finished {unit}"] if lines else []
        click.echo(f"{journal.path} was there already and stays: it holds {' and '.join(content)}", err=True)
