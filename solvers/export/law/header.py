"""NAME.h: the law as a host sees it, and its structures for ctypes."""

import re
from collections.abc import Iterable, Sequence

from ....generated.automaton import CRITERIA, KINDS, OUTCOMES
from ...engines.settings import KERNEL_STEPS
from ...scene.scene import Scene
from .comments import comment
from .contact import contact_header
from .material import LARGEST, Number, Result
from .pair import pair_header
from .space import declarations

_MEANINGS = ("no separation", "separated, and no rebound criterion was met", "separated after a rebound")
_OUTCOMES = [(word.upper().replace("-", "_"), k, _MEANINGS[k]) for k, word in enumerate(OUTCOMES)]
RESULTS = (
    ("int", "status", "LAW_OK, or why there is no answer"),
    ("int", "outcome", "LAW_STICK, LAW_STICK_ROTATE_SEPARATE, LAW_BOUNCE; LAW_UNDECIDED without an answer"),
    ("int", "certified", "1 where a stick is proved, else 0"),
    ("int", "rebound", "the first rebound criterion that was met, LAW_NO_REBOUND if none"),
    ("double", "restitution", "normal velocity at separation over the approach speed; 0 of a stick; it may exceed 1"),
    ("double", "tangential_restitution", "r omega at separation over its value at initial contact; NaN at angle 0"),
    ("double", "slip_restitution", "velocity of the surfaces at the contact over its value at initial contact"),
    ("double", "contact_time", "s, from initial contact to separation"),
    ("double", "rotation", "rad, angle that the line of centres has turned at separation"),
    ("double", "smallest_gap", "m"),
    ("double", "final_gap", "m, at separation"),
    ("double", "final_spin", "rad/s, of the sphere at separation"),
    ("double", "final_partner_spin", "rad/s, of the partner at separation"),
    ("double", "final_rotation_rate", "rad/s, of the line of centres at separation"),
)
Fields = list[tuple[str, str, tuple[int, ...]]]
"""Members of a structure: type, name, shape."""


def header(
    scene: Scene,
    of_material: Sequence[Number],
    of_impact: Sequence[Number],
    entries: Sequence[Number],
    statuses: Sequence[Result],
    ledger: bool,
) -> str:
    """The text of NAME.h, with `law_` and `LAW_` in the place of the law's prefix."""
    lines = ["#ifndef LAW_H", "#define LAW_H", "", "#ifdef __cplusplus", 'extern "C" {', "#endif", ""]
    lines += [
        *comment(
            "What collides, in SI units. Each number is zero or between "
            f"{1 / LARGEST:g} and {LARGEST:g} in magnitude (but for limits that are never met), within the range said "
            "here; others are refused. "
            "law_default_material() has the scene's."
        ),
        *_structure("law_material", of_material),
        "law_material law_default_material(void);",
        "",
        *pair_header(scene, entries),
        *comment(_frame(scene)),
        *_structure("law_impact", of_impact),
        *comment("Outcomes."),
        *_enumeration([("UNDECIDED", -1, "there is no answer; `status` says why"), *_OUTCOMES]),
        *comment("Rebound criteria."),
        *_enumeration(
            [("NO_REBOUND", -1, "none was met")]
            + [(word.upper(), KINDS.index(word), row.name) for word, row in CRITERIA.items()]
        ),
        *comment("Statuses: LAW_OK; UNDECIDED_...: no answer to this impact; from 100 on: bad input."),
        *_enumeration([(status.name, status.number, status.message) for status in statuses]),
        *comment("A status in words. The text is never null, and must not be freed."),
        "const char *law_message(int status);",
        "",
        *comment(
            "What a collision comes to. Without an answer, and for a stick (but for `outcome`, `certified`, `rebound` "
            "and `restitution`), numbers are NaN."
        ),
        "typedef struct {",
        *(f"    {kind} {name}; /* {what} */" for kind, name, what in RESULTS),
        "} law_collision;",
        "",
        *comment(
            "One collision. `rtol` is the relative tolerance of the integration, 1e-13 to 1e-3; at most 1e-6 is used. "
            f"`budget` is the largest number of steps; 0 is {KERNEL_STEPS}. Beyond it the status is "
            "LAW_UNDECIDED_NO_BUDGET. "
            "Returns found->status. Reentrant: nothing is allocated, and no data is shared between calls."
        ),
        "int law_collide(",
        "    const law_material *material, const law_impact *impact, double rtol, int budget, law_collision *found);",
        "",
        *comment(
            "`count` collisions of one material, side by side where the processor has vectors. Returns how many have "
            "another status than LAW_OK. The results are those of single calls, up to the last digits."
        ),
        "long law_collide_many(",
        "    const law_material *material, const law_impact *impacts, long count, double rtol, int budget,",
        "    law_collision *found);",
        "",
        *contact_header(ledger),
        *declarations(scene),
        "#ifdef __cplusplus",
        "}",
        "#endif",
        "",
        "#endif",
        "",
    ]
    return "\n".join(lines)


