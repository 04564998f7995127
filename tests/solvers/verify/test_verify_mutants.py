"""Each law's check fails, by name and at the right place, when its subject is broken."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from wetdoublet.solvers import Collision, ComputationError, Scene, collide
from wetdoublet.solvers.collision.by_kernel import recorded
from wetdoublet.solvers.verify import audit, conserved, region, sample
from wetdoublet.solvers.verify.report import Finding

pytestmark = pytest.mark.slow

SCENE = Scene.load("granulation")
computed = cache(collide)  # once; what a mutant changes is made of it
BAD = {"stokes": 0.12, "angle": math.radians(60)}  # one impact of the sample; it separates


def doctored(change: Callable[[Collision], Collision], engine: str | None = None) -> Callable[..., Collision]:
    """`collide` with one impact changed (of one engine, or of all)."""

    def run(scene: Scene, **options: Any) -> Collision:
        one = computed(scene, **options)
        hit = math.isclose(one.stokes, BAD["stokes"], rel_tol=1e-3) and math.isclose(one.angle, BAD["angle"])
        return change(one) if hit and engine in (None, one.engine) else one

    return run


def by_name(findings: Iterable[Finding]) -> dict[str, Finding]:
    return {finding.name: finding for finding in findings}


def failures(findings: Iterable[Finding]) -> list[str]:
    return [finding.name for finding in findings if finding.ok is False]


FEW = sample.Extent(angles=(0.0, BAD["angle"]))  # two angles of the sample
GRID = sample.Extent(grid_angles=(60,), grid_points=14)
ON_GRID = SCENE.with_entries({"impact.stokes": BAD["stokes"] / 10**0.6})


@pytest.fixture(scope="module")
def collisions() -> sample.Sample:
    """The sample as it is, with nothing changed."""
    return sample.collisions(SCENE, extent=FEW, collide=computed)


CVODES = ["cvodes = rosenbrock", "taylor = cvodes"]
KERNEL = ["taylor = rosenbrock", "taylor = cvodes"]


def open_ledger(one: Collision) -> Collision:
    assert one.energy is not None
    return replace(one, energy=replace(one.energy, normal_lubrication=one.energy.normal_lubrication * (1 + 1e-6)))


@pytest.mark.parametrize(
    ("laws", "change", "engine"),
    [
        (["energy ledger"], open_ledger, None),
        (["energy ledger"], lambda one: replace(one, energy=replace(one.energy, capillary=math.nan)), None),
        (["angular momentum"], lambda one: replace(one, angular_momentum_drift=1e-7), None),
        (CVODES, lambda one: replace(one, restitution=one.restitution * (1 + 1e-6)), "cvodes"),
        (CVODES, lambda one: replace(one, outcome="stick", restitution=0.0), "cvodes"),
        (KERNEL, lambda one: replace(one, restitution=one.restitution * (1 + 1e-6)), "taylor"),
    ],
)
def test_one_bad_collision_is_found_and_named(laws, change, engine) -> None:
    """An open ledger, one that is no number, a drift, an engine off by 1e-6, another outcome: the laws that it breaks,
    at that place.
    """
    collisions = sample.collisions(SCENE, extent=FEW, collide=doctored(change, engine))
    found = by_name(conserved.conserved(collisions))
    assert failures(found.values()) == laws
    assert all(found[law].where.startswith("St 0.12, 60 deg") for law in laws)


def test_a_collision_that_fails_does_not_lose_the_others() -> None:
    """One that cannot be computed fails `completed`, with its place and reason; every other law is still judged."""

    def fail(one: Collision) -> Collision:
        raise ComputationError("no event within 1e9 x0/v0", phase="closing")

    collisions = sample.collisions(SCENE, extent=FEW, collide=doctored(fail, "cvodes"))
    found = by_name(conserved.conserved(collisions))
    assert failures(found.values()) == ["completed"]
    assert "St 0.12, 60 deg, cvodes" in found["completed"].about[0] and "no event" in found["completed"].about[0]
    assert found["energy ledger"].ok and found["cvodes = rosenbrock"].ok


def overeager(n, rtol, until=None):
    """The kernel, with a proof that calls doublets stuck that separate."""
    whole = recorded(n, rtol)
    if until is not None and whole.answers["outcome"][0] > 0:
        raise ComputationError("a stick that is proved separates when it is followed on")
    found = recorded(n, rtol, until=until)
    found.answers["outcome"], found.answers["certified"] = 0, 1
    return found


def test_a_certificate_that_proves_too_much_is_caught() -> None:
    """Impacts that a false proof certifies escape when continued; the audit counts them and names one."""
    (honest,) = audit.stick_audit(SCENE, impacts=12)
    assert honest.ok and not honest.figure.startswith("0 of 0")
    (found,) = audit.stick_audit(SCENE, impacts=12, run=overeager)
    assert (found.name, found.ok) == ("stick certificate", False)
    assert int(found.figure.split()[0]) > 0
    assert found.where.startswith("St ") and "separates when it is followed on" in found.where


@pytest.mark.parametrize(
    ("law", "change"),
    [
        ("e_n^2 - 1: identity", open_ledger),
        ("e_n^2 - 1: identity", lambda one: replace(one, final_spin=one.final_spin * (1 + 1e-5))),
        ("e_n^2 - 1: identity", lambda one: replace(one, restitution=one.restitution * (1 + 1e-5))),
        ("e_n^2: ceiling", lambda one: replace(one, restitution=4 * one.restitution)),
    ],
)
def test_a_budget_that_does_not_add_up_is_found(law, change) -> None:
    """An open ledger, a spin or an e_n off by 1e-5 break the identity; an e_n four times too large its ceiling."""
    found = by_name(region.argument(region.grid(ON_GRID, GRID, doctored(change))))
    assert law in failures(found.values())
    assert found[law].where.startswith("St 0.12, 60 deg")


def test_a_grid_by_an_engine_that_is_off_is_found() -> None:
    """A point of the grid whose e_n is off by 1e-6 differs from CVODES, by name and place."""
    off = doctored(lambda one: replace(one, restitution=one.restitution * (1 + 1e-6)))
    (found,) = region.beside_cvodes(region.grid(ON_GRID, GRID, off))
    assert found.ok is False
    assert found.where.startswith("St 0.12, 60 deg")
