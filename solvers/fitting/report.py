"""A fit as a report: Markdown, HTML and their picture."""

from __future__ import annotations

import html
import math
from pathlib import Path

import numpy as np

from ...generated.automaton import OUTCOMES
from ..formatting.markdown import table
from ..host import files
from ..host.outputs import check_folder
from ..host.pictures import saved
from ..scene.held import NAMES
from .estimates import CONTRADICTED, Fitted
from .plot import draw

Table = tuple[list[str], list[list[str]]]
_MOST = 12  # rows of the data that are shown: those that pull most
_STYLE = (
    "body{font-family:sans-serif;max-width:60em;margin:2em auto;padding:0 1em}table{border-collapse:collapse}"
    "td,th{padding:.25em .8em;border-bottom:1px solid #ddd;text-align:left}img{max-width:100%}"
)


def write_report(fit: Fitted, folder: str | Path) -> list[Path]:
    """Write report.md, report.html and fit.png into a folder, which is created if need be; returns their paths."""
    into = check_folder(folder, "report")
    into.mkdir(parents=True, exist_ok=True)
    saved(lambda: draw(fit), into / "fit.png")
    title = f"Fit of {fit.points} impacts" + (f" to {fit.first.name}" if fit.first.name else "")
    change = f"with twice as fine integrals it changes by {fit.quadrature:.2g}"
    height = f"Log-likelihood {fit.log_likelihood:.4f}; {change}."
    parts: list[tuple[str, Table | list[str]]] = [
        ("", [CONTRADICTED] if fit.rows.contradicted else []),
        ("Estimates", fit.table()),
        ("", [*fit.combinations, height]),
        ("Correlation", _correlation(fit)),
        ("Remarks", list(fit.remarks)),
        ("Impacts that pull most", _rows(fit)),
        ("", ["Pull: how far the estimates would move without the impact, in standard errors, to first order."]),
    ]  # fmt: skip
    parts = [(head, part) for head, part in parts if part]
    markdown, page = [f"# {title}", "![the fit](fit.png)"], [f"<h1>{html.escape(title)}</h1>"]
    page.append('<img src="fit.png" alt="the fit">')
    for head, part in parts:
        if head:
            markdown.append(f"## {head}")
            page.append(f"<h2>{head}</h2>")
        if isinstance(part, tuple):
            markdown.append(table(*part))
            page.append(_html(part))
        else:
            markdown.append("\n".join(f"* {line}" for line in part))
            page.append("<ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in part) + "</ul>")
    head = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
    files.write(into / "report.md", "\n\n".join(markdown) + "\n")
    files.write(into / "report.html", f"{head}<style>{_STYLE}</style><body>{''.join(page)}</body></html>\n")
    return [into / name for name in ("report.md", "report.html", "fit.png")]


def _correlation(fit: Fitted) -> Table | list[str]:
    names = list(fit.estimates)
    if len(names) < 2:
        return []
    rows = [[name, *(f"{value:.2f}" for value in row)] for name, row in zip(names, fit.correlation.tolist())]
    return ["", *names], rows


def _rows(fit: Fitted) -> Table:
    data, rows = fit.data, fit.rows
    names = list(rows.expected)
    head = ["impact", f"{NAMES[data.speed_name]} (m/s)", "angle (deg)", "outcome", "probability"]
    head += [f"{name} (expected)" for name in names] + ["pull"]
    cells = []
    for k in np.argsort(-rows.pull)[:_MOST].tolist():
        outcome = OUTCOMES[data.outcome[k]] if data.outcome[k] >= 0 else "-"
        cell = [data.label(k), f"{data.speed[k]:.4g}", f"{math.degrees(data.angle[k]):.4g}", outcome]
        cell.append(f"{rows.probability[k]:.3g}")
        for name in names:
            measured = float(data.observed[name][0][k])
            cell.append("-" if math.isnan(measured) else f"{measured:.4g} ({rows.expected[name][k]:.4g})")
        cells.append([*cell, f"{rows.pull[k]:.2f}"])
    return head, cells


def _html(part: Table) -> str:
    head, rows = part
    lines = ["<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row) + "</tr>"
             for tag, row in [("th", head), *(("td", row) for row in rows)]]  # fmt: skip
    return f"<table>{''.join(lines)}</table>"
