"""Report of the stress test: a record, tables in Markdown, the worst cases as scene files, two figures."""

import json
import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ....generated.automaton import OUTCOMES
from ...boundaries.changes import GRAZE
from ...formatting.markdown import ms, table
from ...formatting.style import picture
from ...formatting.ticks import plain
from ...host import files
from .judge import SHARE, runs
from .run import Stress
from .sample import SEED
from .verdict import DISAGREEMENTS, FAST, RTOL, Issue, Result, Verdict

WORST = 20  # cases written as scene files, of each sort
_COLOURS = {"taylor": "#E69F00", "rosenbrock": "#D55E00", "cvodes": "#0072B2", "LSODA": "#CC79A7"}
_MARKERS = dict(zip(OUTCOMES, ("o", "^", "s"), strict=True))


def write(stress: Stress, folder: Path) -> list[Path]:
    """Write stress.json, stress.md, the figures and the worst cases as scene files; returns their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    data, text, named = folder / "stress.json", folder / "stress.md", tables(stress)
    files.write(data, json.dumps(record(stress) | {"tables": named}, indent=1, allow_nan=False) + "\n")
    scenes = worst(stress, folder / "worst")
    files.write(text, report(stress, named, scenes))
    return [data, text, *draw(stress, folder), *scenes]


def record(stress: Stress) -> dict[str, Any]:
    """Content of `stress.json`."""
    cases = [_case(one) for one in stress.verdicts]
    return {
        "environment": stress.where,
        "settings": {"seed": SEED, "rtol": RTOL, "share": SHARE, "engines": list(runs()), "fast": FAST},
        "summary": stress.summary(),
        "outside_of_ranges": dict(stress.remarks),
        "outcomes": {name: sum(case["outcome"] == name for case in cases) for name in OUTCOMES},
        "cases": cases,
        "wall": stress.wall,
    }


def _case(one: Verdict) -> dict[str, Any]:
    case, results = one.case, one.results.items()
    shown = ("outcome", "restitution", "certified", "failure", "cpu")
    return {
        **{name: getattr(case, name) for name in ("name", "kind", "distance", "change")},
        "scene": case.scene.to_dict() if one.issues else None,  # the others can be reproduced from seed and number
        "stokes": case.scene.stokes,
        "angle": case.scene.angle,
        "angles": list(case.angles),
        "outcome": next((each.outcome for _, each in results if each.outcome), ""),
        "error": one.error,
        "conditioning": one.conditioning if one.conditioning != math.inf else None,
        "found": {name: {key: getattr(each, key) for key in shown} | each.more for name, each in results},
        "issues": [asdict(issue) for issue in one.issues],
    }


def tables(stress: Stress) -> dict[str, str]:
    """The report's tables by name, also used for documentation pages."""
    return {
        "disagreements": _disagreements(stress),
        "failures": _failures(stress),
        "engines": _engines(stress),
        "ledgers": _ledgers(stress),
        "near": _near(stress),
        "rate": _rate(stress),
    }


def worst(stress: Stress, folder: Path) -> list[Path]:
    """Scene files of all unexplained disagreements, then failures, then the largest errors and costs."""
    failed = sorted(stress.issues("failure"), key=lambda pair: bool(pair[1].explained))
    erring = sorted((one for one in stress.verdicts if one.error), key=lambda one: -(one.error or 0.0))
    dearest = sorted(
        ((one, max(one.results.items(), key=lambda each: each[1].cpu)) for one in stress.verdicts),
        key=lambda pair: -pair[1][1].cpu,
    )
    sorts: dict[str, list[tuple[Verdict, str]]] = {
        "disagreement": [(one, f"{issue.kind}: {issue.said}") for one, issue in stress.unexplained],
        "failure": [(one, f"{', '.join(issue.between)}: {issue.said}") for one, issue in failed],
        "error": [(one, f"e_n differs by {one.error:.2e} between engines") for one in erring[:5]],
        "cost": [(one, f"{name} takes {each.cpu * 1e3:.0f} ms") for one, (name, each) in dearest[:5]],
    }
    for earlier in folder.glob("*-[0-9][0-9].toml"):
        earlier.unlink()
    scenes: dict[str, Path] = {}
    for sort, cases in sorts.items():
        for k, (one, why) in enumerate(cases[:WORST]):
            if one.case.name not in scenes:
                folder.mkdir(parents=True, exist_ok=True)
                scenes[one.case.name] = file = folder / f"{sort}-{k + 1:02d}.toml"
                header = "".join(f"# {line}\n" for line in (one.case.name, re.sub(r"[^\x20-\x7e]", "?", why)))
                files.write(file, header + one.case.scene.to_toml())
    return list(scenes.values())


