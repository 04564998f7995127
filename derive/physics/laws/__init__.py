"""The laws of the model, one per file, each with its source and, where possible, its derivation.

`LAWS[slot][name]` holds every selectable law. Equations call a law through its slot, so eight bridge
laws are eight small modules and not eight copies of the equations.
"""

from .arm import ARMS
from .attraction import ATTRACTIONS
from .base import Law, LawFunction, fill, slot_call
from .bridge import BRIDGES
from .film import FILMS
from .glass import GLASSES
from .shear import SHEARS
from .strings import STRINGS

LAWS: dict[str, dict[str, Law]] = {  # by slot and name
    laws[0].slot: {law.name: law for law in laws}
    for laws in (FILMS, SHEARS, ARMS, GLASSES, BRIDGES, STRINGS, ATTRACTIONS)
}

__all__ = ["LAWS", "Law", "LawFunction", "fill", "slot_call"]
