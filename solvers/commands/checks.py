"""Checks: the laws, the engines against each other and against the clock, and the paper's figures and numbers."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import click

from ..errors import CheckFailed
from ..host.arguments import check_name, check_whole
from ..host.files import check_file, check_folder, write, write_all_in
from ..scene.fields import Field, Range
from .bar import Bar
from .options import Request, Shown, json_text, refuse
from .signature import command, passed
from .texts import whole

_WANTED = Field("--error", "an absolute error of e_n", "1e-6", Range("above 0 and below 1", 0.0, 1.0))
_SYMBOLIC, _NUMERIC = 156, 14  # usual numbers of findings; the latter of a scene, with or without rotation


@command()
def bench(error: Annotated[float | None, _WANTED.number], out: Path | None, request: Request, output: Shown) -> None:
    """Run time against error of the engines for SCENE [granulation] on this machine, and a recommendation.

    CPU time of a collision about the impact of the scene, and its error against another engine at a tighter tolerance,
    for tolerances 1e-4 to 1e-12; then the recommended engine and tolerance for the error wanted.

    Examples:
      wetdoublet bench pendulum --error 1e-8
      wetdoublet bench granulation --set liquid.viscosity="3 Pa s" --plot bench.png

    Options:
        [SCENE] (source):
        --error E: Wanted: largest absolute error of e_n [1e-06].
        --out DIR: Folder for bench.txt, bench.json and bench.png.
    """
    scene = request.optional_scene()

    from ..verify.work_precision import work_precision

    with Bar("settings") as progress:
        measured = work_precision(scene or "granulation", **passed(wanted=error), progress=progress)
    if out is not None:
        write_all_in(out, {"bench.txt": f"{measured}\n", "bench.json": json_text(measured.to_dict()) + "\n"})
        measured.plot(out / "bench.png")
    output.show(measured)


@command()
def reproduce(item: str | None, out: Path | None) -> None:
    """The paper's figures and numbers beside ours, as pictures and one report.

    Figures, Table 1 and the critical numbers of Donahue et al. (2012), or one PART of them. Writes pictures (PNG) and
    report.md; all numbers are computed in the run.

    Options:
        [all|table1|fig1|fig3|fig4a|fig4b|factors] (item):
        --out DIR: Write there [paper, in the current folder]; it may hold other files.
    """
    from ..verify.paper.reproduce import PARTS, reproduce

    chosen = "all" if item is None else check_name(item, ("all", *PARTS), "PART")
    with Bar("parts") as progress:
        written = reproduce(tuple(PARTS) if chosen == "all" else (chosen,), out or Path("paper"), progress=progress)
    click.echo("\n".join(map(str, written)))


def _count(text: str) -> int:
    """The number of scenes."""
    return check_whole(whole(text), "", 1, 10_000_000)


@command()
def verify(
    request: Request,
    output: Annotated[Path | None, partial(check_file, label="", suffixes=(".md", ".txt"))],
    stress: Annotated[int | None, _count],
    out: str | None,
    recompute: bool,
) -> None:
    """Check the laws on SCENE, or on all presets: symbolic identities and numbers; the report goes to standard output.

    Its first line says that all hold, or what failed and why. The symbolic verdicts come with the package or are kept
    in the cache, for as long as the equations, and what they depend on otherwise, are the same.

    With --stress, all engines compute the same scenes: each difference between them is explained by a boundary within
    their error, or makes the exit status 1.

    Options:
        [SCENE] (source):
        -o FILE (output): Write the report to FILE as well.
        --stress [N=500]: Instead: compare all engines on N scenes, drawn and beside boundaries.
        --out DIR: Folder for record, disagreements and worst scenes of --stress [stress].
        --recompute: Prove all symbolic verdicts here, though they are known.
    """
    if stress is not None:
        others = {"SCENE": request.source, **request.options, "-o": output and str(output)}
        others["--recompute"] = "given" * recompute
        problem = "is given together with --stress, which draws its own scenes"
        refuse(others, "--stress N and --out DIR alone", problem)
        _stress_test(stress, check_folder(out or "stress", "--out"))
        return
    refuse({"--out": out}, "--stress N with --out", "needs --stress")
    scene = request.optional_scene()

    from ..verify import Finding, Report, verify

    findings: list[Finding] = []
    try:
        with Bar("checks") as bar:

            def progress(finding: Finding) -> None:
                findings.append(finding)
                done = sum(not (item.kept or item.shipped) for item in findings)  # the others take no time
                symbolic = _SYMBOLIC * (done == len(findings))
                bar(done, max(done, symbolic + _NUMERIC * (1 if scene else 4)))

            report = verify(scene, progress, recompute)
    except KeyboardInterrupt:
        if findings:
            click.echo(str(Report(tuple(findings))))
        last = f"after {len(findings)} checks, the last of them {findings[-1].name}" if findings else "before any check"
        raise KeyboardInterrupt(f"interrupted {last}; what follows is not checked") from None
    text = str(report).rstrip("\n")
    click.echo(text)
    if output is not None:
        write(output, text + "\n")
    if not report.ok:
        failed = report.failed
        more = f"; and {len(failed) - 1} more, see the report" if len(failed) > 1 else ""
        raise CheckFailed(f"verify: {failed[0].line}{more}")


def _stress_test(count: int, folder: Path) -> None:
    """Run the stress test, write the report and print one line of summary.

    An interrupt ends the run with a report of the scenes judged so far.

    Raises:
        CheckFailed: engines disagree without an explanation.
    """
    from ..verify.stress.report import write as write_report
    from ..verify.stress.run import stress

    with Bar("scenes") as progress:
        result = stress(count, tell=progress)
    files = write_report(result, folder)
    for verdict, issue in result.unexplained:
        click.echo(f"unexplained ({issue.kind}): {verdict.case.name}: {issue.message}")
    if result.remarks:
        outside = sum(bool(verdict.remarks) for verdict in result.verdicts)
        click.echo(f"outside the range that a bridge law was made for: {outside} scenes, counted in stress.json")
    click.echo(f"written: {', '.join(map(str, files[:4]))}" + (f" and {len(files) - 4} scenes" if files[4:] else ""))
    click.echo(result.summary())
    if result.unexplained:
        raise CheckFailed(f"{len(result.unexplained)} unexplained disagreements; see {folder / 'stress.json'}")
    if result.interrupted:
        raise KeyboardInterrupt(
            f"interrupted: {len(result.verdicts)} of {count} scenes are in {folder / 'stress.json'}"
        )