def report(stress: Stress, named: dict[str, str], scenes: list[Path]) -> str:
    """Text of `stress.md`."""
    surroundings = "\n".join(f"* {name}: {value}" for name, value in stress.where.items() if value is not None)
    parts = ["# wetdoublet verify --stress", f"**{stress.summary()}**", named["rate"], surroundings]
    parts += ["## Disagreements", named["disagreements"]]
    parts += ["## Failures", named["failures"]]
    parts += ["## Engines", named["engines"], named["ledgers"]]
    if stress.remarks:
        rows = [[text, str(count)] for text, count in sorted(stress.remarks.items())]
        parts += ["## Outside the range of a law", table(["entry and law", "scenes"], rows)]
    parts += ["## Error and cost over Stokes number and angle", "![map](stress-map.png)"]
    parts += ["## Near the separatrix", "![near the separatrix](stress-near.png)", named["near"]]
    if scenes:
        parts += ["## The worst, as scene files", "\n".join(f"* `worst/{file.name}`" for file in scenes)]
    return "\n\n".join(parts) + "\n"


def _rate(stress: Stress) -> str:
    """Run time, and estimated run time of the default number of scenes."""
    cores, each = stress.where["cores"], stress.wall / max(len(stress.verdicts), 1)
    return (
        f"{1 / each:.1f} scenes a second on {cores} cores, start-up and compilation included: "
        f"20,000 scenes take some {20_000 * each / 60:.0f} minutes at that rate."
    )


def _counted(head: Sequence[str], keys: Iterable[tuple[str, ...]], none: str) -> str:
    """A table of how often each row occurs, the most frequent first."""
    rows = [[*key, str(count)] for key, count in Counter(keys).most_common()]
    return table([*head, "count"], rows) if rows else none


def _disagreements(stress: Stress) -> str:
    issues = stress.issues(*DISAGREEMENTS)
    keys = ((issue.kind, issue.explained or "**unexplained**") for _, issue in issues)
    lines = [f"* {one.case.name}: {issue.said}" for one, issue in issues if not issue.explained]
    counted = _counted(["kind", "explanation"], keys, "None.")
    return "\n\n".join([counted, *(["\n".join(lines)] if lines else [])])


def _failures(stress: Stress) -> str:
    def key(issue: Issue) -> tuple[str, str, str]:
        """Engines, message without its numbers, and explanation."""
        words = re.split(r" in phase | at t = |; state|: the collision", issue.said)[0]
        unexplained = "unexplained" if issue.kind == "failure" else "not examined: another code"
        return ", ".join(issue.between), re.sub(r"[-+]?\d[\d.e+-]*", "#", words), issue.explained or unexplained

    keys = (key(issue) for _, issue in stress.issues("failure", "peer"))
    return _counted(["engine", "what it says", "explanation"], keys, "None.")


def _by_engine(verdicts: Iterable[Verdict]) -> dict[str, list[Result]]:
    results: dict[str, list[Result]] = {}
    for one in verdicts:
        for name, each in one.results.items():
            results.setdefault(name, []).append(each)
    return results


def _engines(stress: Stress) -> str:
    rows = []
    for name, results in _by_engine(stress.verdicts).items():
        cpu, done = [each.cpu for each in results], [each for each in results if not each.failure]
        proved = sum(each.certified for each in done)
        rows.append([name, str(len(done)), str(proved), ms(float(np.median(cpu))), ms(max(cpu))])
    note = (
        "CPU times of several processes are without the clock that CasADi reads around every evaluation of the rates."
    )
    return table(["engine", "completed", "proved sticks", "CPU ms: median", "largest"], rows) + f"\n\n{note}"


def _ledgers(stress: Stress) -> str:
    pairs = [(one, each.more) for one in stress.verdicts for each in one.results.values()]
    figures = {
        "energy residual over the largest term": [more["residual"] for _, more in pairs if "residual" in more],
        "drift of L (midgap arm)": [
            more["drift"] for one, more in pairs if "drift" in more and one.case.scene.model.arm == "midgap"
        ],
        "difference in e_n between engines": [one.error for one in stress.verdicts if one.error is not None],
    }
    return "\n".join(
        f"* {name}: median {np.median(values):.1e}, largest {max(values):.1e}"
        for name, values in figures.items()
        if values
    )


def _near(stress: Stress) -> str:
    beside = [one for one in stress.verdicts if one.case.distance and one.case.change != GRAZE]
    engines, rows = list(_by_engine(beside)), []
    for distance in sorted({one.case.distance for one in beside}, reverse=True):  # type: ignore[type-var]  # no None
        here = _by_engine(one for one in beside if one.case.distance == distance)
        cells = []
        for name in engines:
            results = here.get(name, [])
            failed = sum(bool(each.failure) for each in results)
            median = ms(float(np.median([each.cpu for each in results]))) if results else "-"
            cells.append(median + f" ({failed} failed)" * bool(failed))
        rows.append([f"{distance:.0e}", *cells])
    return table(["distance", *(f"{name}, median CPU ms" for name in engines)], rows) if rows else "No points."


def draw(stress: Stress, folder: Path) -> list[Path]:
    """Draw stress-map.png and stress-near.png; returns their paths."""
    figures = {folder / "stress-map.png": over_impacts(stress), folder / "stress-near.png": near(stress)}
    for file, figure in figures.items():
        files.save(figure, file, dpi=160)
    return list(figures)


