"""`wetdoublet verify`: checks of the laws with their numbers; or all engines against each other."""

from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import click

from ..errors import CheckFailed, InputError
from ..host.files import write
from ..host.outputs import check_file, check_folder
from ..host.progress import Estimated
from . import options
from .bar import Bar
from .signature import as_command

_SYMBOLIC, _NUMERIC = 156, 17  # usual numbers of findings; the latter of a scene, with or without rotation


def _count(text: str) -> int:
    """The number of scenes; InputError unless it is a whole number in range."""
    try:
        count = int(text)
    except ValueError:
        raise InputError("--stress", text, "a whole number of scenes, such as 500", "is not a whole number") from None
    if not 0 < count <= 10_000_000:
        raise InputError("--stress", text, "a whole number of scenes, 1 to 10000000", "is out of range")
    return count


class _Counted(click.Command):
    """A command whose --stress takes an optional value."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Check a negative number before click, which would read it as an option."""
        for option, value in pairwise(args):
            if option == "--stress" and value[:1] == "-" and value[1:2].isdigit():
                _count(value)
        return super().parse_args(ctx, args)


@as_command(
    "Check the laws: symbolic identities and numbers.", _Counted, stress={"is_flag": False, "flag_value": "500"}
)
def command(
    request: options.OptionalRequest,
    output: Annotated[Path | None, partial(check_file, label="", suffixes=(".md", ".txt"))],
    stress: Annotated[int | None, _count],
    out: str | None,
    recompute: bool,
) -> None:
    """Check the laws on SCENE, or on all presets; the report goes to standard output.

    Its first line says that all hold, or what failed and why. The symbolic verdicts are kept in the cache for as long
    as the equations, and what they depend on otherwise, are the same.

    With --stress, all engines compute the same scenes: each difference between them is explained by a boundary within
    their error, or makes the exit status 1.

    Options:
        -o FILE (output): Write the report to FILE as well.
        --stress N: Instead: compare all engines on N scenes, drawn and beside boundaries [500].
        --out DIR: Folder for record, tables and worst scenes of --stress [stress].
        --recompute: Make the symbolic verdicts again, though they are kept.
    """
    if stress is not None:
        others: dict[str, Any] = {"SCENE": request.source, **request.options, "-o": output}
        for name, value in (others | {"--recompute": "given" * recompute}).items():
            if value:
                problem = "is given together with --stress, which draws its own scenes"
                raise InputError(name, str(value), "--stress N and --out DIR alone", problem)
        _stress_test(stress, check_folder(out or "stress", "--out"))
        return
    if out is not None:
        raise InputError("--out", out, "--stress N with --out", "needs --stress")
    scene = request.optional_scene()

    from ..verify import Finding, Report, verify

    findings: list[Finding] = []
    try:
        with Bar("checks", "" if scene else "a SCENE takes less", factor=3.0) as bar:
            work = Estimated(bar, _SYMBOLIC + _NUMERIC * (1 if scene else 4))

            def progress(finding: Finding) -> None:
                if finding.kept and not findings:  # the symbolic ones take no time
                    work.start(-_SYMBOLIC)
                findings.append(finding)
                work.add(0.0 if finding.kept else 1.0)

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
    for one, issue in result.unexplained:
        click.echo(f"unexplained ({issue.kind}): {one.case.name}: {issue.message}")
    if result.remarks:
        outside = sum(bool(one.remarks) for one in result.verdicts)
        click.echo(f"outside the range that a bridge law was made for: {outside} scenes, counted in stress.md")
    click.echo(f"written: {', '.join(map(str, files[:4]))}" + (f" and {len(files) - 4} scenes" if files[4:] else ""))
    click.echo(result.summary())
    if result.unexplained:
        raise CheckFailed(f"{len(result.unexplained)} unexplained disagreements; see {folder / 'stress.md'}")
    if result.interrupted:
        raise KeyboardInterrupt(f"interrupted: {len(result.verdicts)} of {count} scenes are in {folder / 'stress.md'}")
