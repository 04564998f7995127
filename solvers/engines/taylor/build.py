"""The kernel as a loaded library: source from emitted headers and the runtime, compiled once into the user's cache."""

import ctypes
import math
import platform
import re
import threading
import time
from collections.abc import Callable, Collection
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cache

from ...host.compiler import CannotCompile, compiler, key, more_flags, stop
from ...host.compiler import library as compiled
from ...host.cores import usable_cores
from ...host.remarks import say_after, say_once
from ...host.thread_caches import once
from ...host.user_cache import found, has, kept, loaded
from ...model.model import ModelKey, select_model
from ...scene.scene import Scene
from .headers import automaton, has_events, headers, tangents
from .includes import resolved
from .layout import MORE_RESULTS, MOST_STEPS, SHOWN, SHOWN_IN_SPACE, declarations
from .machine import described, lanes, native

# No -ffast-math: NaN and infinity are compared. Products may be fused with sums; sqrt does not set errno.
# -w: the tests compile every file with -Wall -Wextra -Werror; warnings of a newer compiler should not reach users.
FLAGS = (
    "-O2",
    "-funroll-loops",
    native(platform.machine()),
    "-fno-math-errno",
    "-ffp-contract=fast",
    "-fPIC",
    "-shared",
    "-std=gnu11",
    "-w",
)
# With the ledger or the trajectory: compiles faster, runs about 5 % slower (docs/engineering/kernel.md).
RECORD_FLAGS = ("-O1", "-fexpensive-optimizations", "-ftree-pre", "-fgcse", *FLAGS[2:])
_PATIENCE = 1.0  # s of compilation without a remark
_ONCE = "#pragma once"
# What only kernels of models with declared events contain is taken out of the others' text, and so out of their digest.
_OWN_EVENTS = re.compile(r"^#if OWN_EVENTS\n.*?^#endif /\* OWN_EVENTS \*/\n", re.MULTILINE | re.DOTALL)


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
        lanes: collisions side by side, 1, 2, 4 or 8; as many as the processor has room for.
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
    lanes: int = field(default_factory=lanes)

    def __post_init__(self) -> None:
        """Reset options without effect, so that equal kernels are compiled once."""
        structure = self.choice.structure
        if structure.startswith("head_on") or "strings" in structure:  # nothing turns, or the rotation is a state
            object.__setattr__(self, "rotation", False)

    @property
    def space(self) -> bool:
        """True if the states are vectors in space."""
        return "_space" in self.choice.structure


def supported(scene: Scene) -> bool:
    """True if the kernel can integrate a scene here: its laws have recurrences, and there is a compiler."""
    return compiler() is not None and all(headers(select_model(scene, oblique, fold=True)) for oblique in (True, False))


def source(variant: Variant, emitted: tuple[str, ...]) -> str:
    """C source of a kernel, from its emitted headers."""
    whole = resolved('#include "entry.h"\n', files(variant, emitted))
    return whole if has_events(variant.choice) else _OWN_EVENTS.sub("", whole)


def files(variant: Variant, emitted: tuple[str, ...]) -> dict[str, str]:
    """Files of a variant that the runtime includes besides its own, by name.

    Arguments:
        emitted: its emitted headers.
    """
    slots = dict(variant.choice.laws)
    settings = {
        "LANES": variant.lanes,
        "ORDER": variant.order,
        "TERMS": variant.order + 1,
        "WITH_ROTATION": int(variant.rotation),
        "OWN_RUPTURE": int(variant.own_rupture),
        "GRADIENTS": int(variant.gradients),
        "BACKWARD": int(variant.backward),
        "LIBRARY_LAWS": int(variant.choice.package is None),
        "WITH_LEDGER": int(variant.ledger),
        "WITH_TRAJECTORY": int(variant.trajectory),
        "WITH_LIMIT": int(variant.limit),
        "SURFACE_ARM": int(slots.get("arm") == "surface"),
        "SHOWN": SHOWN_IN_SPACE if variant.space else SHOWN,
        "RESULTS": 1 if variant.backward else MORE_RESULTS + (SHOWN_IN_SPACE if variant.space else SHOWN),
        "MOST_STEPS": MOST_STEPS,
        "MIDGAP_ARM": int(slots.get("arm") == "midgap"),
    }
    declared = has_events(variant.choice)
    return {
        **({} if declared else {"own_events.h": ""}),
        "settings.h": "\n".join(
            [_ONCE, *(f"#define {name} {value}" for name, value in settings.items()), _binomials(variant.order), ""]
        ),
        "layout.h": f'{_ONCE}\n#include "vector.h"\n{declarations(variant.ledger, declared, variant.space)}\n',
        **automaton(variant.choice),
        "model.h": "\n".join([_ONCE, '#include "series.h"', '#include "whole_series.h"', *emitted]),
    }


