"""The stretches of a line that `prove_boundary` claims: without a hole, and proved again; mutants are noticed."""

import inspect
import itertools
from collections.abc import Callable

import pytest
from wetdoublet.solvers import ProvedBoundary, collide, prove, prove_boundary
from wetdoublet.solvers.boundaries import proved_boundary
from wetdoublet.solvers.host.compiler import compiler

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.usefixtures("released")]
LINE = {"angle": "60 deg", "stokes": (0.09, 0.2)}  # across one change of granulation
WIDE = 1e-4  # relative width of stretches that `prove` encloses by the same steps


def holds(found: ProvedBoundary) -> bool:
    """True if what a result lists covers the line, and wide proved stretches are proved with what a collision does."""
    stretches = sorted([*found.proved, *found.undecided, *(each.within for each in found.changes)])
    covered = (stretches[0][0], stretches[-1][1]) == LINE["stokes"]
    if not (covered and all(one[1] == other[0] for one, other in itertools.pairwise(stretches))):
        return False
    impact = {"angle": LINE["angle"], "stokes": 0.1}
    for low, high in found.proved:
        if high > low * (1 + WIDE):
            proof = prove("granulation", **impact, within={"impact.stokes": (low, high)})
            middle = collide("granulation", angle=LINE["angle"], stokes=0.5 * (low + high), ledger=False)
            if proof.outcome != middle.outcome:
                return False
    return True


@pytest.mark.slow
def test_the_line_is_covered_by_stretches_that_are_proved_again() -> None:
    """What is proved, what lies around changes and what is undecided have their ends in common, from end to end."""
    found = prove_boundary("granulation", **LINE)
    assert len(found.changes) == 1
    assert len(found.proved) > 20
    assert holds(found)


@pytest.mark.slow
def test_a_broken_cover_is_noticed() -> None:
    """A stretch whose proof failed."""
    change = (".outcome:\n                proved", ".outcome >= 0:\n                proved")
    text = inspect.getsource(proved_boundary)
    assert text.count(change[0]) == 1
    space: dict[str, object] = {"__name__": proved_boundary.__name__, "__package__": proved_boundary.__package__}
    exec(text.replace(*change), space)
    run: Callable[..., ProvedBoundary] = space["prove_boundary"]  # type: ignore[assignment] # as in the module
    assert not holds(run("granulation", **LINE))
