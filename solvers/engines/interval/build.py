"""The enclosing engine as a loaded library: emitted headers and the runtime, compiled once into the user's cache."""

import ctypes
import re
import threading
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path

from ...host import emitted
from ...host.compiler import CannotCompile, compiler, key, more_flags
from ...host.compiler import library as compiled
from ...host.thread_caches import once
from ...host.user_cache import fetch, loaded
from ...model.key import ModelKey
from ..machine import own_sets

RUNTIME = Path(__file__).resolve().parent / "runtime"
TERMS = 24  # coefficients of a series
RESULTS = 10
# Products are not fused and operations not moved across a change of the rounding mode; `interval_start` tests it.
FLAGS = ("-O2", "-frounding-math", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-fPIC", "-shared",
         "-std=gnu11", "-w")  # fmt: skip
_LINES = re.compile(r'^#(?:include "[^"]*"|pragma once)\n', re.MULTILINE)
_ERROR = "#error "


class Why(IntEnum):
    """Why a collision was proved or not, in the engine and here."""

    PROVED = 0
    TOO_MANY_STEPS = 1
    STEP_TOO_SMALL = 2
    GRAZE = 3
    ORDER = 4
    START = 5
    TOO_WIDE = 6
    TOO_MANY_REBOUNDS = 7
    CHATTER = 8


class NotProvable(Exception):
    """Why a collision cannot be enclosed here."""


@dataclass(frozen=True)
class Engine:
    """A loaded library and what its calls need."""

    library: ctypes.CDLL
    quantities: tuple[str, ...]
    room: int
    rooms: threading.local = field(default_factory=threading.local)


def source(choice: ModelKey, own_rupture: bool, parameters: int) -> str:
    """The C text of a model's engine.

    Arguments:
        own_rupture: the bridge ruptures at its law's own distance.
        parameters: number of inputs that are followed with derivatives.

    Raises:
        NotProvable: a law or the structure has no enclosure.
    """
    if choice.package is not None:
        raise NotProvable("laws, groups and events of a model file are not enclosed")
    if choice.drifts:
        raise NotProvable("a lever arm that is not at mid-gap is not enclosed")
    slots = [f"{slot}_{name.replace('-', '_')}" for slot, name in choice.laws if slot != "arm"]
    texts = [emitted.header(f"interval/{name}.h") for name in (*(f"laws/{slot}" for slot in slots), choice.structure)]
    for text in texts:
        if text.startswith(_ERROR):
            raise NotProvable(text.removeprefix(_ERROR).strip())
    *laws, structure = texts
    states, constants = structure.split('#include "series.h"\n')
    distance = "bridge_rupture_distance" if own_rupture else "d_mul"
    settings = {
        "PARAMETERS": parameters, "TERMS": TERMS, "RESULTS": RESULTS,
        "OWN_RUPTURE": int(own_rupture), "BRIDGE_RUPTURE_DISTANCE": distance,
    }  # fmt: skip
    runtime = {name: (RUNTIME / f"{name}.h").read_text() for name in _RUNTIME}
    reasons = f"enum reason {{ {', '.join(Why.__members__)} }};\n"
    parts = [*(f"#define {name} {value}\n" for name, value in settings.items()), reasons, states]
    parts += [runtime["interval"], runtime["series"], *laws, constants, *(runtime[name] for name in _RUNTIME[2:])]
    return _LINES.sub("", "".join(parts))


_RUNTIME = ("interval", "series", "set", "barrier", "funnel", "contact", "events", "approach", "step", "entry")


@once
def engine(choice: ModelKey, own_rupture: bool, parameters: int) -> Engine:
    """The loaded engine of a model.

    Raises:
        NotProvable: as `source`, or there is no compiler that rounds as told.
    """
    tool = compiler()
    if tool is None:
        raise NotProvable("proofs need a C compiler")
    text = source(choice, own_rupture, parameters)
    flags = (*own_sets()[0].flags, *FLAGS, *more_flags())
    try:
        name = f"interval-{choice.structure}-{key(text, flags)}.so"
        library = loaded(fetch(name, lambda: compiled(text, flags)), ctypes.CDLL)
    except (CannotCompile, OSError) as error:
        raise NotProvable(f"{tool} cannot compile the enclosing engine ({error})") from None
    if not library.interval_start():
        raise NotProvable(f"{tool} does not keep the direction of rounding, without which nothing is proved")
    library.interval_room.restype = ctypes.c_size_t
    library.interval_prove.argtypes, library.interval_prove.restype = [ctypes.c_void_p] * 5, None
    library.interval_quantities.restype = ctypes.c_char_p
    names = library.interval_quantities().decode().split()
    return Engine(library, tuple(names), library.interval_room())
