r"""Sets a host's force law beside ours: a table (CSV), a picture and a report (Markdown).

    python examples/referee/referee.py granulation --host yade --law lubrication \
        --stokes log:0.02:2:7 --angle 0,45,75 -o yade-lubrication

The host runs by itself (`in_yade.py`, `in_lammps.py`, `in_liggghts.py`), at three time steps; `split.py` says how the
difference is split.
"""

from __future__ import annotations

import argparse
import csv
import math
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import split
import translate
from matplotlib.lines import Line2D
from wetdoublet import Scene

LETTERS = {"stick": "S", "stick-rotate-separate": "SRS", "bounce": "B", "no contact": "-", "not a number": "NaN"}
MARKS = {"stick": "s", "stick-rotate-separate": "^", "bounce": "o", "no contact": "x", "not a number": "*"}


def values(text: str) -> list[float]:
    """`0,45,75`, `0:80:5` or `log:0.02:2:7`: a list, or first, last and count."""
    words = text.removeprefix("log:").split(":")
    if len(words) == 3:
        first, last, count = float(words[0]), float(words[1]), int(words[2])
        spaced = np.geomspace if text.startswith("log:") else np.linspace
        return [float(number) for number in spaced(first, last, count)]
    return [float(word) for word in text.split(",")]


def write_csv(trial: split.Referee, path: Path) -> None:
    """A row a collision; speeds in m/s, angles in degrees, restitutions without unit."""
    names = list(dict.fromkeys(name for row in trial.rows for name in row))
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, names, restval="", lineterminator="\n")
        table.writeheader()
        for row in trial.rows:
            table.writerow({k: f"{v + 0.0:.7g}" if isinstance(v, float) else v for k, v in row.items()})


