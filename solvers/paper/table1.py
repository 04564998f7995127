"""Table 1: the theory as typeset equations, from the derivation."""

from __future__ import annotations

import textwrap
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..formatting.style import INK, NOTE
from ..scene.scene import Scene
from .report import BRIDGED, PENDULUM, Part, Picture, described, sheet

if TYPE_CHECKING:
    from ...derive.emit.document.theory import Equation

_WIDTH = 17.5  # cm; the table spans both columns
_TALL, _LOW, _HEAD, _MARGIN = 0.98, 0.58, 0.7, 0.25  # cm; lines with and without a fraction, headings
_WRAP = 37  # characters of a note on a line without a formula


def table1(folder: Path) -> Part:
    """The equations of the presets' laws, typeset."""
    bridged, hung = Scene.load(BRIDGED), Scene.load(PENDULUM)
    assert bridged.bridge is not None
    assert hung.pendulum is not None
    from ...derive.emit.document.theory import theory  # imports sympy

    model = bridged.model
    laws = {"arm": model.arm, "shear": model.tangential, "glass": model.glass}
    equations = theory(laws | {"bridge": bridged.bridge.law, "strings": hung.pendulum.law})
    _draw(equations, folder / "table1.png")
    words = (
        "The equations of the model in SI, written by the derivation in the symbols of its vocabulary; nothing is "
        f"typed in. Laws: {described(bridged)}; {described(hung)}. The paper's own table is a "
        "picture that its text does not have: these are rebuilt from first principles and held against what it prints."
    )
    picture = Picture("table1.png", "Table 1: theory; `wetdoublet export SCENE --to latex` writes a document.")
    formulas = tuple((line.group, line.latex, line.note) for line in equations)
    return Part("Table 1: theory", words, pictures=(picture,), formulas=formulas)


def _draw(lines: tuple[Equation, ...], file: Path) -> None:
    """Draw the groups in two columns of nearly equal height."""
    groups = [list(members) for _, members in groupby(lines, key=lambda line: line.group)]
    sizes = [_HEAD + sum(map(_height, members)) for members in groups]
    split = min(range(1, len(groups)), key=lambda k: max(sum(sizes[:k]), sum(sizes[k:])))
    height = max(sum(sizes[:split]), sum(sizes[split:])) + 2 * _MARGIN
    with sheet(file, height, _WIDTH) as figure:
        figure.set_layout_engine("none")

        def put(x: float, y: float, text: str, **style: Any) -> None:
            figure.text(x / _WIDTH, y / height, text, va="center", **style)

        for column, part in enumerate((groups[:split], groups[split:])):
            left, right = _MARGIN + column * _WIDTH / 2, (column + 1) * _WIDTH / 2 - _MARGIN
            place = height - _MARGIN
            for members in part:
                put(left, place - 0.4 * _HEAD, members[0].group, fontsize=8.5, fontweight="bold", color=INK)
                place -= _HEAD
                for line in members:
                    middle = place - _height(line) / 2
                    formula = line.latex.replace(r"\frac", r"\dfrac")
                    put(left + _MARGIN, middle, f"${formula}$", fontsize=8, math_fontfamily="cm", color=INK)
                    note = textwrap.fill(line.note, _WRAP - len(line.latex) // 8, break_long_words=False)
                    put(right, middle, note, fontsize=6.5, color=NOTE, ha="right")
                    place -= _height(line)


def _height(line: Equation) -> float:
    return _TALL if "frac" in line.latex else _LOW
