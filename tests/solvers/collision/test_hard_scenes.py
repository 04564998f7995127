"""Scenes in which a collision once came out wrong, did not end or was not decided, each with its fact, as a table."""

import json
from typing import Any

import pytest
from wetdoublet.solvers import Scene, collide

from ...helpers.data import DATA
from ...helpers.scanned import scanned

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")]
ROWS: dict[str, dict[str, Any]] = json.loads((DATA / "hard_scenes.json").read_text())


def scene_of(row: dict[str, Any]) -> Scene:
    """From tables, or a preset and its changes."""
    return Scene.load(row["preset"]).with_entries(row["scene"]) if "preset" in row else Scene.from_dict(row["scene"])


@pytest.mark.parametrize("name", ROWS)
def test_a_hard_scene(name: str) -> None:
    """Outcome, proof, events and e_n by each engine itself, a closed ledger; e_n of the reference if it is followed.

    `same` events are all that the engines have, `first` and `last` one of them; `steps` and `most` events are limits.
    """
    row = ROWS[name]
    scene, options = scene_of(row), {each: row[each] for each in ("rtol", "until") if each in row}
    found = [collide(scene, engine=engine, **options) for engine in row["engines"]]
    for each, engine in zip(found, row["engines"], strict=True):
        assert (each.outcome, each.certified) == (row["outcome"], row["certified"]), engine
        assert each.engine in (engine, "taylor")  # which answers where another cannot follow
        kinds = [event.kind for event in each.events]
        assert kinds == row.get("events", kinds)
        assert not kinds or (row.get("first", kinds[0]), row.get("last", kinds[-1])) == (kinds[0], kinds[-1])
        assert len(kinds) <= row.get("most", len(kinds)) and each.steps <= row.get("steps", each.steps)
        assert each.restitution == pytest.approx(found[0].restitution, rel=row.get("rel", 1e-7))
        if "same" in row:
            assert kinds == [event.kind for event in found[0].events]
        assert each.energy is not None and abs(each.energy.residual) < 1e-7 * each.energy.largest
    if "reference" in row:
        expected = scanned(scene, row.get("rtol", 1e-9))
        assert expected.outcome == row["outcome"]
        if row["reference"] != "its end":  # where chatter is cut off is a choice
            assert [event.kind for event in found[0].events] == [kind for kind, _ in expected.events]
        assert found[0].restitution == pytest.approx(expected.restitution, rel=row.get("rel", 1e-7))
        assert found[0].final_spin == pytest.approx(expected.spins[0], rel=1e-6, abs=1e-9 * scene.speed)
