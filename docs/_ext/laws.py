"""A page for each slot of the equations: its laws with equation, parameters, range and source, and a plot of all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import sympy as sp
from matplotlib.figure import Figure
from wetdoublet.derive.emit.document.latex import latex
from wetdoublet.derive.emit.document.theory import Equation, theory
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics.law import Law
from wetdoublet.derive.vocabulary.quantities import VOCABULARY


@dataclass(frozen=True)
class Slot:
    """A slot: title, entry of a scene that chooses its law, and which lines of the theory are the law's."""

    title: str
    entry: str
    lines: Callable[[Equation], bool]


SLOTS = {
    "bridge": Slot("Capillary bridge", "bridge.law", lambda e: e.group == "Capillary bridge"),
    "film": Slot(
        "Normal lubrication", "model.film", lambda e: e.group == "Lubrication" and not e.left.startswith("F_{L,t}")
    ),
    "shear": Slot("Tangential lubrication", "model.tangential", lambda e: e.left.startswith("F_{L,t}")),
    "arm": Slot("Lever arm", "model.arm", lambda e: e.group == "Motion" and "arm" in e.note),
    "glass": Slot("Glass criterion", "model.glass", lambda e: "glass" in e.note),
    "strings": Slot("Pendulum strings", "pendulum.law", lambda e: e.group == "Pendulum strings"),
    "attraction": Slot("Van der Waals attraction", "", lambda e: e.left.startswith("F_w")),
}


def pages() -> dict[str, str]:
    """The list of laws, and a page for each slot."""
    lines = ["# Laws", "", "Every law that a scene can choose, as it is in the equations of the solvers."]
    lines += ["[A law of your own](../../tutorials/own-law.md) takes the place of any of them.", ""]
    for name, slot in SLOTS.items():
        lines += [f"## {slot.title}", "", _chosen(slot), ""]
        for law in LAWS[name].values():
            lines += [f"[`{law.name}`]({name}.md#{law.name})", f": {law.meaning}", ""]
    lines += ["```{toctree}", ":hidden:", "", *SLOTS, "```", ""]
    texts = {"reference/laws/index.md": "\n".join(lines)}
    longest = max(len(LAWS[name]) for name in SLOTS)  # one theory has a law of every slot
    theories = [theory({name: [*LAWS[name]][k % len(LAWS[name])] for name in SLOTS}) for k in range(longest)]
    return texts | {f"reference/laws/{name}.md": "\n".join(_page(name, slot, theories)) for name, slot in SLOTS.items()}


def _chosen(slot: Slot) -> str:
    return f"Chosen by `{slot.entry}`." if slot.entry else "On with the table `[attraction]`."


def _page(name: str, slot: Slot, theories: list[tuple[Equation, ...]]) -> list[str]:
    lines = [f"# {slot.title}", "", _chosen(slot), ""]
    if name in PLOTS:
        lines += [f"```{{image}} {name}.svg", f":alt: {slot.title}, all laws", ":class: drawing", "```", ""]
        lines += [PLOTS[name].caption, ""]
    own = {law: [*filter(slot.lines, equations)] for law, equations in zip(LAWS[name].values(), theories, strict=False)}
    lines += ["| symbol | meaning | unit |", "|---|---|---|"]
    lines += [f"| ${q.latex}$ | {q.meaning.replace('|', ' ')} | {q.unit} |" for q in _quantities(own)]
    for law, equations in own.items():
        notes = dict.fromkeys(line.note for line in equations if line.note and line.note != law.source)
        lines += ["", f"## {law.name}", "", f"{_capital(law.meaning)}.", ""]
        lines += [text for line in equations for text in ("$$", line.latex, "$$", "")]
        lines += [*(f"* {_capital(note)}" for note in notes), ""]
        lines += [f"**Range**: {_range(law)}", "", f"**Source**: {_capital(law.source)}."]
        if any(function.name == "rupture_distance" for function in law.functions):
            lines += ["", _rupture(law)]
    return [*lines, ""]


def _capital(text: str) -> str:
    return text[0].upper() + text[1:] if text[:1].isalpha() and text[1:2].isalpha() else text


def _quantities(own: dict[Law, list[Equation]]) -> list[Any]:
    """What the equations of the laws take from outside: neither intermediates of a law nor left sides."""
    names: dict[str, None] = {}
    for law, equations in own.items():
        inside = {symbol.name for function in law.functions for symbol, _ in function.definitions}
        symbols = (s.name for line in equations for s in sorted(line.expression.free_symbols, key=str))
        names |= dict.fromkeys(symbol for symbol in symbols if symbol not in inside)
    return [VOCABULARY[name] for name in names if name in VOCABULARY]


