"""Collisions by the Taylor kernel: the same as by other engines and as the reference, at the tolerance asked for."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from wetdoublet.solvers import Scene, collide, collide_many
from wetdoublet.solvers.engines.taylor import build as library
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.scenefile import PRESETS

from ....helpers.command import quiet
from ....helpers.flags import QUICK
from ....helpers.own_arm import described

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.slow]


@pytest.fixture(autouse=True)
def shipped(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Compile as users do, not with the flags of the other tests; of the references those of presets."""
    asked = request.getfixturevalue("reference")["name"] if "reference" in request.fixturenames else "granulation"
    if asked in PRESETS:
        monkeypatch.delenv("WETDOUBLET_CFLAGS")
    library.kernel.cache_clear()
    yield
    library.kernel.cache_clear()


def test_reference_collisions(reference: dict[str, Any]):
    """The independent 80-bit reference, to its error and ours: 1e-13 times the conditioning, with some steps' worth."""
    expected = reference["results"]
    found = collide(described(reference["scene"]), **reference["impact"], rtol=1e-13, engine="taylor")
    assert (found.engine, found.outcome) == ("taylor", expected["outcome"])
    if found.outcome == "stick":
        return
    for name in ("restitution", "tangential_restitution", "rotation", "contact_time", "smallest_gap", "final_spin"):
        if expected[name] is None:
            assert getattr(found, name) is None, name
        else:
            assert getattr(found, name) == pytest.approx(expected[name], rel=1e-10, abs=1e-13), name
    assert found.reversal == expected["reversal"]
    assert [event.kind for event in found.events] == [event["kind"] for event in expected["events"]]
    for mine, theirs in zip(found.events, expected["events"], strict=True):
        assert mine.time == pytest.approx(theirs["time"], rel=1e-10, abs=1e-300)
    for term, value in found.energy.to_dict().items():
        assert value == pytest.approx(expected["energy"][term], abs=1e-11 * expected["energy"]["initial"]), term


@pytest.mark.skipif(os.name != "posix", reason="environments as on POSIX")
def test_the_cache_does_not_decide(tmp_path: Path):
    """With an empty cache, a filled one and one that cannot be written the kernel answers, with the same digits."""
    (tmp_path / "file").write_text("")
    words = "collide", "granulation", "--stokes", "0.3", "--angle", "0", "--rtol", "1e-8", "--json"
    runs = [
        subprocess.run(
            (sys.executable, "-m", "wetdoublet.solvers", *words), capture_output=True, text=True, check=True,
            env=os.environ | {"WETDOUBLET_CFLAGS": QUICK, "WETDOUBLET_CACHE": str(tmp_path / folder / "cache")},
        )
        for folder in ("", "", "file")
    ]  # fmt: skip
    assert [quiet(done.stderr).count("\n") for done in runs] == [0, 0, 1]
    assert "kept in" in runs[2].stderr
    assert runs[0].stdout == runs[1].stdout == runs[2].stdout
    found = json.loads(runs[0].stdout)
    assert found["engine"] == "taylor"
    reference = collide("granulation", stokes=0.3, angle=0, rtol=1e-8, engine="cvodes")
    assert found["restitution"] == pytest.approx(reference.restitution, rel=1e-7)


def test_a_kernel_is_compiled_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The library is addressed by its content and found again by the next process; nothing else is left behind."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path))
    monkeypatch.setenv("WETDOUBLET_CFLAGS", QUICK)  # flags with which no kernel is shipped
    scene, kept = Scene.load("granulation-dry-bridge"), []
    for _ in range(2):
        library.kernel.cache_clear()
        collide_many(scene, stokes=0.5, angle=0.0, engine="taylor")
        made = [path for path in tmp_path.iterdir() if not path.name.startswith("compiler-")]  # tried by the first
        kept.append([(path.name, path.stat().st_mtime_ns) for path in made])
    library.kernel.cache_clear()
    assert kept[0] == kept[1]
    assert [(name.partition("-")[0], Path(name).suffix) for name, _ in kept[0]] == [("taylor", ".so")]
