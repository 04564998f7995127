"""What to cite for a scene: the paper, and where each law that it uses is published."""

from collections.abc import Iterator
from typing import Any

from ...generated.references import CITED, REFERENCES, Reference
from ..model.model import select_model
from ..scene.items import item
from ..scene.origin import Record
from ..scene.scene import Scene

_LATEX = str.maketrans(
    {"&": r"\&", "%": r"\%", "#": r"\#", "_": r"\_", "$": r"\$", "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}",
     "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "\n": " ",
     "ä": r'{\"a}', "ö": r'{\"o}', "ü": r'{\"u}', "é": r"{\'e}", "–": "--"}
)  # fmt: skip


class Citation(Record):
    """A publication, what of the scene it stands for, and its BibTeX entry."""

    key: str = item('of the entry; "" where a user\'s model gives an entry of its own')
    uses: tuple[str, ...] = item('such as "bridge law willett"')
    bibtex: str
    reference: Reference | None = item("what the entry is made of; None for a user's law", default=None)

    def to_dict(self) -> dict[str, Any]:
        """As `wetdoublet cite --json` has it."""
        fields = {} if self.reference is None else self.reference._asdict()
        return {"key": self.key or None, "uses": list(self.uses), **fields, "bibtex": self.bibtex}


def citations(scene: Scene) -> tuple[Citation, ...]:
    """What to cite for a scene, the paper first; each publication once.

    Without an impact angle the collision is taken to be oblique.
    """
    uses_of: dict[str, list[str]] = {}
    cited, works = _known(scene)
    for use, name in _uses(scene):
        for key in cited.get(name, ()):
            uses_of.setdefault(key, []).append(use)
    listed = [Citation(key, tuple(uses), _entry(key, works[key]), works[key]) for key, uses in uses_of.items()]
    return (*listed, *_own(scene))


def _known(scene: Scene) -> tuple[dict[str, tuple[str, ...]], dict[str, Reference]]:
    """The tables of publications, with those of the laws of a user's model."""
    cited, works = dict(CITED), dict(REFERENCES)
    for law in [] if scene.package is None else scene.package.manifest["laws"]:
        for use, published in law.get("references", {}).items():
            cited[use] = tuple(reference["key"] for reference in published)
            works |= {entry["key"]: Reference(*(entry[name] for name in Reference._fields)) for entry in published}
    return cited, works


def as_bibtex(entries: tuple[Citation, ...]) -> str:
    """The entries, each below a comment that says what it stands for."""
    return "\n\n".join(f"% {', '.join(citation.uses)}\n{citation.bibtex}" for citation in entries)


def _oblique(scene: Scene) -> bool:
    return scene.angle is None or scene.turns(scene.angle)


def _uses(scene: Scene) -> Iterator[tuple[str, str]]:
    """What the scene uses, in words, and its key in the table of publications."""
    choice = select_model(scene, _oblique(scene), full=True, fold=True)
    yield "equations", "paper"
    for slot, law in choice.laws:
        if slot != "glass" or "liquid.glass_transition_pressure" in scene.entries:
            yield f"{slot} law {law}", f"{slot} {law}"
    if scene.bridge is not None:
        which = scene.bridge.law if scene.bridge.rupture == "own" else "common"
        yield f"{which} rupture distance", f"rupture {which}"
    for partner, what in (("pair", "friction of unequal spheres"), ("wall", "friction beside a wall")):
        if partner in choice.structure.split("_"):
            yield what, f"friction {partner}"
    if scene.particles.friction is not None:
        yield "friction of the dry contact", "friction contact"
    if scene.particles.youngs_modulus is not None:
        yield "elastic criterion", "elastic length"


def _entry(key: str, work: Reference) -> str:
    fields = {
        "author": " and ".join(work.authors), "title": work.title, "journal": work.journal, "volume": work.volume,
        "pages": work.pages, "year": str(work.year),
    }  # fmt: skip
    written = {name: text.translate(_LATEX) for name, text in fields.items()}
    written["title"] = f"{{{written['title']}}}"  # capitals as they are
    if work.doi:
        written["doi"] = work.doi
    return _bibtex("article", key, written)


def _own(scene: Scene) -> Iterator[Citation]:
    """The laws of a user's model that are used and name no publication: BibTeX, or an entry with the source's text."""
    used = dict(select_model(scene, _oblique(scene), full=True, fold=True).laws)
    for law in [] if scene.package is None else scene.package.manifest["laws"]:
        use, key = f"{law['slot']} law {law['name']}", f"{law['slot']}-{law['name']}"
        if used.get(law["slot"]) != law["name"] or any(law.get("references", {}).values()):
            continue
        if law.get("bibtex"):
            yield Citation("", (use,), law["bibtex"].strip())
        else:
            fields = {"title": law["meaning"], "note": law.get("source", "no source given")}
            written = {name: text.translate(_LATEX) for name, text in fields.items()}
            yield Citation(key, (use,), _bibtex("misc", key, written))


def _bibtex(kind: str, key: str, fields: dict[str, str]) -> str:
    lines = [f"  {name:<7} = {{{text}}}," for name, text in fields.items()]
    return "\n".join([f"@{kind}{{{key},", *lines, "}"])