def message_function(statuses: Sequence[Result]) -> str:
    """The C function with a text for every status."""
    lines = ["const char *law_message(int status)", "{", "    switch (status) {"]
    for status in statuses:
        lines += [f"    case LAW_{status.name}:", f'        return "{status.message}";']
    return "\n".join([*lines, "    }", '    return "no such status";', "}", ""])


def default_material(of_material: Sequence[Number]) -> str:
    """The C function that returns the scene's numbers."""
    values = [f"    m.{number.name} = {number.value!r};" for number in of_material]
    return "\n".join(
        ["law_material law_default_material(void)", "{", "    law_material m;", *values, "    return m;", "}", ""]
    )


def _frame(scene: Scene) -> str:
    """How an impact is described, and what follows from its results, for the geometry of the scene."""
    if scene.wall:
        return (
            "An impact on a wall, in the wall's frame: the sphere approaches with `speed`, and its centre has the "
            "velocity speed tan(angle) along the wall. A spin is positive as it rolls along that velocity. After "
            "separation the velocities are restitution speed, away from the wall, and tangential_restitution speed "
            "tan(angle) along it."
        )
    if scene.pendulum is not None:
        return (
            "An impact of two spheres on strings: `speed` is their relative velocity along the line of centres, and "
            "speed tan(angle) that across."
        )
    return (
        "An impact, from vectors: n is the unit vector from the sphere's centre to the partner's, v the partner's "
        "velocity relative to the sphere's, t = v - (v.n) n, R the sum of the radii. Then speed = -v.n, tan(angle) = "
        "|t| R/(speed (R + film_thickness)), and spins are components along w = n x t/|t|, about which the line of "
        "centres begins to turn. At separation n' = cos(rotation) n + sin(rotation) w x n, and the partner moves "
        "relative to the sphere with restitution speed n' + final_rotation_rate (R + final_gap) w x n'; the pair's "
        "momentum is what it was."
    )


def _structure(name: str, numbers: Iterable[Number]) -> list[str]:
    fields = [
        f"    double {item.name}; /* {'' if item.unit == '1' else item.unit + ', '}{item.in_words}: {item.meaning} */"
        for item in numbers
    ]
    return ["typedef struct {", *fields, f"}} {name};", ""]


def _enumeration(rows: Iterable[tuple[str, int, str]]) -> list[str]:
    return ["enum {", *(f"    LAW_{name} = {number}, /* {what} */" for name, number, what in rows), "};", ""]


def structures(header: str) -> dict[str, Fields]:
    """The structures that a host fills or reads, by name."""
    bodies = re.findall(r"typedef struct \{([^}]*)\} (law_\w+);", header)
    return {
        name: [
            (kind, member, tuple(map(int, re.findall(r"\d+", shape))))
            for kind, member, shape in re.findall(r"^ *(int|double|law_\w+) (\w+)((?:\[\d+\])*);", body, re.MULTILINE)
        ]
        for body, name in bodies
    }


def ctypes_fields(fields: Fields) -> str:
    """The members as fields of a ctypes structure."""
    kinds = ("".join([f"ctypes.c_{kind}", *(f" * {n}" for n in reversed(shape))]) for kind, _, shape in fields)
    return ", ".join(f'("{name}", {kind})' for kind, (_, name, _) in zip(kinds, fields, strict=True))
