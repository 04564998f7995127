"""What comes from the store is what is derived, and nothing comes from it where it is closed."""

import json
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from wetdoublet.derive.emit.casadi.modules import law_module, structure_module
from wetdoublet.derive.emit.provenance import law_digest, model_digest
from wetdoublet.derive.equations.model import Model, derive
from wetdoublet.derive.equations.store import opened, stored
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics.structure import BRIDGED, all_structures


def from_store(made: object) -> object:
    """What comes back of an object that was stored."""
    entries: dict[str, bytes] = {}

    def place(name: str, make: Callable[[], bytes]) -> bytes:
        return entries.setdefault(name, b"") or entries.update({name: make()}) or entries[name]

    with opened(place):
        assert stored("it", lambda: made) is made
        return stored("it", lambda: None)


def test_models_and_laws_come_back_as_they_were(models: dict[str, Model]) -> None:
    """Equal, with the same digests, and emitted as the same text; roots, calls of laws and assumptions included."""
    more = (shape for shape in all_structures() if shape.friction and shape.partner == "pair" and shape.spread)
    for model in (*models.values(), derive(next(more))):
        again = from_store(model)
        assert isinstance(again, Model) and again is not model
        assert again == model and model_digest(again) == model_digest(model)
        assert structure_module(again) == structure_module(model)
    back = from_store(LAWS)
    assert back == LAWS and isinstance(back, dict)
    for slot, laws in LAWS.items():
        for name, law in laws.items():
            assert law_digest(back[slot][name]) == law_digest(law)
            assert law_module(back[slot][name]) == law_module(law)


@pytest.mark.parametrize("entry", [b"", b"foreign bytes", b"cnowhere\nto_be_found\n.", pickle.dumps(LAWS)[:-9]])
def test_an_entry_that_cannot_be_read_is_derived_anew(entry: bytes) -> None:
    """Whatever stands under its name: a missing entry, other bytes, a class that is no more, a part of it."""
    with opened(lambda name, make: entry):
        assert stored("it", lambda: 1) == 1


def test_a_closed_store_is_not_asked() -> None:
    """Each time it is made, as for the checks, which are of the derivation and not of what is kept of it."""
    assert stored("it", lambda: 1) == 1
    assert stored("it", lambda: 2) == 2
    assert derive.__wrapped__(BRIDGED) == derive(BRIDGED)


_READ = """
import json, sys
from pathlib import Path
from wetdoublet.solvers.host.emitted import deriving
with deriving():
    from wetdoublet.derive.laws.modelfile import read
    before = "wetdoublet.derive.laws.film" in sys.modules
    model = read(Path("mine.py"), sys.argv[1])
print(json.dumps([before, [law.name for law in model.laws], str(model.laws[0].functions[0].result)]))
"""
_MODEL = """
from wetdoublet.derive.user import *
from wetdoublet.derive.laws.film import normal_force
law("bridge", "mine", force=2 * pi * a * sigma * normal_force() / (mu * a * u))
"""


@pytest.mark.slow
def test_a_model_file_may_import_laws_that_come_from_the_store(tmp_path: Path) -> None:
    """Imported by the model file alone, or a module that it imports, they still are the library's: it has its own."""
    environment = os.environ | {"WETDOUBLET_CACHE": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
    (tmp_path / "helper.py").write_text("from wetdoublet.derive.laws.film import normal_force\n")
    indirect = _MODEL.replace("wetdoublet.derive.laws.film", "helper")
    first, *others = (
        json.loads(
            subprocess.run(
                [sys.executable, "-c", _READ, model], env=environment, capture_output=True, text=True, check=True
            ).stdout
        )
        for model in (_MODEL, _MODEL, indirect)
    )
    assert first[:2] == [True, ["mine"]]
    assert others == [[False, *first[1:]]] * 2
