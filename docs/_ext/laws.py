"""A page for every law: its equation from the derivation, parameters, range, source, and a plot."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import sympy as sp
from matplotlib.figure import Figure
from wetdoublet.derive.emit.document.theory import Equation, theory
from wetdoublet.derive.physics.laws import LAWS, Law
from wetdoublet.derive.vocabulary.quantities import VOCABULARY

SLOTS = {
    "bridge": ("Capillary bridge", "bridge.law"),
    "film": ("Normal lubrication", "model.film"),
    "shear": ("Tangential lubrication", "model.tangential"),
    "arm": ("Lever arm", "model.arm"),
    "glass": ("Glass criterion", "model.glass"),
    "strings": ("Pendulum strings", "pendulum.law"),
    "attraction": ("Van der Waals attraction", ""),
}
"""Slot -> title, and the entry of a scene that chooses its law."""

_ASPECT, _VOLUMES, _RATIO = 0.16, (0.001, 0.01, 0.1), 100.0
_COLOURS = ("#2a6f97", "#c1554a", "#3b8b5a")
_GREY = "#9a9a9a"


def pages() -> dict[str, str]:
    """The list of laws, and a page each."""
    found = {"reference/laws/index.md": _index()}
    return found | {
        f"reference/laws/{_file(law)}.md": _page(slot, law) for slot in SLOTS for law in LAWS[slot].values()
    }


def _file(law: Law) -> str:
    return f"{law.slot}-{law.name}"


def _index() -> str:
    lines = [
        "# Laws",
        "",
        "Every law that a scene can choose. Equations are emitted from the derivation that the solvers are made from.",
        "To add one of your own, see [](../../tutorials/own-law.md).",
        "",
    ]
    for slot, (title, entry) in SLOTS.items():
        lines += [f"## {title}", "", f"Chosen by `{entry}`." if entry else "On with the table `[attraction]`.", ""]
        for law in LAWS[slot].values():
            lines += [f"[`{law.name}`]({_file(law)}.md)", f": {law.meaning}", ""]
        listed = [f"{law.name} <{_file(law)}>" for law in LAWS[slot].values()]
        lines += ["```{toctree}", ":hidden:", "", *listed, "```", ""]
    return "\n".join(lines)


def _page(slot: str, law: Law) -> str:
    title, entry = SLOTS[slot]
    chosen = f'`{entry} = "{law.name}"`' if entry else "on with the table `[attraction]`"
    equations = _equations(law)
    lines = [
        f"# {title}: {law.name}",
        "",
        f"{_capital(law.meaning)}.",
        "",
        f"In a scene: {chosen}.",
        "",
        "## Equation",
        "",
    ]
    for each in equations:
        lines += ["$$", each.latex, "$$", ""]
    notes = [each.note for each in equations if each.note and each.note != law.source]
    lines += [f"* {_capital(note)}" for note in dict.fromkeys(notes)] + [""]
    lines += ["## Parameters", "", "| symbol | meaning | unit |", "|---|---|---|"]
    lines += [f"| ${q.latex}$ | {q.meaning.replace('|', ' ')} | {q.unit} |" for q in _quantities(law, equations)]
    lines += ["", "## Range", "", _range(law), "", "## Source", "", f"{_capital(law.source)}.", ""]
    if any(each.name == "rupture_distance" for each in law.functions):
        lines += [_rupture(law), ""]
    lines += [
        "## Plot",
        "",
        f"```{{image}} {_file(law)}.svg",
        f":alt: {title}, {law.name}",
        ":class: drawing",
        "```",
        "",
    ]
    return "\n".join([*lines, _caption(slot), ""])


def _capital(text: str) -> str:
    return text[0].upper() + text[1:] if text[:1].isalpha() and text[1:2].isalpha() else text


def _equations(law: Law) -> list[Equation]:
    """The lines of the theory that this law makes."""
    lines = theory({law.slot: law.name})
    picked = {
        "film": lambda e: e.group == "Lubrication" and not e.left.startswith("F_{L,t}"),
        "shear": lambda e: e.left.startswith("F_{L,t}"),
        "arm": lambda e: e.group == "Motion" and "arm" in e.note,
        "glass": lambda e: "glass" in e.note,
        "bridge": lambda e: e.group == "Capillary bridge",
        "strings": lambda e: e.group == "Pendulum strings",
        "attraction": lambda e: e.left.startswith("F_w"),
    }[law.slot]
    return [line for line in lines if picked(line)]


def _quantities(law: Law, equations: list[Equation]) -> list[Any]:
    """What the equations take from outside: neither intermediates of the law nor left sides."""
    inside = {symbol.name for function in law.functions for symbol, _ in function.definitions}
    names = dict.fromkeys(s.name for e in equations for s in sorted(e.expression.free_symbols, key=str))
    return [VOCABULARY[name] for name in names if name in VOCABULARY and name not in inside]


def _range(law: Law) -> str:
    if law.validity is None:
        return "The source states no range, and none is claimed."
    said = []
    for name, symbol, degrees in (
        ("volume", "$V/R^3$", False),
        ("contact_angle", r"$\phi$", True),
        ("separation", "$x/R$", False),
    ):
        low, high = getattr(law.validity, name)
        unit = " deg" if degrees else ""
        scale = 180 / np.pi if degrees else 1.0
        said += [f"{symbol} at least {float(low) * scale:g}{unit}"] if low is not None else []
        said += [f"{symbol} at most {float(high) * scale:g}{unit}"] if high is not None else []
    return f"{', '.join(said)} ({law.validity.source}). Outside, the law is computed all the same, with a warning."


def _rupture(law: Law) -> str:
    from wetdoublet.derive.emit.document.latex import latex

    function = law["rupture_distance"]
    source = function.doc.rpartition("Source: ")[2].rstrip(".")
    printed = {n: sp.Float(str(float(n))) for n in function.result.atoms(sp.Rational) if n.q >= 50}
    distance = latex(function.result.xreplace(printed))
    return f'Rupture distance with `bridge.rupture = "own"`: $x_f/R = {distance}$ ({source}).'


def _caption(slot: str) -> str:
    return {
        "film": f"Normal force over $6 \\pi \\mu a^2 u/x_0$; "
        f"`constant-volume` for $V/R^3 = 0.1$ and $x_0/a = {_ASPECT}$. Other laws of the slot in grey.",
        "shear": f"Tangential force over $8 \\pi \\mu a^2 (\\omega - \\xi)$ "
        f"for $x_0/a = {_ASPECT}$. The other law in grey.",
        "arm": "Lever arm over the sphere radius.",
        "glass": r"Pressure on the axis over $3 \mu a v_0/x_0^2$ at $u = -v_0$. The other law in grey.",
        "bridge": r"Attraction over $\pi R \sigma$ for a contact angle of 0, up to the common rupture distance.",
        "strings": r"Horizontal restoring force over the weight of a sphere, for $l/a = 100$. The other law in grey.",
        "attraction": r"Force over $A a/(6 x_0^2)$.",
    }[slot]


def plots(folder: Path) -> None:
    """Draw every law's plot, where there is none yet."""
    folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context({"svg.hashsalt": "wetdoublet", "font.size": 11}):
        for slot in SLOTS:
            for law in LAWS[slot].values():
                _plot(slot, law, folder / f"{_file(law)}.svg")


