"""The pages of the reference name everything there is, and what readers copy is right."""

import doctest
import re
import runpy
import shlex
from dataclasses import fields
from importlib import import_module
from pathlib import Path

import click
import pytest
from wetdoublet import solvers
from wetdoublet.generated.automaton import KINDS
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.collision.outcome import Energy
from wetdoublet.solvers.commands.cli import cli
from wetdoublet.solvers.scene import schema
from wetdoublet.solvers.scene.schema import FIELDS

ROOT = Path(__file__).resolve().parents[1]
PAGES = [
    ROOT / "README.md",
    *sorted(path for path in (ROOT / "docs").rglob("*.md") if not path.is_relative_to(ROOT / "docs/_build")),
]
DRAWN = re.compile(r"auto_gallery/images/sphx_glr_(\w+)_\d+\.png")
RESULTS = (ROOT / "docs/reference/results.md").read_text(encoding="utf-8")


def test_every_table_entry_and_choice_has_its_meaning(monkeypatch):
    """What the reference of scenes is made from knows each table, entry and choice, and no other."""
    monkeypatch.syspath_prepend(ROOT / "docs/_ext")
    meanings = import_module("scene_entries").declared_meanings()
    assert {*meanings} == {*FIELDS} and all(meanings.values()) and all(kind.__doc__ for kind in schema.KINDS.values())
    assert not [name for name, field in FIELDS.items() if not all(field.choices.values())]


def test_every_key_of_a_result_is_described():
    """Each key of the JSON object, each term of the ledger and each event stands in the page of results."""
    dense = Scene.load("granulation").with_entries({"liquid.density": "1000 kg/m^3"})
    keys = {*collide(dense).to_dict(), *(field.name for field in fields(Energy)), "residual", *KINDS}
    assert not {key for key in keys if f"`{key}`" not in RESULTS}


def test_links_of_the_front_page_lead_somewhere():
    """What README and CONTRIBUTING link to in the repository is there; links of the site are held by its build."""
    front = "".join((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "CONTRIBUTING.md"))
    targets = re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", front)
    assert len(targets) > 5
    for target in targets:
        assert (ROOT / target).exists(), target


def test_pictures_of_the_pages_are_there():
    """What a page shows from beside it is in the repository; of the gallery the script that draws it."""
    shown = [
        ROOT / f"docs/gallery/{drawn[1]}.py" if (drawn := DRAWN.search(target)) else page.parent / target
        for page in PAGES
        for target in re.findall(r"!\[[^]]*\]\(([^):]+\.png)\)", page.read_text(encoding="utf-8"))
    ]
    assert len(shown) > 5
    assert not [path for path in shown if not path.exists()]


def commands():
    """Every `wetdoublet ...` line in a block of commands, with the page it stands on."""
    for page in PAGES:
        for block in re.findall(r"```(?:console|sh)\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
            for line in block.splitlines():
                found = re.search(r"(?:^|/)wetdoublet (.*)", line.strip().removeprefix("$ "))
                if found:
                    yield pytest.param(found[1], id=f"{page.stem}-{found[1][:40]}")


@pytest.mark.parametrize("line", [*commands()])
def test_commands_of_the_pages_are_understood(line):
    """Each command exists and takes the options it is given; the build of the site runs them."""
    words = shlex.split(line.partition(">")[0], comments=True)
    if words and not words[0].startswith("-"):
        command = cli.get_command(click.Context(cli), words[0])
        assert command is not None, line
        command.make_context(words[0], words[1:], resilient_parsing=False)


@pytest.mark.parametrize("name", sorted(solvers.__all__))
@pytest.mark.slow
def test_every_public_name_has_an_example_that_runs(name):
    """The docstring of each public name has an example, and it gives what it says."""
    value = getattr(solvers, name)
    (example,) = doctest.DocTestFinder(recurse=False).find(value, name, module=import_module(value.__module__))
    assert example.examples, f"{name} has no example"
    example.globs = {}  # it imports what it names, as who copies it has to
    assert not doctest.DocTestRunner().run(example).failed


def test_pages_that_draw_show_their_pictures():
    """Without this line a page shows `<Figure ...>` in place of the picture."""
    pages = [path.read_text(encoding="utf-8") for path in PAGES]
    drawing = [text for text in pages if "{code-cell}" in text and ".plot()" in text]
    assert len(drawing) > 2
    assert all("%matplotlib inline" in text for text in drawing)


def test_the_synthetic_data_are_those_of_their_script():
    """`docs/data/make_synthetic.py` makes the files that lie beside it, and their first line says that they are."""
    folder = ROOT / "docs/data"
    made = runpy.run_path(str(folder / "make_synthetic.py"))["FILES"]
    assert set(made) == {path.name for path in folder.glob("synthetic-*.csv")}
    for name, make in made.items():
        text = (folder / name).read_text(encoding="utf-8")
        assert text == make()
        assert text.startswith("# Synthetic")
