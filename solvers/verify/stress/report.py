"""Report of the stress test: a record with its disagreements, and the worst cases as scene files."""

import json
import math
import re
from collections import Counter
from pathlib import Path
from typing import Any

from ....generated.automaton import OUTCOMES
from ...formatting.tables import table
from ...host import files
from .judge import SHARE, runs
from .run import Stress
from .sample import SEED
from .verdict import DISAGREEMENTS, FAST, RTOL, Verdict

WORST = 20  # cases written as scene files, of each sort


def write(stress: Stress, folder: Path) -> list[Path]:
    """Write stress.json and the worst cases as scene files; returns their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    data = folder / "stress.json"
    files.write(data, json.dumps(record(stress), indent=1, allow_nan=False) + "\n")
    return [data, *worst(stress, folder / "worst")]


def record(stress: Stress) -> dict[str, Any]:
    """Content of `stress.json`."""
    cases = [_case(verdict) for verdict in stress.verdicts]
    return {
        "environment": stress.where,
        "settings": {"seed": SEED, "rtol": RTOL, "share": SHARE, "engines": list(runs()), "fast": FAST},
        "summary": stress.summary(),
        "disagreements": disagreements(stress),
        "outside_of_ranges": dict(stress.remarks),
        "outcomes": {name: sum(case["outcome"] == name for case in cases) for name in OUTCOMES},
        "cases": cases,
        "wall": stress.wall,
    }


def _case(verdict: Verdict) -> dict[str, Any]:
    case, results = verdict.case, verdict.results.items()
    columns = ("outcome", "restitution", "certified", "failure")
    return {
        **{name: getattr(case, name) for name in ("name", "kind", "distance", "change")},
        "scene": case.scene.to_dict() if verdict.issues else None,  # the others can be reproduced from seed and number
        "stokes": case.scene.stokes,
        "angle": case.scene.angle,
        "angles": list(case.angles),
        "outcome": next((result.outcome for _, result in results if result.outcome), ""),
        "error": verdict.error,
        "conditioning": verdict.conditioning if verdict.conditioning != math.inf else None,
        "found": {name: {key: getattr(result, key) for key in columns} | result.more for name, result in results},
        "issues": [issue.to_dict() for issue in verdict.issues],
    }


def worst(stress: Stress, folder: Path) -> list[Path]:
    """Scene files of all unexplained disagreements, then failures, then the largest errors."""
    failed = sorted(stress.issues("failure"), key=lambda pair: bool(pair[1].explained))
    erring = sorted((entry for entry in stress.verdicts if entry.error), key=lambda entry: -(entry.error or 0.0))
    sorts: dict[str, list[tuple[Verdict, str]]] = {
        "disagreement": [(verdict, f"{issue.kind}: {issue.message}") for verdict, issue in stress.unexplained],
        "failure": [(verdict, f"{', '.join(issue.between)}: {issue.message}") for verdict, issue in failed],
        "error": [(verdict, f"e_n differs by {verdict.error:.2e} between engines") for verdict in erring[:5]],
    }
    for earlier in folder.glob("*-[0-9][0-9].toml"):
        earlier.unlink()
    scenes: dict[str, Path] = {}
    for sort, cases in sorts.items():
        for k, (verdict, why) in enumerate(cases[:WORST]):
            if verdict.case.name not in scenes:
                folder.mkdir(parents=True, exist_ok=True)
                scenes[verdict.case.name] = file = folder / f"{sort}-{k + 1:02d}.toml"
                header = "".join(f"# {line}\n" for line in (verdict.case.name, re.sub(r"[^\x20-\x7e]", "?", why)))
                files.write(file, header + verdict.case.scene.to_toml())
    return list(scenes.values())


def disagreements(stress: Stress) -> str:
    """How often engines disagreed, by kind and explanation, and each place that has none; in Markdown."""
    issues = stress.issues(*DISAGREEMENTS)
    keys = Counter((issue.kind, issue.explained or "**unexplained**") for _, issue in issues)
    rows = [[*key, str(count)] for key, count in keys.most_common()]
    lines = [f"* {verdict.case.name}: {issue.message}" for verdict, issue in issues if not issue.explained]
    counted = table(["kind", "explanation", "count"], rows) if rows else "None."
    return "\n\n".join([counted, *(["\n".join(lines)] if lines else [])])
