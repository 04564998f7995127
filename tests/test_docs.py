"""The reference pages name everything there is."""

import re
from dataclasses import fields
from pathlib import Path

import pytest
from wetdoublet.generated.automaton import KINDS
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.collision.outcome import Energy
from wetdoublet.solvers.scene.schema import FIELDS, TABLES

ROOT = Path(__file__).resolve().parents[1]
SCENES, RESULTS = ((ROOT / "docs" / name).read_text(encoding="utf-8") for name in ("scenes.md", "results.md"))


def section(table):
    """Return what the page of scenes says of a table."""
    return SCENES.partition(f"## `[{table}]`")[2].partition("\n## ")[0]


@pytest.mark.parametrize("table", TABLES)
def test_every_entry_and_choice_is_described(table):
    """Each key of a scene, and each choice it has, stands under its table."""
    for name in TABLES[table]:
        words = (name.partition(".")[2], *FIELDS[name].choices)
        assert all(f"`{word}`" in section(table) for word in words), name


def test_the_complete_scene_loads():
    """The example has every table but a partner, which cannot be beside strings, and is right."""
    (text,) = re.findall(r"```toml\n(.*?)```", SCENES, re.DOTALL)
    assert set(Scene.from_toml(text).to_dict()) == {"name", *TABLES} - {"partner"}


def test_every_key_of_a_result_is_described():
    """Each key of the JSON object, each term of the ledger and each event stands in the page of results."""
    dense = Scene.load("granulation").with_entries({"liquid.density": "1000 kg/m^3"})
    keys = {*collide(dense).to_dict(), *(field.name for field in fields(Energy)), "residual", *KINDS}
    assert not {key for key in keys if f"`{key}`" not in RESULTS}


@pytest.mark.parametrize("page", ["README.md", *(f"docs/{path.name}" for path in (ROOT / "docs").glob("*.md"))])
def test_links_lead_somewhere(page):
    """Every link to a file of the repository has its file."""
    text = (ROOT / page).read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#:]+)\)", text):
        assert ((ROOT / page).parent / target).is_file(), target
