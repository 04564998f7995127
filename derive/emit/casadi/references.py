"""The publications of laws as a Python module, read by `wetdoublet cite`."""

from ...laws import LAWS, Law
from ...physics.partners import PUBLISHED
from ...physics.references import PAPER, WALTON, Reference
from ...physics.scaling import COMMON, ELASTIC
from ..provenance import PROVENANCE

_DOC = "Where the equations and the laws are published."
_FIELDS = {
    "authors": "tuple[str, ...]  # family, initials", "title": "str", "journal": "str", "volume": "str",
    "pages": "str  # first–last, or the number of the article", "year": "int", "doi": 'str  # "" where it is not known',
}  # fmt: skip


def of_law(law: Law) -> dict[str, tuple[Reference, ...]]:
    """Publications of a law, and of the rupture distance that it has."""
    ruptures = (function.references for function in law.functions if function.name == "rupture_distance")
    return {f"{law.slot} {law.name}": law.references} | {f"rupture {law.name}": published for published in ruptures}


def cited() -> dict[str, tuple[Reference, ...]]:
    """Publications by what they describe: the paper, laws by slot and name, and parts that fill no slot."""
    result: dict[str, tuple[Reference, ...]] = {"paper": (PAPER,)}
    for laws in LAWS.values():
        for law in laws.values():
            result |= of_law(law)
    result["rupture common"] = COMMON
    result |= {f"friction {partner}": references for partner, references in PUBLISHED.items()}
    return result | {"elastic length": ELASTIC, "friction contact": (WALTON,)}


def references_module() -> str:
    """Text of `generated/references.py`."""
    uses = cited()
    lines = [f"# {PROVENANCE}", f'"""{_DOC}"""', "", "from __future__ import annotations", ""]
    lines += ["from typing import NamedTuple", "", "", "class Reference(NamedTuple):"]
    lines += ['    """An article in a journal."""', "", *(f"    {name}: {kind}" for name, kind in _FIELDS.items())]
    lines += ["", "", "REFERENCES = {"]
    for work in dict.fromkeys(entry for references in uses.values() for entry in references):
        lines += [f'    "{work.key}": Reference(', *(f"        {getattr(work, name)!r}," for name in _FIELDS), "    ),"]
    lines += ["}", "CITED: dict[str, tuple[str, ...]] = {"]
    lines += [f'    "{use}": {tuple(work.key for work in references)!r},' for use, references in uses.items()]
    return "\n".join([*lines, "}", ""])