def _range(law: Law) -> str:
    if not law.validity:
        return "the source states none, and none is claimed."
    limits = []
    for name, symbol, unit, scale in (
        ("volume", "$V/R^3$", "", 1.0),
        ("contact_angle", r"$\phi$", " deg", 180 / np.pi),
        ("separation", "$x/R$", "", 1.0),
    ):
        for bound, value in zip(("at least", "at most"), dict(law.validity).get(name, (None, None)), strict=True):
            limits += [f"{symbol} {bound} {float(value) * scale:g}{unit}"] if value is not None else []
    return f"{', '.join(limits)} ({law.source}). Outside, the law is computed all the same, with a warning."


def _rupture(law: Law) -> str:
    function = law["rupture_distance"]
    source = function.doc.rpartition("Source: ")[2].rstrip(".")
    printed = {n: sp.Float(str(float(n))) for n in function.result.atoms(sp.Rational) if n.q >= 50}
    distance = latex(function.result.xreplace(printed))
    return f'Rupture distance with `bridge.rupture = "own"`: $x_f/R = {distance}$ ({source}).'


@dataclass(frozen=True)
class Plot:
    """Curves of all laws of a slot: caption, abscissae, ordinates of a law, and settings of the axes."""

    caption: str
    x: np.ndarray
    y: Callable[[Law, np.ndarray], np.ndarray]
    axes: dict[str, Any]


def _curve(law: Law, name: str, *values: Any) -> np.ndarray:
    function = law[name]
    arguments = sp.symbols(f"_0:{len(function.arguments)}", positive=True)
    evaluated = sp.lambdify(arguments, function(*arguments), "numpy")(*values)
    return np.broadcast_to(np.asarray(evaluated, float), np.broadcast_shapes(*(np.shape(v) for v in values)))


def _film(law: Law, x: np.ndarray) -> np.ndarray:
    given = {"gap": x, "aspect": _ASPECT, "volume": 0.1}
    force = _curve(law, "resistance", *(given[symbol.name] for symbol in law["resistance"].arguments))
    return np.where((x < 1) | (law.name == "constant-volume"), force, np.nan)


def _shear(law: Law, x: np.ndarray) -> np.ndarray:
    return np.where(x <= _curve(law, "edge", _ASPECT), _curve(law, "log_factor", x, _ASPECT), np.nan)


_ASPECT, _VOLUME, _RATIO = 0.16, 0.01, 100.0
_GAP = "gap over film thickness, $x/x_0$"
PLOTS = {
    "bridge": Plot(
        r"Attraction over $\pi R \sigma$ for $V/R^3 = 0.01$ and a contact angle of 0, up to the common rupture gap.",
        np.linspace(1e-3, _VOLUME ** (1 / 3), 200),
        lambda law, x: _curve(law, "force", x, _VOLUME, 0.0),
        {"xlabel": "gap over radius, $x/R$", "ylabel": r"$F_c/(\pi R \sigma)$", "ylim": (0, 3)},
    ),
    "film": Plot(
        "Normal force over $6 \\pi \\mu a^2 u/x_0$; `constant-volume` for $V/R^3 = 0.1$ and $x_0/a = 0.16$.",
        np.linspace(0.02, 2, 400),
        _film,
        {"xlabel": _GAP, "ylabel": r"$F_n x_0/(6 \pi \mu a^2 u)$", "yscale": "log", "ylim": (1e-3, 60)},
    ),
    "shear": Plot(
        r"Tangential force over $8 \pi \mu a^2 (\omega - \xi)$ for $x_0/a = 0.16$.",
        np.geomspace(0.02, 2 / _ASPECT, 200),
        _shear,
        {"xlabel": _GAP, "ylabel": "logarithm", "xscale": "log"},
    ),
    "glass": Plot(
        r"Pressure on the axis over $3 \mu a v_0/x_0^2$ at $u = -v_0$.",
        np.linspace(0.05, 0.999, 200),
        lambda law, x: _curve(law, "pressure", x, 1.0),
        {"xlabel": _GAP, "ylabel": r"$p x_0^2/(3 \mu a v_0)$", "yscale": "log", "ylim": (1e-2, None)},
    ),
    "strings": Plot(
        "Horizontal restoring force over the weight of a sphere, for $l/a = 100$.",
        np.linspace(0, 0.7, 100),
        lambda law, x: _curve(law, "stiffness", _RATIO, (x * _RATIO) ** 2) * x * _RATIO,
        {"xlabel": "swing over string length, $d/l$", "ylabel": "force/weight"},
    ),
}
"""Slots of more than one law."""


def plots(folder: Path) -> None:
    """Draw the laws of every slot that has a choice."""
    with mpl.rc_context({"svg.hashsalt": "wetdoublet", "font.size": 11}):
        for name, plot in PLOTS.items():
            figure = Figure(figsize=(6, 3.6), layout="constrained")
            axes = figure.subplots()
            for law, style in zip(LAWS[name].values(), ("-", "--", "-.", ":") * 2):
                axes.plot(plot.x, plot.y(law, plot.x), style, label=law.name)
            axes.set(**plot.axes)
            axes.legend(frameon=False, fontsize=9)
            axes.spines[["top", "right"]].set_visible(False)
            figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
