"""Report of the stress test: tables in Markdown, the worst cases as scene files, two figures."""

from __future__ import annotations

import json
import re
from collections import Counter
from pathlib import Path

import numpy as np

from ...boundaries.changes import GRAZE
from ...formatting.markdown import ms, table
from ...host import files
from .run import DISAGREEMENTS, WORST, Stress, record
from .verdict import Issue, Verdict


def write(found: Stress, folder: Path) -> list[Path]:
    """Write stress.json, stress.md, the figures and the worst cases as scene files; returns their paths."""
    from .plots import draw

    folder.mkdir(parents=True, exist_ok=True)
    data, text = folder / "stress.json", folder / "stress.md"
    kept = record(found) | {"tables": tables(found)}
    files.write(data, json.dumps(kept, indent=1, allow_nan=False) + "\n")
    scenes = worst(found, folder / "worst")
    files.write(text, report(found, scenes))
    return [data, text, *draw(found, folder), *scenes]


def tables(found: Stress) -> dict[str, str]:
    """The report's tables by name, also used for documentation pages."""
    return {
        "disagreements": _listed(found, DISAGREEMENTS),
        "failures": _failures(found),
        "engines": _engines(found),
        "ledgers": _ledgers(found),
        "near": _near(found),
        "rate": rate(found),
    }


def worst(found: Stress, folder: Path) -> list[Path]:
    """Scene files of all unexplained disagreements, then failures, then the largest errors and costs."""
    picked: dict[str, tuple[Verdict, str]] = {}

    def take(sort: str, cases: list[tuple[Verdict, str]]) -> None:
        for k, (one, why) in enumerate(cases[:WORST]):
            picked.setdefault(one.case.name, (one, f"{sort}-{k + 1:02d}\n{why}"))

    take("disagreement", [(one, f"{issue.kind}: {issue.said}") for one, issue in found.unexplained])
    failed = [(one, issue) for one, issue in found.issues("failure")]
    failed.sort(key=lambda pair: bool(pair[1].explained))
    take("failure", [(one, f"{', '.join(issue.between)}: {issue.said}") for one, issue in failed])
    by_error = sorted((one for one in found.verdicts if one.error), key=lambda one: -(one.error or 0.0))
    take("error", [(one, f"e_n differs by {one.error:.2e} between engines") for one in by_error[:5]])
    by_cost = sorted(found.verdicts, key=lambda one: -max(each.cpu for each in one.found.values()))
    take("cost", [(one, f"{_dearest(one)}") for one in by_cost[:5]])
    for earlier in folder.glob("*-[0-9][0-9].toml"):
        earlier.unlink()
    scenes = []
    for one, why in picked.values():
        name, said = why.split("\n", 1)
        folder.mkdir(parents=True, exist_ok=True)
        scenes.append(folder / f"{name}.toml")
        header = "".join(f"# {line}\n" for line in (one.case.name, re.sub(r"[^\x20-\x7e]", "?", said)))
        files.write(scenes[-1], header + one.case.scene.to_toml())
    return scenes


def _dearest(one: Verdict) -> str:
    name = max(one.found, key=lambda each: one.found[each].cpu)
    return f"{name} takes {one.found[name].cpu * 1e3:.0f} ms"


def report(found: Stress, scenes: list[Path]) -> str:
    """Text of `stress.md`."""
    parts = ["# wetdoublet verify --stress", f"**{found.summary()}**", rate(found), _surroundings(found)]
    parts += ["## Disagreements", _listed(found, DISAGREEMENTS)]
    parts += ["## Failures", _failures(found)]
    parts += ["## Engines", _engines(found), _ledgers(found)]
    if found.remarks:
        rows = [[said, str(count)] for said, count in sorted(found.remarks.items())]
        parts += ["## Outside the range of a law", table(["entry and law", "scenes"], rows)]
    parts += ["## Error and cost over Stokes number and angle", "![map](stress-map.png)"]
    parts += ["## Near the separatrix", "![near the separatrix](stress-near.png)", _near(found)]
    if scenes:
        parts += ["## The worst, as scene files", "\n".join(f"* `worst/{file.name}`" for file in scenes)]
    return "\n\n".join(parts) + "\n"


