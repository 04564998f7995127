"""`wetdoublet verify`: checks of the laws with their numbers; or all engines against each other."""

from __future__ import annotations

import click

from ..errors import CheckFailed, InputError
from . import options
from .stress import SCENES, Counted, check_alone, count_of, stress_test


@click.command("verify", cls=Counted, short_help="Check the laws: symbolic identities and numbers.")
@click.argument("source", metavar="[SCENE]", required=False)
@options.of_scene
@click.option("-o", "output", metavar="FILE.md", help="Write the report as Markdown to FILE.md as well.")
@click.option("--plot", metavar="FILE.png", help="Draw the region e_n > 1 and its energy budget: .png, .pdf or .svg.")
@click.option(
    "--stress",
    metavar="N",
    is_flag=False,
    flag_value=str(SCENES),
    help=f"Instead: compare all engines on N scenes, drawn and beside boundaries [{SCENES}].",
)
@click.option("--out", metavar="DIR", help="Folder for records, tables and plots of --stress [stress].")
@click.option("--recompute", is_flag=True, help="Make the symbolic verdicts again, though they are kept.")
@options.debug
def command(
    request: options.SceneRequest,
    output: str | None,
    plot: str | None,
    stress: str | None,
    out: str | None,
    recompute: bool,
) -> None:
    """Check the laws on SCENE, or on all presets; the report goes to standard output.

    Its first line says that all hold, or what failed and why. The symbolic verdicts are kept in the cache for as long
    as the equations, and what they depend on otherwise, are the same.

    With --stress, engines of this package and scipy's LSODA compute the same scenes: each difference between them is
    explained by a boundary within their error, or makes the exit status 1.
    """
    count = None if stress is None else count_of(stress)
    others = {"SCENE": request.source, **request.options, "-o": output, "--plot": plot}
    check_alone(stress, out, others | {"--recompute": "given" * recompute})
    if count is not None:
        folder = options.check_folder(out or "stress")
        assert folder is not None  # it has a name
        stress_test(count, folder)
        return
    file = options.check_file(output, "-o", (".md",))
    picture = options.check_file(plot, "--plot", options.PICTURES)
    options.check_apart(file, "-o", picture, "--plot")
    scene = request.optional_scene()
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

            report = verify(scene, progress, recompute)
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