@picture
def over_impacts(stress: Stress) -> Figure:
    """Draw the difference of e_n between engines and the cost of the fast one, a point for each sampled scene."""
    figure = Figure(figsize=(10.4, 5.0), layout="constrained")
    left, right = figure.subplots(1, 2, sharex=True, sharey=True, gridspec_kw={"wspace": 0.06})
    left.set_title("(a) do the engines agree?", loc="left")
    right.set_title("(b) what does a collision cost?", loc="left")
    sampled = [one for one in stress.verdicts if one.case.kind == "sampled"]
    error = [max(one.error or 0.0, 1e-16) for one in sampled]
    cost = [1e3 * one.results[FAST].cpu if FAST in one.results else np.nan for one in sampled]
    for axes, values, label, ends in (
        (left, error, "largest difference in $e_n$ between engines", (1e-16, 1e-6)),
        (right, cost, f"CPU time by {FAST} (ms)", _ends(cost)),
    ):
        norm = LogNorm(*ends, clip=True)
        shown: Any = None
        for outcome, marker in _MARKERS.items():
            here = [k for k, one in enumerate(sampled) if any(each.outcome == outcome for each in one.results.values())]
            here.sort(key=lambda k: values[k])  # the worst on top
            style: Any = {"norm": norm, "cmap": "viridis_r", "linewidths": 0.3, "edgecolors": "#606060"}
            coloured = [values[k] for k in here]
            scenes: Any = [sampled[k].case.scene for k in here]
            places = [each.stokes for each in scenes], [math.degrees(each.angle) for each in scenes]
            size = float(np.clip(9000.0 / max(len(sampled), 1), 2.0, 20.0))  # smaller for many points
            drawn = axes.scatter(*places, c=coloured, marker=marker, s=size, **style)
            axes.scatter([], [], marker=marker, s=20, color="#808080", label=outcome)
            shown = drawn if here or shown is None else shown
        bar = figure.colorbar(shown, ax=axes, label=label, pad=0.01, extend="both")
        if ends[1] < 1e3 * ends[0]:  # powers of ten alone would be too few ticks
            plain(bar.ax.yaxis)
        _marked(axes, stress)
        axes.set(xscale="log", xlabel="Stokes number", xlim=(5e-7, 2e4), ylim=(-2, 92))
        axes.set_yticks(range(0, 91, 15))
    left.set_ylabel("impact angle (deg)")
    figure.suptitle(f"Engines against each other in {len(sampled)} random scenes")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5)
    return figure


def _ends(values: list[float]) -> tuple[float, float]:
    """Ends of the colour scale: the 1 and 99 % quantiles."""
    there = np.array([value for value in values if np.isfinite(value) and value > 0])
    if there.size < 2:
        return 0.1, 10.0
    low, high = np.quantile(there, [0.01, 0.99])
    return float(low), float(max(high, 1.01 * low))


def _marked(axes: Axes, stress: Stress) -> None:
    """Draw failures and unexplained disagreements as crosses on top."""
    failed = {id(one): one for one, issue in stress.issues("failure") if one.case.kind == "sampled"}
    strange = {id(one): one for one, _ in stress.unexplained if one.case.kind == "sampled"}
    for which, colour, marker, label in ((failed, "#D55E00", "x", "failure"), (strange, "#D00000", "+", "unexplained")):
        scenes = [one.case.scene for one in which.values()]
        if scenes:
            stokes = [float(each.stokes or 0.0) for each in scenes]
            angles = [math.degrees(each.angle or 0.0) for each in scenes]
            axes.scatter(stokes, angles, c=colour, marker=marker, s=34, linewidths=1.1, label=label)


@picture
def near(stress: Stress) -> Figure:
    """Draw CPU time of every engine against the relative distance from an escape: medians, and all points faintly."""
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.add_subplot()
    beside = [one for one in stress.verdicts if one.case.distance and one.case.change != GRAZE]
    for name in dict.fromkeys(name for one in beside for name in one.results):
        points = [(one.case.distance, 1e3 * one.results[name].cpu) for one in beside if name in one.results]
        at: Any = sorted({distance for distance, _ in points}, reverse=True)
        middle = [float(np.median([cpu for distance, cpu in points if distance == each])) for each in at]
        colour = _COLOURS.get(name, "#202020")
        axes.plot(*np.array(points).T, ".", color=colour, alpha=0.25, markersize=4, markeredgewidth=0)
        axes.plot(at, middle, "-o", color=colour, markersize=4, linewidth=1.5, label=f"{name}, median")
    axes.set(xscale="log", yscale="log", ylabel="CPU time (ms)")
    axes.set_xlabel("relative distance from where a doublet begins to escape, in St")
    figure.suptitle("Cost of a collision beside the boundary of escape")
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    if beside:
        axes.invert_xaxis()
        axes.legend(ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2)
    return figure
