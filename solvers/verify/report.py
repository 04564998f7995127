"""Findings of `wetdoublet verify`, and the report of them."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING

from ..scene.items import item
from ..scene.origin import Record, Result, provenance

if TYPE_CHECKING:
    import xarray

WIDTH = 100
_COLUMNS = ("group", "name", "statement", "figure", "bound", "ok", "where")
_MARKS = {True: "ok", False: "FAIL", None: "note"}
_MARK, _LONGEST = 6, 200  # characters of the mark on the left, and of the failure in the first line
_BESIDE = 26  # width of value and bound, so that places are aligned


class Finding(Record):
    """The result of one check: statement, value, bound ("" for an identity), and success."""

    group: str
    name: str
    statement: str
    figure: str
    bound: str
    ok: bool | None = item("None for a value that is reported without a bound")
    where: str = item("the place of the worst case (Stokes number, angle, engine, event)", default="")
    about: tuple[str, ...] = item("further lines (a table, intervals), shown verbatim", default=())
    kept: bool = item("True if it was computed by an earlier run, from the same equations", default=False)
    shipped: bool = item("True if it was proved when the package was built, from the same equations", default=False)

    @property
    def line(self) -> str:
        """The finding in one line: law, value, place."""
        held = f", bound {self.bound}" if self.bound else ""
        place = f", at {self.where}" if self.where else ""
        return f"{self.name} ({self.group}): {self.figure}{held}{place}"


def bounded(name: str, statement: str, figure: float, bound: float, where: str, *about: str) -> Finding:
    """A finding whose value must not exceed a bound; NaN fails. The group is added where the checks are run."""
    return Finding("", name, statement, f"{figure:.1e}", f"{bound:.1e}", bool(figure <= bound), where, about)


def note(name: str, statement: str, figure: str, where: str = "", about: tuple[str, ...] = ()) -> Finding:
    """A finding that is reported without a bound."""
    return Finding("", name, statement, figure, "", None, where, about)


class Report(Result):
    """All findings; `str` is the report."""

    _keys = "ok summary=headline findings"

    findings: tuple[Finding, ...]

    def to_dataset(self) -> xarray.Dataset:
        """The findings over `check`; `ok` is 1, 0, or -1 for a note."""
        import xarray as xr

        texts = {name: ("check", [getattr(row, name) for row in self.findings]) for name in _COLUMNS if name != "ok"}
        held = [-1 if finding.ok is None else int(finding.ok) for finding in self.findings]
        return xr.Dataset({**texts, "ok": ("check", held)}, attrs=provenance())

    @property
    def ok(self) -> bool:
        return not self.failed

    @property
    def failed(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self.findings if finding.ok is False)

    def __str__(self) -> str:
        lines: list[str] = [self.headline, ""]
        if self.failed:
            lines += _section("Failed", self.failed, statements=True)
        for group, members in self._groups().items():
            lines += _section(group, members)
        return "\n".join([*lines, *wrap(self.summary, WIDTH)])

    __repr__ = __str__  # at the prompt

    @property
    def headline(self) -> str:
        """The first line: that all checks hold, or what failed and why."""
        if self.ok:
            return self._counted
        line = self.failed[0].line
        more = f"; and {len(self.failed) - 1} more" if len(self.failed) > 1 else ""
        return f"{self._counted}: {line if len(line) <= _LONGEST else line[:_LONGEST] + ' ...'}{more}"

    @property
    def summary(self) -> str:
        """The last line: number of passed checks, names of failed ones, and how many are not of this run."""
        names = "; ".join(f"{finding.name} ({finding.group})" for finding in self.failed)
        shipped = sum(finding.shipped for finding in self.findings)
        earlier = sum(finding.kept and not finding.shipped for finding in self.findings)
        counts = {"proved when this version was built": shipped, "kept from an earlier run": earlier}
        texts = [f"{count} verdicts {source}" for source, count in counts.items() if count]
        other = f" ({', '.join(texts)}, on the same equations; --recompute proves them here)" if texts else ""
        return f"{self._counted}{': ' if names else ''}{names}{other}"

    @property
    def _counted(self) -> str:
        held = sum(finding.ok is not None for finding in self.findings)
        notes = len(self.findings) - held
        noted = f", {notes} note{'s' * (notes != 1)}" if notes else ""
        return f"{held} checks hold{noted}" if self.ok else f"{len(self.failed)} of {held} checks FAIL{noted}"

    def _groups(self) -> dict[str, tuple[Finding, ...]]:
        names = dict.fromkeys(finding.group for finding in self.findings)
        return {name: tuple(finding for finding in self.findings if finding.group == name) for name in names}


def _section(title: str, members: tuple[Finding, ...], statements: bool = False) -> list[str]:
    """Lines of a group: name, value with bound, place; its details, or its statement and group.

    A bound with two dots is a range.
    """
    lines = [title, "-" * len(title)]
    name = max(len(finding.name) for finding in members)
    held = {True: " in ", False: " <= "}
    figures = [row.figure + (held[".." in row.bound] + row.bound if row.bound else "") for row in members]
    beside = [len(text) for text, finding in zip(figures, members) if finding.where and len(text) <= _BESIDE]
    indent = " " * (_MARK + name + 2)
    for finding, figure in zip(members, figures):
        text = f"{figure:<{max(beside, default=0)}}  at {finding.where}" if finding.where else figure
        lines += _wrapped(f"{_MARKS[finding.ok]:<{_MARK}}{finding.name:<{name}}  ", text, indent)
        if statements:
            lines += _wrapped(indent, f"{finding.group}: {finding.statement}", indent)
        else:
            lines += [f"    {line}".rstrip() for line in finding.about]
    return [*lines, ""]


def _wrapped(first: str, text: str, indent: str) -> list[str]:
    """Text after `first`, wrapped; unchanged if it fits on one line."""
    if len(first) + len(text) <= WIDTH:
        return [(first + text).rstrip()]
    return wrap(text, WIDTH, initial_indent=first, subsequent_indent=indent, break_long_words=False)
