"""A dozen structures in which every pair of choices occurs together, with the laws distributed over them."""

import itertools
from collections.abc import Mapping, Sequence

from wetdoublet.solvers.host.emitted import LAWS

Structure = dict[str, str]

CHOICES: dict[str, tuple[str, ...]] = {
    "partner": ("", "sphere", "wall"),
    "spins": ("", "both"),
    "friction": ("", "yes"),
    "attraction": ("", "yes"),
    "bridge": ("", "law"),
    "strings": ("", "yes"),
    "head-on": ("", "yes"),
}
_LAWS: dict[str, tuple[str, ...]] = {
    "bridge": tuple(LAWS["bridge"]),
    "film": ("finite", "infinite", "cavitating", "constant-volume"),
    "tangential": ("immersed", "film"),
    "glass": ("literal", "film-corrected"),
    "rupture": ("common", "own"),
    "friction": ("solid", "all"),
    "strings": ("exact", "small-angle"),
}


def valid(structure: Mapping[str, str]) -> bool:
    """Whether a scene may have these choices: strings hold equal spheres without spins at an oblique impact."""
    strung = bool(structure.get("strings"))
    return not (strung and (structure.get("partner") or structure.get("spins") or structure.get("head-on")))


def _pairs(structure: Mapping[str, str]) -> set[tuple[tuple[str, str], tuple[str, str]]]:
    """All pairs of choices that occur together."""
    return set(itertools.combinations(structure.items(), 2))


def covering(choices: Mapping[str, Sequence[str]] = CHOICES) -> list[Structure]:
    """Structures that together have every valid pair of choices, by the greedy method; most have a bridge."""
    names = list(choices)
    every = [dict(zip(names, values)) for values in itertools.product(*choices.values())]
    every = [structure for structure in every if valid(structure)]
    missing = set().union(*map(_pairs, every))
    chosen: list[Structure] = []
    while missing:
        chosen.append(max(every, key=lambda structure: (len(_pairs(structure) & missing), structure["bridge"])))
        missing -= _pairs(chosen[-1])
    for structure in chosen:
        others = set().union(*(_pairs(other) for other in chosen if other is not structure))
        if _pairs(structure) <= others | _pairs(structure | {"bridge": "law"}):
            structure["bridge"] = "law"
    return chosen


def with_laws(structures: Sequence[Structure]) -> list[Structure]:
    """The structures with laws that take turns, so that each occurs."""
    turns = {slot: itertools.cycle(laws) for slot, laws in _LAWS.items()}
    found = []
    for structure in structures:
        bridge = next(turns["bridge"]) if structure["bridge"] else ""
        film = next(turns["film"])
        if film == "constant-volume" and not bridge:
            film = next(turns["film"])  # which needs the volume of a bridge
        rim = film != "constant-volume"
        found.append(
            structure
            | {
                "bridge": bridge,
                "film": film,
                "tangential": next(turns["tangential"]) if rim else "immersed",
                "glass": next(turns["glass"]) if rim else "literal",
                "rupture": next(turns["rupture"]) if "rupture_distance" in LAWS["bridge"].get(bridge, ()) else "common",
                "friction": next(turns["friction"]) if structure["friction"] else "",
                "strings": next(turns["strings"]) if structure["strings"] else "",
            }
        )
    return found


STRUCTURES = with_laws(covering())


def name(structure: Mapping[str, str]) -> str:
    """Its choices in words."""
    words = [word for slot, word in structure.items() if word and word != "yes"]
    return " ".join([*words, *(slot for slot in ("attraction", "head-on") if structure[slot])])
