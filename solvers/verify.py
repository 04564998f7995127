"""`wetdoublet verify`: symbolic identities out of the derivation, and numbers held to their bounds."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .custom import Package
from .errors import ComputationError
from .result import Collision
from .scene import Scene
from .scenefile import PRESETS
from .simulate import collide

RTOL = 1e-10
RESIDUAL, DRIFT, AGREEMENT = 1e-8, 1e-9, 1e-7  # what issue and users are promised at RTOL
_ANGLES = (0.0, math.radians(30), math.radians(60), math.radians(80))
_STOKES_FACTORS = (0.3, 1.0, 4.0)


_MARKS = {True: "ok  ", False: "FAIL", None: "note"}


@dataclass(frozen=True)
class Finding:
    """One check: what it says, its figure, the bound it is held to ("" for an identity), and whether it holds.

    `ok` is None for what is reported and not held to anything.
    """

    group: str
    name: str
    statement: str
    figure: str
    bound: str
    ok: bool | None


@dataclass(frozen=True)
class Report:
    """All findings. `str` for a terminal, `to_markdown` for a page."""

    findings: tuple[Finding, ...]

    @property
    def ok(self) -> bool:
        return not self.failed

    @property
    def failed(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self.findings if finding.ok is False)

    def __str__(self) -> str:
        lines: list[str] = []
        for group in dict.fromkeys(finding.group for finding in self.findings):
            members = [finding for finding in self.findings if finding.group == group]
            lines += ["", group, "-" * len(group)]
            width = max(len(finding.name) for finding in members)
            for finding in members:
                held = f"  (bound {finding.bound})" if finding.bound else ""
                lines.append(f"{_MARKS[finding.ok]} {finding.name:<{width}}  {finding.figure}{held}")
        lines += ["", self.summary]
        return "\n".join(lines).lstrip("\n")

    def to_markdown(self) -> str:
        lines = ["# wetdoublet verify", ""]
        for group in dict.fromkeys(finding.group for finding in self.findings):
            lines += [f"## {group}", "", "| | check | statement | figure | bound |", "|---|---|---|---|---|"]
            for finding in self.findings:
                if finding.group == group:
                    cells = (
                        _MARKS[finding.ok].strip(),
                        finding.name,
                        finding.statement,
                        finding.figure,
                        finding.bound,
                    )
                    lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
            lines.append("")
        return "\n".join([*lines, self.summary])

    @property
    def summary(self) -> str:
        held = sum(finding.ok is not None for finding in self.findings)
        if self.ok:
            return f"{held} checks hold"
        return f"{len(self.failed)} of {held} checks fail: " + "; ".join(finding.name for finding in self.failed)


def verify(scene: Scene | None = None) -> Report:
    """Check the laws, and the numbers of `scene` (all presets if None)."""
    scenes = [Scene.load(name) for name in PRESETS] if scene is None else [scene]
    findings = [*symbolic()]
    if scene is not None and scene.package is not None:
        findings += model_findings(scene.package)
    for each in scenes:
        findings += numeric(each)
    return Report(tuple(findings))


def symbolic() -> Iterator[Finding]:
    """The identities of the derivation."""
    from ..derive.checks import symbolic_checks  # imports sympy

    for check in symbolic_checks():
        yield Finding("Symbolic", check.name, check.statement, check.figure, "", check.ok)


def model_findings(package: Package) -> Iterator[Finding]:
    """The checks of a user's model, out of the model file that it was emitted from."""
    from ..derive.checks.user import model_checks  # imports sympy

    _, checks = model_checks(Path(f"{package.name}.py"), package.source, package.name)
    for check in checks:
        yield Finding(f"Model: {package.name}", check.name, check.statement, check.figure, "", check.ok)


def numeric(scene: Scene) -> Iterator[Finding]:
    """Energy ledger, angular momentum and agreement of the engines over impacts around the scene's own."""
    group = f"Numeric: {scene.name or 'scene'}"
    pairs, failures = _flights(scene)
    for failure in failures:
        yield Finding(group, "completed", "every collision is completed", failure, "", False)
    if not pairs:
        return
    both = [one for pair in pairs for one in pair]
    worst = max(both, key=_residual)
    yield _bounded(
        group,
        "energy ledger",
        "T(0) = T(end) + losses + works, residual over T(0)",
        _residual(worst),
        RESIDUAL,
        _where(worst),
    )
    drifting = [one for one in both if one.angular_momentum_drift is not None]
    if drifting:
        worst = max(drifting, key=_drift)
        if scene.model.arm == "surface":
            figure = f"{_drift(worst):.1e} at {_where(worst)}: a known violation of the leading-order arm"
            yield Finding(group, "angular momentum", "dL/dt = -x F_t for the surface arm", figure, "", None)
        else:
            yield _bounded(group, "angular momentum", "L conserved, |L/L(0) - 1|", _drift(worst), DRIFT, _where(worst))
    apart, one = max(((_difference(*pair), pair[0]) for pair in pairs), key=lambda found: found[0])
    yield _bounded(group, "engines agree", "cvodes and rosenbrock: outcome and e_n", apart, AGREEMENT, _where(one))
    count = sum(one.certified for one in both)
    sticks = sum(one.outcome == "stick" for one in both)
    yield Finding(
        group,
        "sticks proved",
        "sticks that carry a certificate",
        f"{count} of {sticks} ({len(both)} collisions)",
        "",
        None,
    )


def _flights(scene: Scene) -> tuple[list[tuple[Collision, Collision]], list[str]]:
    own = scene.stokes or 1.0
    angles = dict.fromkeys((*_ANGLES, scene.angle or 0.0))
    pairs, failures = [], []
    for angle in angles:
        for factor in _STOKES_FACTORS:
            try:
                pairs.append(
                    tuple(
                        collide(scene, stokes=own * factor, angle=angle, rtol=RTOL, engine=engine)
                        for engine in ("cvodes", "rosenbrock")
                    )
                )
            except ComputationError as error:
                failures.append(f"St {own * factor:.4g}, {math.degrees(angle):.4g} deg: {error}")
    return pairs, failures  # type: ignore[return-value]  # pairs of two


def _residual(one: Collision) -> float:
    assert one.energy is not None
    return abs(one.energy.residual) / one.energy.initial


def _drift(one: Collision) -> float:
    assert one.angular_momentum_drift is not None
    return one.angular_momentum_drift


def _difference(one: Collision, other: Collision) -> float:
    if one.outcome != other.outcome:
        return math.inf
    return abs(one.restitution - other.restitution) / (abs(other.restitution) or 1.0)


def _where(one: Collision) -> str:
    return f"St {one.stokes:.4g}, {math.degrees(one.angle):.4g} deg, {one.engine}"


def _bounded(group: str, name: str, statement: str, figure: float, bound: float, where: str) -> Finding:
    return Finding(group, name, statement, f"{figure:.1e} at {where}", f"{bound:.0e}", figure <= bound)