def _plot(slot: str, law: Law, file: Path) -> None:
    figure = Figure(figsize=(6, 3.4), layout="constrained")
    axes = figure.subplots()
    if slot == "bridge":
        for volume, colour in zip(_VOLUMES, _COLOURS):
            h = np.linspace(1e-3, volume ** (1 / 3), 200)
            axes.plot(h, _curve(law, "force", h, volume, 0.0), color=colour, label=f"$V/R^3 = {volume:g}$")
        axes.set(xlabel="gap over radius, $x/R$", ylabel=r"$F_c/(\pi R \sigma)$", ylim=(0, None))
        axes.legend(frameon=False)
    else:
        others = [each for each in LAWS[slot].values() if each is not law]
        for each in [*others, law]:
            x, y = _points(slot, each)
            mine = each is law
            axes.plot(x, y, color=_COLOURS[0] if mine else _GREY, lw=2.2 if mine else 1, zorder=3 if mine else 1)
        axes.set(**_LABELS[slot])
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, metadata={"Date": None})


_GAP = "gap over film thickness, $x/x_0$"
_LABELS: dict[str, dict[str, Any]] = {
    "film": {"xlabel": _GAP, "ylabel": r"$F_n x_0/(6 \pi \mu a^2 u)$", "yscale": "log", "ylim": (1e-3, 60)},
    "shear": {"xlabel": _GAP, "ylabel": "logarithm", "xscale": "log"},
    "arm": {"xlabel": "gap over reduced radius, $x/a$", "ylabel": "arm$/R$"},
    "glass": {"xlabel": _GAP, "ylabel": r"$p x_0^2/(3 \mu a v_0)$", "yscale": "log", "ylim": (1e-2, None)},
    "strings": {"xlabel": "swing over string length, $d/l$", "ylabel": "force/weight"},
    "attraction": {"xlabel": _GAP, "ylabel": r"$6 F_w x_0^2/(A a)$", "yscale": "log"},
}


def _points(slot: str, law: Law) -> tuple[np.ndarray, np.ndarray]:
    if slot == "film":
        ends = 2.0 if law.name == "constant-volume" else 1.0
        x = np.linspace(0.02, ends, 300)
        known = {"gap": x, "aspect": _ASPECT, "volume": 0.1}
        return x, _curve(law, "resistance", *(known[s.name] for s in law["resistance"].arguments))
    if slot == "shear":
        edge = float(_curve(law, "edge", np.array([_ASPECT]))[0])
        x = np.geomspace(0.02, edge, 200)
        return x, _curve(law, "log_factor", x, _ASPECT)
    if slot == "arm":
        x = np.linspace(0, 0.5, 50)
        return x, _curve(law, "lever", 4 + x) / 2
    if slot == "glass":
        x = np.linspace(0.05, 0.999, 200)
        return x, _curve(law, "pressure", x, 1.0)
    if slot == "strings":
        swing = np.linspace(0, 0.7, 100)
        return swing, _curve(law, "stiffness", _RATIO, (swing * _RATIO) ** 2) * swing * _RATIO
    x = np.geomspace(0.05, 1, 100)
    return x, _curve(law, "force", x)


def _curve(law: Law, name: str, *values: Any) -> np.ndarray:
    function = law[name]
    arguments = sp.symbols(f"_0:{len(function.arguments)}", positive=True)
    evaluated = sp.lambdify(arguments, function(*arguments), "numpy")(*values)
    return np.broadcast_to(np.asarray(evaluated, float), np.broadcast_shapes(*(np.shape(v) for v in values)))
