"""`wetdoublet check`: measured impacts looked through before a fit."""

from dataclasses import replace

from ..errors import CheckFailed, InputError
from . import options
from .signature import as_command


@as_command("Measured impacts looked through before a fit.")
def command(data: str | None, request: options.EntriesRequest, output: options.Written) -> None:
    """Look through the impacts in DATA.csv, measured on what SCENE describes: units, outliers, what they can tell.

    The two may stand in either order. Exit status 1 if something is odd.

    \b
    Examples:
      wetdoublet check impacts.csv granulation
      wetdoublet check impacts.csv scene.toml --json

    Options:
        DATA.csv (data):
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..fitting.examine import check_data

    source = request.source or ""
    if source.lower().endswith(".csv"):
        request, data = replace(request, source=data), source
    if data is None:
        raise InputError("DATA.csv", None, "a CSV file with a row for each impact")
    report = check_data(data, request.scene(remark=True))
    output.put(str(report), report.to_dict())
    if report.findings:
        count = len(report.findings)
        raise CheckFailed(f"{count} finding{'s' * (count > 1)}, the first: {report.findings[0].text}")
