"""The kernel as a loaded library: source from emitted headers and the runtime, compiled once into the user's cache."""

from __future__ import annotations

import ctypes
import platform
import threading
from collections.abc import Collection
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from ...host.compiler import CannotCompile, compiler, key, more_flags, stop
from ...host.compiler import library as compiled
from ...host.cores import usable_cores
from ...host.remarks import say_once
from ...host.thread_caches import once
from ...host.user_cache import has, kept, loaded
from ...model.model import ModelKey, select_model
from .headers import automaton, headers, tangents
from .includes import resolved
from .layout import MOST_STEPS, RESULTS, declarations

if TYPE_CHECKING:
    from ...scene.scene import Scene

# No -ffast-math: NaN and infinity are compared. Products may be fused with sums; sqrt does not set errno.
# -w: the tests compile every file with -Wall -Wextra -Werror; warnings of a newer compiler should not reach users.
FLAGS = (
    "-O2",
    "-funroll-loops",
    "-march=native",
    "-fno-math-errno",
    "-ffp-contract=fast",
    "-fPIC",
    "-shared",
    "-std=gnu11",
    "-w",
)
# For a few collisions: half the compile time, the same arithmetic, about 5 % slower (docs/engineering/kernel.md).
FEW_FLAGS = ("-O1", "-fexpensive-optimizations", "-ftree-pre", "-fgcse", *FLAGS[2:])
LARGEST_ORDER = 16
_ONCE = "#pragma once"
_NEEDED = {8: "avx512dq", 4: "avx2", 2: "sse2"}


@dataclass(frozen=True)
class Variant:
    """Compile-time options of a kernel.

    Arguments:
        order: of the series, 8 to LARGEST_ORDER.
        rotation: with the angle turned as a quadrature, where it is not a state.
        own_rupture: the bridge ruptures at its law's own distance.
        gradients: with derivatives by the groups, along the trajectory.
        backward: with derivatives of the restitution only, by the adjoint sweep.
        few: for few collisions: compiled faster.
        ledger: with the energy ledger; the structure must keep the spin.
        trajectory: every step is recorded.
    """

    choice: ModelKey
    order: int
    rotation: bool = False
    own_rupture: bool = False
    gradients: bool = False
    backward: bool = False
    few: bool = False
    ledger: bool = False
    trajectory: bool = False

    def __post_init__(self) -> None:
        """Reset options without effect, so that equal kernels are compiled once."""
        structure = self.choice.structure
        if structure.startswith("head_on") or "strings" in structure:  # nothing turns, or the rotation is a state
            object.__setattr__(self, "rotation", False)


@cache
def lanes() -> int:
    """Number of doubles in a vector register of this machine."""
    flags = _processor()
    return next((count for count, flag in _NEEDED.items() if flag in flags), 1)


@cache
def _processor() -> frozenset[str]:
    """Processor features, as the operating system reports them; on other systems the baseline is assumed."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    for line in lines:
        name, _, value = line.partition(":")
        if name.strip() in ("flags", "Features"):
            return frozenset(value.split())
    return frozenset({"sse2"})


def machine() -> str:
    """The processor that a kernel is compiled for, as text."""
    return f"{platform.machine()} {' '.join(sorted(_processor()))}"


def supported(scene: Scene) -> bool:
    """True if the kernel can integrate a scene here: its laws have recurrences, and there is a compiler."""
    return compiler() is not None and all(headers(select_model(scene, oblique, fold=True)) for oblique in (True, False))


def source(variant: Variant, emitted: tuple[str, ...]) -> str:
    """C source of a kernel, from its emitted headers."""
    return resolved('#include "entry.h"\n', files(variant, emitted, lanes()))


def files(variant: Variant, emitted: tuple[str, ...], lanes: int) -> dict[str, str]:
    """Files of a variant that the runtime includes besides its own, by name.

    Arguments:
        emitted: its emitted headers.
        lanes: doubles side by side.
    """
    slots = dict(variant.choice.laws)
    settings = {
        "LANES": lanes,
        "ORDER": variant.order,
        "TERMS": variant.order + 1,
        "WITH_ROTATION": int(variant.rotation),
        "OWN_RUPTURE": int(variant.own_rupture),
        "GRADIENTS": int(variant.gradients),
        "BACKWARD": int(variant.backward),
        "LIBRARY_LAWS": int(variant.choice.package is None),
        "WITH_LEDGER": int(variant.ledger),
        "WITH_TRAJECTORY": int(variant.trajectory),
        "SURFACE_ARM": int(slots.get("arm") == "surface"),
        "RESULTS": 1 if variant.backward else RESULTS,
        "MOST_STEPS": MOST_STEPS,
        "MIDGAP_ARM": int(slots.get("arm") == "midgap"),
    }
    rules, criteria, effects = automaton()
    return {
        "settings.h": "\n".join([_ONCE, *(f"#define {name} {value}" for name, value in settings.items()), ""]),
        "layout.h": f"{_ONCE}\n{declarations(variant.ledger)}\n",
        "automaton.h": f"{_ONCE}\n{rules}",
        "criteria.h": f'{_ONCE}\n#include "automaton.h"\n#include "model.h"\n{criteria}',
        "effects.h": f'{_ONCE}\n#include "transitions.h"\n{effects}',
        "model.h": "\n".join([_ONCE, '#include "series.h"', '#include "whole_series.h"', *emitted]),
    }


def _emitted(variant: Variant) -> tuple[str, ...] | None:
    """The emitted headers of a variant; None if a law has no recurrence."""
    plain = headers(variant.choice)
    if plain is None or not variant.gradients:
        return plain
    tangent = tangents(variant.choice)
    return None if tangent is None else plain + tangent


def _flags(variant: Variant) -> tuple[str, ...]:
    own = FEW_FLAGS if variant.few or variant.ledger or variant.trajectory else FLAGS
    return own + more_flags()


def _stem(variant: Variant) -> str:
    package = variant.choice.package
    own = f"-{package.digest[:8]}" if package is not None else ""
    return f"taylor-{'tangent-' if variant.gradients else ''}{variant.choice.structure}{own}"


def _entry(variant: Variant, text: str, flags: tuple[str, ...]) -> str:
    """File name of the library compiled from a source."""
    return f"{_stem(variant)}-{key(text, flags, machine())}.so"


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
    found, emitted = compiler(), _emitted(variant)
    if found is None or emitted is None:
        return None
    text, flags = source(variant, emitted), _flags(variant)
    try:
        library = loaded(kept(_entry(variant, text, flags), lambda: compiled(text, flags)), ctypes.CDLL)
    except (CannotCompile, OSError) as error:
        say_once(f"{found} cannot compile the Taylor kernel ({error}): other engines answer")
        return None
    library.collide.restype = ctypes.c_char_p
    library.collide.argtypes = [ctypes.c_void_p]
    return library


def compile_all(variants: Collection[Variant]) -> None:
    """Compile the kernels of several variants in parallel, where they are not cached."""
    if len(variants) > 1:
        threads: list[int] = []

        def compiled_here(variant: Variant) -> None:
            threads.append(threading.get_ident())
            kernel(variant)

        with ThreadPoolExecutor(usable_cores()) as pool:  # threads suffice, since compilers are separate processes
            try:
                list(pool.map(compiled_here, variants))
            except BaseException:
                stop(threads)
                raise
