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
        "opening": 1.5, "restitution": E_N, "events": ["turned", "rupture"], "text": "flight\nends\n",
    },
}  # fmt: skip


def compared(tmp_path: Path, after: list[dict[str, Any]]) -> tuple[int, str]:
    """How many records differ from RECORD's, and what is said of them."""
    files, said = (tmp_path / "before", tmp_path / "after"), []
    files[0].write_text(json.dumps(RECORD) + "\n")
    files[1].write_text("".join(json.dumps(one) + "\n" for one in after))
    _, differ = two_trees.compared(*files, said.append)
    return differ, "\n".join(said)


def with_value(**changes: Any) -> list[dict[str, Any]]:
    return [RECORD | {"value": RECORD["value"] | changes}]


NEXT = {"restitution": math.nextafter(E_N, 1)}


@pytest.mark.parametrize(
    "changes", [NEXT, {"restitution": None}, {"events": ["turned"]}, {"text": "flight\nended\n"}, {"more": 1}], ids=str
)
def test_any_difference_is_reported_with_its_place(tmp_path: Path, changes: dict[str, Any]) -> None:
    """The last bit of a number, an event, a line of text, a field; a record on one side alone; and nothing else."""
    differ, said = compared(tmp_path, with_value(**changes))
    assert differ == 1
    assert f"/{next(iter(changes))}" in said
    assert [compared(tmp_path, after)[0] for after in ([RECORD], [])] == [0, 1]
