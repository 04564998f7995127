"""The text of a kernel: emitted headers and the runtime, with the options and compiler flags of its variant.

Imported when the package is built, too, and so without CasADi.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ...host.compiler import more_flags
from ...model.key import ModelKey
from ..machine import InstructionSet, lanes
from .headers import automaton, books_own, has_events, headers, tangents
from .layout import MORE_RESULTS, MOST_STEPS, SHOWN, SHOWN_IN_SPACE, declarations

# No -ffast-math: NaN and infinity are compared. Products may be fused with sums; sqrt does not set errno.
# -w: the tests compile every file with -Wall -Wextra -Werror; warnings of a newer compiler should not reach users.
_COMMON = ("-fno-math-errno", "-ffp-contract=fast", "-fPIC", "-shared", "-std=gnu11", "-w")
FLAGS = ("-O2", "-funroll-loops", *_COMMON)
# With the ledger or the trajectory, and of a user's model, whose author waits for the compiler after every change:
# compiles faster, runs 5 to 15 % slower (docs/engineering/kernel.md).
QUICK_FLAGS = ("-O1", "-fexpensive-optimizations", "-ftree-pre", "-fgcse", *_COMMON)
# Of a user's model, where a request is small: compiles in 60 % of that time, runs 1.4 times slower.
SMALL_FLAGS = ("-Og", *_COMMON)
RUNTIME = Path(__file__).resolve().parent / "runtime"
_LINE = re.compile(r'#(?<![^\n]#)(?:pragma once\n|include "([^"]+)"\n)')  # a search for "#" is faster than for lines
_ONCE = "#pragma once"
# What only kernels of some models contain is taken out of the others' text and digest.
_OWN_EVENTS, _OWN_TERMS, _KINKS, _STOPPED = (
    re.compile(rf"#if {name}\n.*?^#endif /\* {name} \*/\n", re.MULTILINE | re.DOTALL)
    for name in ("OWN_EVENTS", "OWN_TERMS", "KINKS", r"\(KINKS \|\| !FILM_MOMENTUM\) && !OWN_EVENTS")
)
# Of what a model need not have: 0 where no emitted header defines it.
_OPTIONAL = (
    "FRICTION", "KINKS", "OWN_EVENTS", "OWN_TERMS",
    "ATTRACTION_MARGINS", "ORBITAL_MARGINS", "PENDULUM_MARGINS", "SPIN_DOWN_MARGINS",
)  # fmt: skip
_GUARDS = re.compile(r"^#define (\w+)_kinks\(s\) (.*)$", re.MULTILINE)
_STRUCT, _MEMBER = re.compile(r"typedef struct \{([^}]*)\} series;"), re.compile(r"\b(\w+)_series (\w+);")


@dataclass(frozen=True)
class Variant:
    """Compile-time options of a kernel.

    Arguments:
        order: of the series (`orders.py`).
        rotation: with the angle turned as a quadrature, where it is not a state.
        own_rupture: the bridge ruptures at its law's own distance.
        gradients: with derivatives by the groups, along the trajectory.
        backward: with derivatives of the restitution only, by the adjoint sweep.
        ledger: with the energy ledger; the structure must keep the spin.
        trajectory: every step is recorded.
        limit: a collision may be interrupted at a time.
        small: the request has few collisions, and a user's model: compiled in the least time. Steps are recorded so.
        lanes: collisions side by side, 1, 2, 4 or 8; as many as the processor has room for, with the ledger at most 4.
    """

    choice: ModelKey
    order: int
    rotation: bool = False
    own_rupture: bool = False
    gradients: bool = False
    backward: bool = False
    ledger: bool = False
    trajectory: bool = False
    limit: bool = False
    small: bool = False
    lanes: int = field(default_factory=lanes)

    def __post_init__(self) -> None:
        """Reset options without effect, so that equal kernels are compiled once."""
        if self.ledger:  # mostly of one collision, where wide vectors cost more than they bring
            object.__setattr__(self, "lanes", min(self.lanes, 4))
        object.__setattr__(self, "small", self.choice.package is not None and (self.small or self.trajectory))
        structure = self.choice.structure
        if structure.startswith("head_on") or "strings" in structure:  # nothing turns, or the rotation is a state
            object.__setattr__(self, "rotation", False)

    @property
    def space(self) -> bool:
        return "_space" in self.choice.structure


def source(variant: Variant, emitted: tuple[str, ...]) -> str:
    """C source of a kernel, from its emitted headers."""
    whole = resolved('#include "entry.h"\n', files(variant, emitted))
    whole = whole if has_events(variant.choice) else _OWN_EVENTS.sub("", whole)
    whole = whole if "#define OWN_TERMS 1" in whole else _OWN_TERMS.sub("", whole)
    return whole if "#define KINKS_OF" in whole else _KINKS.sub("", whole)


def files(variant: Variant, emitted: tuple[str, ...]) -> dict[str, str]:
    """Files by name that a variant's runtime includes besides its own, from its emitted headers."""
    slots, own = dict(variant.choice.laws), has_events(variant.choice)
    settings = {
        "LANES": variant.lanes,
        "ORDER": variant.order,
        "TERMS": variant.order + 1,
        "WITH_ROTATION": int(variant.rotation),
        "OWN_RUPTURE": int(variant.own_rupture),
        "GRADIENTS": int(variant.gradients),
        "READS_SERIES": int((variant.gradients and not variant.backward) or own),
        "BACKWARD": int(variant.backward),
        "LIBRARY_LAWS": int(variant.choice.package is None),
        "WITH_LEDGER": int(variant.ledger),
        "WITH_TRAJECTORY": int(variant.trajectory),
        "WITH_LIMIT": int(variant.limit),
        "DRIFTS": int(variant.choice.drifts),  # the angular momentum
        "SHOWN": SHOWN_IN_SPACE if variant.space else SHOWN,
        "RESULTS": 1 if variant.backward else len(MORE_RESULTS) + (SHOWN_IN_SPACE if variant.space else SHOWN),
        "MOST_STEPS": MOST_STEPS,
        "MIDGAP_ARM": int("arm" in slots and not variant.choice.drifts),
    }
    kinks, layout = _kinks(emitted), declarations(variant.ledger, books_own(variant.choice), variant.space)
    settings["READS_SERIES"] |= int(bool(kinks))
    model = "\n".join([*emitted, *kinks])
    absent = [f"#define {name} 0" for name in _OPTIONAL if f"#define {name} " not in model]
    return {
        **({} if own else {"own_events.h": ""}),
        **({} if kinks else {"kinks.h": ""}),
        "settings.h": "\n".join(
            [_ONCE, *(f"#define {name} {value}" for name, value in settings.items()), _binomials(variant.order), ""]
        ),
        "layout.h": f'{_ONCE}\n#include "vector.h"\n{layout}\n',
        **automaton(variant.choice),
        "model.h": "\n".join([_ONCE, '#include "series.h"', '#include "whole_series.h"', *absent, model]),
    }


