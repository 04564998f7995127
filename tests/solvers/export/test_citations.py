"""`wetdoublet cite`: what a scene rests on, as BibTeX and as JSON."""

import json
import re
from pathlib import Path

import pytest
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.user.template import TEMPLATE
from wetdoublet.generated.references import CITED, REFERENCES
from wetdoublet.solvers import Scene
from wetdoublet.solvers.export.citations import as_bibtex, citations

from ...helpers.command import run

ROOT = Path(__file__).resolve().parents[3]


def keys(scene: Scene) -> list[str]:
    return [each.key for each in citations(scene)]


def entries(text: str) -> dict[str, dict[str, str]]:
    """BibTeX read back: key -> fields; a value is what stands between its braces, which balance."""
    found = {}
    for key, body in re.findall(r"^@\w+\{([^,]+),\n(.*?)^\}$", text, re.S | re.M):
        fields = dict(re.findall(r"^  (\w+) *= \{(.*)\},$", body, re.M))
        assert all(value.count("{") == value.count("}") for value in fields.values())
        found[key] = fields
    return found


def test_each_law_of_the_library_is_in_the_table() -> None:
    """Every selectable law has a row, and every row names publications that are there."""
    assert {f"{slot} {name}" for slot, laws in LAWS.items() for name in laws} < set(CITED)
    assert {key for those in CITED.values() for key in those} == set(REFERENCES)


def test_the_source_of_a_law_names_what_is_cited() -> None:
    """The source that a law's module prints has first author, volume and year of each publication cited for it."""
    for slot, laws in LAWS.items():
        for name, law in laws.items():
            for key in CITED[f"{slot} {name}"]:
                one = REFERENCES[key]
                family = one.authors[0].split(",")[0].replace("é", "e")
                assert family in law.source
                assert f"{one.volume}, {one.pages.split('–')[0]} ({one.year})" in law.source


def test_the_paper_comes_first_and_each_publication_once() -> None:
    """Mikami's law with Mikami's own rupture distance is one entry, for both."""
    scene = Scene.load("granulation").with_entries({"bridge.rupture": "own"})
    found = citations(scene)
    assert found[0].key == "donahue2012mechanisms"
    assert len({each.key for each in found}) == len(found)
    (mikami,) = [each for each in found if each.key.startswith("mikami")]
    assert mikami.uses == ("bridge law mikami", "mikami rupture distance")


@pytest.mark.parametrize(
    ("name", "entries", "cited", "not_cited"),
    [
        ("granulation", {"bridge.law": "willett"}, "willett2000capillary lian1993theoretical", "mikami1998numerical"),
        ("granulation-dry-bridge", {}, "kantak2006elastohydrodynamic", "lian1993theoretical"),
        ("granulation", {"impact.angle": "0 deg"}, "mikami1998numerical", "oneill1970asymmetrical"),
        ("granulation", {"partner.wall": True}, "goldman1967slow", "jeffrey1984calculation"),
        (
            "granulation",
            {"partner.radius": "150 um", "partner.density": "2500 kg/m^3"},
            "jeffrey1984calculation",
            "goldman1967slow",
        ),
        ("granulation", {"attraction.hamaker": "1e-19 J"}, "hamaker1937attraction", "donahue2012doublets"),
        ("pendulum", {}, "donahue2012doublets davis1986collision", "lian1993theoretical"),
    ],
)
def test_what_a_scene_uses_is_cited(name: str, entries: dict[str, object], cited: str, not_cited: str) -> None:
    """Laws, rupture, friction of the partner, attraction and strings are cited where the scene has them only."""
    found = keys(Scene.load(name).with_entries(entries))
    assert set(cited.split()) < set(found)
    assert not_cited not in found


def test_bibtex_says_what_json_says() -> None:
    """Every field of the entries, read back, is that of the JSON object; letters with accents are in LaTeX."""
    told = json.loads(run("cite", "granulation", "--json", "--set", "bridge.law=soulie").stdout)
    read = entries(run("cite", "granulation", "--set", "bridge.law=soulie").stdout)
    assert told["scene"]["bridge.law"] == "soulie"
    assert list(read) == [each["key"] for each in told["references"]]
    for each in told["references"]:
        fields = read[each["key"]]
        names = " and ".join(each["authors"]).replace("é", r"{\'e}")
        assert (fields["author"], fields["title"]) == (names, f"{{{each['title']}}}")
        assert fields["pages"].replace("--", "–") == each["pages"]
        assert (fields["volume"], int(fields["year"]), fields.get("doi", "")) == (
            each["volume"], each["year"], each["doi"],
        )  # fmt: skip
    assert r"Souli{\'e}, F." in read["soulie2006influence"]["author"]


@pytest.mark.slow
def test_a_law_of_ones_own_is_cited_by_its_source(tmp_path: Path) -> None:
    """A user's law is an entry that holds its source; with `bibtex` it is that entry, as given."""
    entry = "@article{me2020, author = {Me}, title = {A bridge}, year = {2020}}"
    more = f'law("bridge", "weak", bibtex="{entry}", force=capillary_force / 2)'
    (tmp_path / "mine.py").write_text(f"{TEMPLATE}\n{more}\n")
    scene = Scene.load("granulation", model=tmp_path / "mine.py")
    by_source, by_entry = (citations(scene.with_entries({"bridge.law": name}))[-1] for name in ("yielding", "weak"))
    assert (by_source.uses, by_entry.uses) == (("bridge law yielding",), ("bridge law weak",))
    assert entries(as_bibtex((by_source,)))["bridge-yielding"]["note"] == "illustration: not a published law"
    assert by_entry.bibtex == entry


def test_citation_file_agrees() -> None:
    """CITATION.cff has the paper as `cite` has it."""
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    paper = REFERENCES["donahue2012mechanisms"]
    assert f'title: "{paper.title}"' in text
    assert f"doi: {paper.doi}\n" in text
    assert re.findall(r"family-names: (\w+)", text) == [author.split(",")[0] for author in paper.authors]