def rate(found: Stress) -> str:
    """Run time, and estimated run time of the default number of scenes."""
    cores, each = found.where["cores"], found.wall / max(len(found.verdicts), 1)
    return (
        f"{1 / each:.1f} scenes a second on {cores} cores, start-up and compilation included: "
        f"20,000 scenes take some {20_000 * each / 60:.0f} minutes at that rate."
    )


def _surroundings(found: Stress) -> str:
    return "\n".join(f"* {name}: {value}" for name, value in found.where.items() if value is not None)


def _listed(found: Stress, kinds: tuple[str, ...]) -> str:
    issues = found.issues(*kinds)
    if not issues:
        return "None."
    counted = Counter((issue.kind, issue.explained or "**unexplained**") for _, issue in issues)
    rows = [[kind, why, str(count)] for (kind, why), count in counted.most_common()]
    lines = [f"* {one.case.name}: {issue.said}" for one, issue in issues if not issue.explained]
    return "\n\n".join([table(["kind", "explanation", "count"], rows), *(["\n".join(lines)] if lines else [])])


def _kind(issue: Issue) -> str:
    """The text of a failure without its numbers, to group failures."""
    words = re.split(r" in phase | at t = |; state|: the collision", issue.said)[0]
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", words)


def _failures(found: Stress) -> str:
    rows = []
    issues = found.issues("failure", "peer")
    counted = Counter((", ".join(issue.between), _kind(issue), issue.kind, issue.explained) for _, issue in issues)
    for (engine, kind, whose, why), count in counted.most_common():
        rows.append(
            [engine, kind, why or ("unexplained" if whose == "failure" else "not examined: another code"), str(count)]
        )
    return table(["engine", "what it says", "explanation", "count"], rows) if rows else "None."


def _engines(found: Stress) -> str:
    rows = []
    for name in dict.fromkeys(name for one in found.verdicts for name in one.found):
        cpu = np.array([one.found[name].cpu for one in found.verdicts if name in one.found])
        done = [one.found[name] for one in found.verdicts if name in one.found and not one.found[name].failure]
        proved = sum(each.certified for each in done)
        rows.append([name, str(len(done)), str(proved), ms(float(np.median(cpu))), ms(float(np.max(cpu)))])
    return table(["engine", "completed", "proved sticks", "CPU ms: median", "largest"], rows)


def _ledgers(found: Stress) -> str:
    lines = []
    for word, said in (("residual", "energy residual over the largest term"), ("drift", "drift of L (midgap arm)")):
        values = [
            each.more[word]
            for one in found.verdicts
            for each in one.found.values()
            if word in each.more and (word == "residual" or one.case.scene.model.arm == "midgap")
        ]
        if values:
            lines.append(f"* {said}: median {np.median(values):.1e}, largest {max(values):.1e}")
    errors = [one.error for one in found.verdicts if one.error is not None]
    if errors:
        lines.append(f"* difference in e_n between engines: median {np.median(errors):.1e}, largest {max(errors):.1e}")
    return "\n".join(lines)


def _near(found: Stress) -> str:
    beside = [one for one in found.verdicts if one.case.distance is not None and one.case.change != GRAZE]
    distances = sorted({one.case.distance for one in beside if one.case.distance}, reverse=True)
    engines = list(dict.fromkeys(name for one in beside for name in one.found))
    rows = []
    for distance in distances:
        here = [one for one in beside if one.case.distance == distance]
        cells = []
        for name in engines:
            times = [one.found[name].cpu for one in here if name in one.found]
            failed = sum(bool(one.found[name].failure) for one in here if name in one.found)
            cells.append((ms(float(np.median(times))) if times else "-") + (f" ({failed} failed)" if failed else ""))
        rows.append([f"{distance:.0e}", *cells])
    return table(["distance", *(f"{name}, median CPU ms" for name in engines)], rows) if rows else "No points."
