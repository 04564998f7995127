"""The comparison of two trees sees what differs, and only that."""

import importlib.util
import json
import math
import sys
from pathlib import Path
from typing import Any

import pytest

_SPEC = importlib.util.spec_from_file_location("two_trees", Path(__file__).with_name("two_trees.py"))
assert _SPEC and _SPEC.loader
two_trees = sys.modules[_SPEC.name] = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(two_trees)

E_N = 0.5022308903692647
RECORD: dict[str, Any] = {
    "what": "collide", "name": "collide: one", "count": 1,
    "value": {
        "opening": 1.5.hex(), "restitution": E_N.hex(), "events": ["turned", "rupture"], "text": "flight\nends\n",
    },
}  # fmt: skip


def compared(tmp_path: Path, after: list[dict[str, Any]], *words: tuple[str, str], **more: Any) -> tuple[int, str]:
    """How many records differ from RECORD's, and what is said of them."""
    files, said = (tmp_path / "before", tmp_path / "after"), []
    files[0].write_text(json.dumps(RECORD | more) + "\n")
    files[1].write_text("".join(json.dumps(one) + "\n" for one in after))
    _, differ = two_trees.compared(*files, two_trees.Renaming(words), said.append)
    return differ, "\n".join(said)


def with_value(**changes: Any) -> list[dict[str, Any]]:
    return [RECORD | {"value": RECORD["value"] | changes}]


def test_what_is_equal_agrees(tmp_path: Path) -> None:
    """Two files with the same answers differ nowhere."""
    assert compared(tmp_path, [RECORD])[0] == 0


@pytest.mark.parametrize(
    "changes",
    [
        {"restitution": math.nextafter(E_N, 1).hex()}, {"restitution": None}, {"events": ["turned"]},
        {"events": ["turned", "rests"]}, {"text": "flight\nended\n"}, {"more": 1},
    ],
    ids=str,
)  # fmt: skip
def test_any_difference_is_reported(tmp_path: Path, changes: dict[str, Any]) -> None:
    """The last bit of a number, an event, a line of text, a field: each is told with its place."""
    differ, said = compared(tmp_path, with_value(**changes))
    assert differ == 1
    assert f"/{next(iter(changes))}" in said


def test_an_answer_that_one_tree_lacks_is_reported(tmp_path: Path) -> None:
    """A record on one side alone is a difference."""
    assert compared(tmp_path, [])[0] == 1


def test_a_tolerance_is_of_its_number_alone(tmp_path: Path) -> None:
    """The last bit may differ where a tolerance allows it, and no other value."""
    after = with_value(restitution=math.nextafter(E_N, 1).hex())
    assert compared(tmp_path, after, tolerance={"/restitution": (1e-15).hex()})[0] == 0
    assert compared(tmp_path, after, tolerance={"/restitution": (1e-17).hex()})[0] == 1
    assert compared(tmp_path, after, tolerance={"/opening": (1e-15).hex()})[0] == 1


def test_renamed_words_are_accepted_where_they_lead_to_what_is_there(tmp_path: Path) -> None:
    """A renamed key and a renamed word of a text agree; another word in their place does not."""
    value = {"normal_velocity": (1.5).hex()} | {k: v for k, v in RECORD["value"].items() if k != "opening"}
    words = (("opening", "normal_velocity"), ("flight", "trajectory"))
    after = [RECORD | {"value": value | {"text": "trajectory\nends\n"}}]
    assert compared(tmp_path, after, *words)[0] == 0
    assert compared(tmp_path, after)[0] == 1
    assert compared(tmp_path, [RECORD | {"value": value | {"text": "orbit\nends\n"}}], *words)[0] == 1