def _kinks(emitted: tuple[str, ...]) -> list[str]:
    """The guards of a structure's kinks, in the series of its laws: how many, and where."""
    counts = {name: guards.count(",") + 1 for text in emitted for name, guards in _GUARDS.findall(text)}
    members = [member for text in emitted for block in _STRUCT.findall(text) for member in _MEMBER.findall(block)]
    laws = [(name, member) for name, member in members if name in counts]
    if not laws:
        return []
    places = ", ".join(f"{name}_kinks(&(s)->{member})" for name, member in laws)
    return [f"#define KINKS {sum(counts[name] for name, _ in laws)}", f"#define KINKS_OF(s) {places}", ""]


def _binomials(order: int) -> str:
    """Table that takes a polynomial of this order from powers to Bernstein coefficients on [0, 1]."""
    row = ", ".join(f"1.0/{math.comb(order, k)}.0" for k in range(order + 1))
    return f"static const double INVERSE_BINOMIAL[TERMS] = {{{row}}}; /* 1/C(ORDER, k) */"


def emitted_headers(variant: Variant) -> tuple[str, ...] | None:
    """The emitted headers of a variant; None if a law has no recurrence."""
    values = headers(variant.choice)
    if values is None or not variant.gradients:
        return values
    tangent = tangents(variant.choice)
    return None if tangent is None else values + tangent


def flags(variant: Variant, instructions: InstructionSet) -> tuple[str, ...]:
    """The compiler's flags for a variant."""
    quick = variant.ledger or variant.trajectory or variant.choice.package is not None
    level = SMALL_FLAGS if variant.small else QUICK_FLAGS if quick else FLAGS
    return (*instructions.flags, *level, *more_flags())


def stem(variant: Variant) -> str:
    """First part of the names of a variant's libraries."""
    package = variant.choice.package
    model = f"-{package.digest[:8]}" if package is not None else ""
    return f"taylor-{'tangent-' if variant.gradients else ''}{variant.choice.structure}{model}"


def included(text: str) -> list[str]:
    """Files that a C text includes by `#include "..."`, in order."""
    return [name for name in _LINE.findall(text) if name]


def resolved(source: str, texts: Mapping[str, str]) -> str:
    r"""A C text with each included file inserted once, at its first #include, without what only other films need.

    Includes must be unconditional: a file that a variant does not need contains the condition itself.

    Arguments:
        texts: of the files that are not in the runtime's folder, by name.

    Examples:
        >>> resolved('#include "settings.h"\nint order = ORDER;\n', {"settings.h": "#define ORDER 9\n"})
        '#define ORDER 9\nint order = ORDER;\n'
    """
    seen: set[str] = set()

    def put(line: re.Match[str]) -> str:
        name = line[1]
        if name is None or name in seen:
            return ""
        seen.add(name)
        text = texts[name] if name in texts else (RUNTIME / name).read_text()
        return _LINE.sub(put, text)

    whole = _LINE.sub(put, source)
    may_stop = "#define FILM_MOMENTUM 0" in whole or "#define KINKS_OF" in whole
    return whole if may_stop else _STOPPED.sub("", whole)
