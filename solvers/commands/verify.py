"""`wetdoublet verify`: the laws, each with its figure."""

from __future__ import annotations

from collections.abc import Sequence

import click

from ..errors import CheckFailed, InputError
from . import options


@click.command("verify", short_help="Check the laws: symbolic identities and numbers.")
@click.argument("source", metavar="[SCENE]", required=False)
@options.impact
@options.changes
@options.model
@click.option("-o", "output", metavar="FILE.md", help="Write the report as Markdown to FILE.md as well.")
@click.option("--plot", metavar="FILE.png", help="Draw where e_n > 1, and what it is made of: .png, .pdf or .svg.")
@options.debug
def command(
    source: str | None,
    stokes: str | None,
    speed: str | None,
    angle: str | None,
    changes: Sequence[str],
    model: str | None,
    output: str | None,
    plot: str | None,
) -> None:
    """Check the laws on SCENE, or on all presets; the report goes to standard output."""
    file = options.check_file(output, "-o", (".md",))
    picture = options.check_file(plot, "--plot", options.PICTURES)
    options.check_apart(file, "-o", picture, "--plot")
    asked = options.Asked.check(source, changes, stokes, speed, angle, model=model)
    scene = asked.optional_scene()
    if scene is None and picture is not None:
        raise InputError("--plot", plot, "a SCENE with --plot", "needs a SCENE")

    from ..verify import Finding, Report, verify
    from .bar import bar

    findings: list[Finding] = []
    try:
        with bar("checks") as tell:

            def progress(finding: Finding) -> None:
                findings.append(finding)
                tell(len(findings), None)

            report = verify(scene, progress)
    except KeyboardInterrupt:
        if findings:
            click.echo(str(Report(tuple(findings))))
        after = (
            f"after {len(findings)} checks, the last of them {findings[-1].name}" if findings else "before any check"
        )
        raise KeyboardInterrupt(f"interrupted {after}; what follows is not checked") from None
    click.echo(str(report).rstrip("\n"))
    if file is not None:
        options.put(report.to_markdown().rstrip("\n"), file)
    if picture is not None and report.budget is not None:
        from ..verify.plot import draw_budget

        draw_budget(report.budget, picture)
    if not report.ok:
        failed = report.failed
        more = f"; and {len(failed) - 1} more, see the report" if len(failed) > 1 else ""
        raise CheckFailed(f"verify: {failed[0].line}{more}")
