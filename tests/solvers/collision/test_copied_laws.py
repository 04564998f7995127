"""The library's laws as a user's: collisions are the same to the last bit, by the kernel and by CasADi."""

from pathlib import Path

import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.export.citations import citations
from wetdoublet.solvers.host.compiler import compiler

from ...helpers.copied_laws import copied

pytestmark = pytest.mark.slow  # compiles kernels

SLOTS = {"model.film": "finite", "model.glass": "literal", "bridge.law": "soulie"}
CHOSEN = [  # with the law's own rupture distance; with a film whose rim follows the bridge, where a proof exists for it
    SLOTS | {"bridge.rupture": "own"},
    SLOTS | {"bridge.law": "rabinovich", "model.film": "constant-volume"},
]
IMPACTS = [(0.5, "45 deg", "bounce"), (0.04, "75 deg", "stick-rotate-separate"), (0.03, "30 deg", "stick")]


def copy_of(name: str, law: str) -> str:
    """The choice of a scene that takes the copy."""
    return law if name == "bridge.rupture" else f"{law}-copy"


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("model") / "copies.py"
    path.write_text(copied("film", "lambert", "glass", "soulie"))
    return path


def test_a_copy_is_cited_as_the_law(model: Path) -> None:
    """Its publications, and that of its rupture distance."""
    library, own = Scene.load("granulation"), Scene.load("granulation", model=str(model))
    first = citations(library.with_entries(CHOSEN[0]))
    second = citations(own.with_entries({name: copy_of(name, law) for name, law in CHOSEN[0].items()}))
    uses = [(each.key, tuple(use.replace("-copy", "") for use in each.uses)) for each in second]
    assert uses == [(each.key, each.uses) for each in first]
    assert any("rupture distance" in use for each in second for use in each.uses)


@pytest.mark.parametrize(("chosen", "engine"), [(CHOSEN[0], "cvodes"), (CHOSEN[1], "taylor")])
def test_a_copy_collides_as_the_law(model: Path, chosen: dict[str, str], engine: str) -> None:
    """Every number of the results, of each outcome; of a stick only its outcome is defined."""
    if compiler() is None:
        pytest.skip("no C compiler")
    copies = {name: copy_of(name, law) for name, law in chosen.items()}
    library, own = Scene.load("granulation"), Scene.load("granulation", model=str(model))
    for stokes, angle, outcome in IMPACTS:
        impact = {"stokes": stokes, "angle": angle, "engine": engine}
        first = collide(library.with_entries(chosen), **impact)
        second = collide(own.with_entries(copies), **impact)
        assert (first.outcome, second.outcome) == (outcome, outcome)
        assert first.validity == second.validity
        if outcome != "stick":
            for name in ("restitution", "tangential_restitution", "rotation", "contact_time", "smallest_gap"):
                assert getattr(first, name) == getattr(second, name)
            assert (first.events, first.energy) == (second.events, second.energy)