def draw(trial: split.Referee, path: Path) -> None:
    """Above e_n of both, below the parts of their difference; a column an angle."""
    angles = sorted({row["angle_deg"] for row in trial.rows})
    figure, axes = plt.subplots(
        2,
        len(angles),
        figsize=(3.1 * len(angles) + 1.4, 5.6),
        sharex="col",
        sharey="row",
        squeeze=False,
        layout="constrained",
    )
    colours = dict(zip(trial.terms, mpl.color_sequences["tab10"]))
    for column, angle in zip(axes.T, angles):
        rows = [row for row in trial.rows if row["angle_deg"] == angle]
        St = np.array([row["stokes"] for row in rows])
        above, below = column
        below.margins(y=0.08)
        below.use_sticky_edges = False  # bars keep off the frame
        above.plot(St, [row["e_n_ours"] for row in rows], "k-", lw=1.2, label="wetdoublet")
        above.plot(St, [row["e_n_limit"] for row in rows], "-", color="tab:red", lw=0.8, label=r"host, $dt \to 0$")
        for outcome, mark in MARKS.items():
            for key, whose in (("ours", "k"), ("host", "tab:red")):
                those = [row for row in rows if row[f"outcome_{key}"] == outcome]
                x, y = [row["stokes"] for row in those], [row[f"e_n_{key}"] for row in those]
                above.plot(
                    x, y, mark, color=whose, mfc="none" if key == "host" else whose, ms=8 if key == "host" else 4
                )
        width = np.diff(np.log(St)).min() * 0.7 if len(St) > 1 else 0.3
        up, down = np.zeros(len(rows)), np.zeros(len(rows))
        for term in trial.terms:
            share = np.nan_to_num([row[f"e_n: {term}"] for row in rows])
            base = np.where(share > 0, up, down)
            below.bar(
                St * np.exp(-width / 2),
                share,
                St * (np.exp(width) - 1) * np.exp(-width / 2),
                base,
                align="edge",
                color=colours[term],
                label=term,
            )
            up, down = up + np.maximum(share, 0), down + np.minimum(share, 0)
        whole = [row["e_n_host"] - row["e_n_ours"] for row in rows]
        below.plot(St, whole, "k_", ms=9, label="host - wetdoublet")
        below.axhline(0, color="k", lw=0.5)
        above.set(title=f"{angle:g} deg", xscale="log")
        below.set(xlabel="Stokes number")
    axes[0, 0].set_ylabel("normal restitution")
    axes[1, 0].set_ylabel("parts of the difference")
    outcomes = [
        Line2D([], [], marker=m, ls="", color="0.4", label="no contact" if o == "no contact" else LETTERS[o])
        for o, m in list(MARKS.items())[:4]
    ]
    lines = [*axes[0, 0].get_lines()[:2], *outcomes]
    figure.legend(handles=lines, loc="outside right upper", frameon=False, fontsize=8)
    handles, labels = axes[1, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right lower", frameon=False, fontsize=8)
    figure.suptitle(f"{trial.version}, {trial.law}: open red marks; wetdoublet: filled black", fontsize=10)
    figure.savefig(path, dpi=80)
    plt.close(figure)


def report(trial: split.Referee, scene: Scene, name: str) -> str:
    """The report in Markdown."""

    def number(value: Any) -> str:
        return f"{value + 0.0:.4f}" if isinstance(value, float) and math.isfinite(value) else "-"

    head = ["St", "angle", "ours", "host", "e_n ours", "e_n host", "e_t ours", "e_t host", *trial.terms, "left at dt/4"]
    lines = [
        f"# {scene.name or 'scene'}: {trial.version}, law {trial.law}", "",
        f"![e_n of both, and the parts of the difference]({name}.png)", "",
        "| " + " | ".join(head) + " |", "|" + "---|" * len(head),
    ]  # fmt: skip
    for row in trial.rows:
        words = [
            f"{row['stokes']:.4g}",
            f"{row['angle_deg']:g}",
            LETTERS[row["outcome_ours"]],
            LETTERS[row["outcome_host"]],
        ]
        words += [number(row[key]) for key in ("e_n_ours", "e_n_host", "e_t_ours", "e_t_host")]
        words += [number(row[f"e_n: {term}"]) for term in trial.terms] + [f"{row['e_n: left at dt/4'] + 0.0:.1e}"]
        lines.append("| " + " | ".join(words) + " |")
    limit = "the host's law integrated as differential equations" if trial.exact else "extrapolated from the last two"
    lines += ["", f"Time step {trial.step:.3g} s, and a half and a quarter of it. Its limit: {limit}."]
    lines += ["", f"`rest`: {trial.translation.rest}.", "", "What has no counterpart or was assumed:", ""]
    lines += [f"* {words}" for words in trial.translation.missing]
    return "\n".join(lines) + "\n"


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description="Set a host's force law beside ours.")
    parser.add_argument("scene", help="a scene file or a preset")
    parser.add_argument("--host", required=True, choices=sorted({host for host, _ in translate.LAWS}))
    parser.add_argument("--law", help=f"of the host: {', '.join(' '.join(pair) for pair in translate.LAWS)}")
    parser.add_argument("--stokes", type=values, default=values("log:0.02:2:7"))
    parser.add_argument("--angle", type=values, default=values("0,45,75"), help="in degrees")
    parser.add_argument("--gap", type=float, help="the host's least gap in m; default the host's own")
    parser.add_argument("--dt", type=float, help="the host's working time step in s")
    parser.add_argument("-o", "--output", type=Path, help="name of the files without suffix; default HOST-LAW")
    args = parser.parse_args()
    law = args.law or next(law for host, law in translate.LAWS if host == args.host)
    if (args.host, law) not in translate.LAWS:
        parser.error(
            f"{args.host} has no law {law!r} here: {', '.join(b for a, b in translate.LAWS if a == args.host)}"
        )
    scene = Scene.load(args.scene)
    trial = split.referee(scene, args.host, law, args.stokes, np.radians(args.angle), gap=args.gap, step=args.dt)
    base = args.output or Path(f"{args.host}-{law}")
    write_csv(trial, base.with_name(base.name + ".csv"))
    draw(trial, base.with_name(base.name + ".png"))
    text = report(trial, scene, base.name)
    base.with_name(base.name + ".md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