def _binomials(order: int) -> str:
    """Table that takes a polynomial of this order from powers to Bernstein coefficients on [0, 1]."""
    row = ", ".join(f"1.0/{math.comb(order, k)}.0" for k in range(order + 1))
    return f"static const double INVERSE_BINOMIAL[TERMS] = {{{row}}}; /* 1/C(ORDER, k) */"


def _emitted(variant: Variant) -> tuple[str, ...] | None:
    """The emitted headers of a variant; None if a law has no recurrence."""
    plain = headers(variant.choice)
    if plain is None or not variant.gradients:
        return plain
    tangent = tangents(variant.choice)
    return None if tangent is None else plain + tangent


def _flags(variant: Variant) -> tuple[str, ...]:
    flags = RECORD_FLAGS if variant.ledger or variant.trajectory else FLAGS
    return flags + more_flags()


def _stem(variant: Variant) -> str:
    package = variant.choice.package
    suffix = f"-{package.digest[:8]}" if package is not None else ""
    return f"taylor-{'tangent-' if variant.gradients else ''}{variant.choice.structure}{suffix}"


def _entry(variant: Variant, text: str, flags: tuple[str, ...]) -> str:
    """File name of the library compiled from a source."""
    return f"{_stem(variant)}-{key(text, flags, described())}.so"


def is_compiled(variant: Variant) -> bool:
    """True if the library of a variant is in the cache; nothing is derived or compiled for the answer."""
    if not has(f"{_stem(variant)}-"):
        return False  # its headers may not have been derived yet
    entry = _expected(variant, _flags(variant))
    return entry is not None and has(entry.removesuffix("so"))


@cache
def _expected(variant: Variant, flags: tuple[str, ...]) -> str | None:
    emitted = _emitted(variant)
    return None if compiler() is None or emitted is None else _entry(variant, source(variant, emitted), flags)


@once
def kernel(variant: Variant) -> ctypes.CDLL | None:
    """The loaded kernel of a variant; None for an unsupported model, without a compiler, or if compilation fails."""
    tool = compiler()
    with say_after(_PATIENCE, "a kernel for this kind of scene is compiled, once; this takes some seconds"):
        emitted = None if tool is None else _emitted(variant)
        if emitted is None:
            return None
        text, flags = source(variant, emitted), _flags(variant)
        try:
            library = loaded(kept(_entry(variant, text, flags), lambda: compiled(text, flags)), ctypes.CDLL)
        except (CannotCompile, OSError) as error:
            say_once(f"{tool} cannot compile the Taylor kernel ({error}): other engines answer")
            return None
    library.collide.restype = ctypes.c_char_p
    library.collide.argtypes = [ctypes.c_void_p]
    return library


def compile_all(
    variants: Collection[Variant], progress: Callable[[int, int], None] | None = None
) -> dict[Variant, float | None]:
    """Compile the kernels of several variants in parallel, where they are not cached.

    Arguments:
        progress: called with the numbers of finished and of all kernels.

    Returns:
        The seconds that each took; None for one that cannot be compiled.
    """
    threads: list[int] = []

    def compiled_here(variant: Variant) -> float | None:
        threads.append(threading.get_ident())
        start = time.perf_counter()
        built = kernel(variant) is not None
        return time.perf_counter() - start if built else None

    took: dict[Variant, float | None] = {}
    with ThreadPoolExecutor(usable_cores()) as pool:  # threads suffice, since compilers are separate processes
        try:
            for variant, seconds in zip(variants, pool.map(compiled_here, variants), strict=True):
                took[variant] = seconds
                if progress is not None:
                    progress(len(took), len(variants))
        except BaseException:
            stop(threads)
            raise
    return took


def size_of(variant: Variant) -> int:
    """Size in bytes of the compiled library of a variant; 0 if it is not in the cache."""
    entry = _expected(variant, _flags(variant))
    return len(found(entry) or b"") if entry is not None else 0
