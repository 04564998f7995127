"""`reproduce()`: the parts of the paper, one after the other, and the report on them; Table 1 from the derivation."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from importlib.metadata import version
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from ...host.emitted import deriving
from ...host.files import write
from ...host.progress import Progress
from ...scene.scene import Scene
from .granules import factors, fig4a, fig4b
from .pendulum import fig1, fig3
from .report import BRIDGED, PENDULUM, Part, report


def table1(_folder: Path) -> Part:
    """The equations of the presets' laws, typeset."""
    bridged, hung = Scene.load(BRIDGED), Scene.load(PENDULUM)
    assert bridged.bridge is not None
    assert hung.pendulum is not None
    model = bridged.model
    laws = {"arm": model.arm, "shear": model.tangential, "glass": model.glass}
    laws |= {"bridge": bridged.bridge.law, "strings": hung.pendulum.law}

    def lines_of_theory() -> list[tuple[str, str, str]]:
        from ....derive.emit.document.theory import theory  # imports sympy

        return [(line.group, line.latex, line.note) for line in theory(laws)]

    with deriving():
        from ....derive.equations.store import stored

        equations = stored(f"theory-{'-'.join(laws.values())}", lines_of_theory)
    words = (
        "The equations of the presets in SI, written by the derivation in the symbols of its vocabulary; nothing is "
        "typed in. The paper's own table is a picture that its text does not have: these are rebuilt from first "
        "principles and held against what it prints. `wetdoublet export SCENE --to latex` writes a document."
    )
    blocks = [words]
    for heading, lines in groupby(equations, key=itemgetter(0)):
        blocks.append(f"### {heading}")
        for _, latex, note in lines:
            blocks += [text for text in (f"$$ {latex} $$", note) if text]
    return Part("Table 1: theory", "\n\n".join(blocks))


PARTS: dict[str, Callable[[Path], Part]] = {
    "table1": table1, "fig1": fig1, "fig3": fig3, "fig4a": fig4a, "fig4b": fig4b, "factors": factors,
}  # fmt: skip
"""From the output folder to what the report says."""


def reproduce(which: Sequence[str], folder: Path, *, progress: Progress | None = None) -> list[Path]:
    """Compute parts of the paper and write the report on them.

    Arguments:
        which: names from PARTS.
        folder: output folder; created if absent.
        progress: called with (parts done, parts in all).

    Returns:
        Paths of the written files, the report's last.

    Raises:
        KeyboardInterrupt: an interrupt; the report on the parts that were finished is written before.
    """
    folder.mkdir(parents=True, exist_ok=True)
    file, stopped = folder / "report.md", None
    parts: list[Part] = []
    try:
        for name in which:
            if progress is not None:
                progress(len(parts), len(which))
            parts.append(PARTS[name](folder))
    except KeyboardInterrupt:
        if not parts:
            raise
        rest = ", ".join(which[len(parts) :])
        stopped = KeyboardInterrupt(f"interrupted: {len(parts)} of {len(which)} parts are in {file}; without {rest}")
    ours, date = f"wetdoublet {version('wetdoublet')}", time.strftime("%Y-%m-%d", time.gmtime())
    how = f"Computed by {ours} in one run on {date}; what is quoted names its source."
    write(file, report(parts, how))
    if stopped is not None:
        raise stopped
    return [*(folder / file for section in parts for file in section.pictures), file]
