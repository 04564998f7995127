"""A kernel as a loaded library: source put together from emitted headers, compiled once into the user's cache."""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .. import emitted
from ..compiled import cache_folder, compiler
from ..model import Choice, choose

if TYPE_CHECKING:
    from ..scene import Scene

# No -ffast-math: NaN and infinity are compared with. Products may be fused with sums; sqrt sets no errno.
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
_RUNTIME = Path(__file__).resolve().parent / "runtime"
LARGEST_ORDER = 16
_NEEDED = {8: "avx512dq", 4: "avx2", 2: "sse2"}

ANSWER = np.dtype(
    [
        ("shown", "f8", 4),
        ("time", "f8"),
        ("smallest_gap", "f8"),
        ("turned", "f8"),
        ("final_gap", "f8"),
        ("outcome", "i4"),
        ("certified", "i4"),
        ("status", "i4"),
        ("steps", "i4"),
        ("reversal", "i4"),
        ("events", "i4"),
    ]
)
HAPPENING = np.dtype([("kind", "f8"), ("time", "f8")])
MOST_EVENTS = 64


@dataclass(frozen=True)
class Variant:
    """What a kernel is compiled for.

    Arguments:
        order: of the series, 8 to LARGEST_ORDER.
        rotation: the angle turned is integrated along where it is no state.
        certificate: sticks are proved; without, flights are given up after a time (for what a proof is worth).
    """

    choice: Choice
    order: int
    rotation: bool = False
    certificate: bool = True


@cache
def lanes() -> int:
    """Doubles side by side that this machine's registers hold."""
    flags = _processor()
    return next((count for count, flag in _NEEDED.items() if flag in flags), 1)


@cache
def _processor() -> frozenset[str]:
    """What the processor can do, as the system says it; a machine that is not asked about has SSE2 or its like."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    for line in lines:
        name, _, value = line.partition(":")
        if name.strip() in ("flags", "Features"):
            return frozenset(value.split())
    return frozenset({"sse2"})


def headers(choice: Choice) -> tuple[str, ...] | None:
    """The emitted headers of a choice, laws first; None if it has what the kernel does not know."""
    paths = [f"taylor/laws/{slot}_{law.replace('-', '_')}.h" for slot, law in choice.laws]
    paths.append(f"taylor/{choice.structure}.h")
    return tuple(paths) if choice.package is None and all(map(emitted.committed, paths)) else None


def knows(scene: Scene) -> bool:
    """Whether the kernel can collide a scene here: its laws are emitted for it, and there is a compiler."""
    common = scene.bridge is None or scene.bridge.rupture == "common"  # the one in its groups
    return common and compiler() is not None and all(headers(choose(scene, oblique)) for oblique in (True, False))


def source(variant: Variant, paths: tuple[str, ...]) -> str:
    """C source of a kernel."""
    choice = variant.choice
    slots = dict(choice.laws)
    by_energy = "bridge" in slots or ("strings" in slots and "shear" not in slots)
    unproved = "shear" in slots and ("strings" in slots or "bridge" not in slots)
    settings = {
        "LANES": lanes(),
        "ORDER": variant.order,
        "TERMS": variant.order + 1,
        "WITH_ROTATION": int(variant.rotation),
        "CERTIFICATE": int(variant.certificate),
        "PROOF_BY_ENERGY": int(by_energy and not unproved),
        "SURFACE_ARM": int(slots.get("arm") == "surface"),
        "MIDGAP_ARM": int(slots.get("arm") == "midgap"),
    }
    parts = [f"#define {name} {value}" for name, value in settings.items()]
    parts += [(_RUNTIME / name).read_text() for name in ("vector.h", "series.h")]
    parts += [emitted.header(path) for path in paths]
    parts += [
        (_RUNTIME / name).read_text()
        for name in ("roots.h", "barrier.h", "queue.h", "rules.h", "events.h", "damped.h", "crawl.h", "lanes.h")
    ]
    return "\n".join(parts)


@cache
def kernel(variant: Variant) -> ctypes.CDLL | None:
    """The loaded kernel of a variant; None for a model it does not know, without a compiler, or where that fails."""
    found, paths = compiler(), headers(variant.choice)
    if found is None or paths is None:
        return None
    path, version = found
    text = source(variant, paths)
    machine = f"{platform.machine()} {' '.join(sorted(_processor()))}"
    content = "\0".join([text, version, " ".join(FLAGS), machine])
    key = hashlib.sha256(content.encode()).hexdigest()[:32]
    library = cache_folder() / f"taylor-{variant.choice.structure}-{key}.so"
    if not library.is_file() and not _built(path, text, library):
        return None
    loaded = ctypes.CDLL(str(library))
    loaded.collide.restype = ctypes.c_int
    pointer, number = ctypes.c_void_p, ctypes.c_int
    loaded.collide.argtypes = [ctypes.c_long, pointer, pointer, ctypes.c_double, number, pointer, pointer]
    return loaded


def _built(path: str, text: str, library: Path) -> bool:
    """Compile; built under a name of its own and then moved into place, so that several processes may do so at once."""
    with tempfile.TemporaryDirectory(prefix="wetdoublet-") as work:
        written, fresh = Path(work) / "kernel.c", Path(work) / "kernel.so"
        written.write_text(text)
        command = [path, *FLAGS, "-o", str(fresh), str(written), "-lm"]
        built = subprocess.run(command, capture_output=True, text=True, check=False)
        if built.returncode:
            last = (built.stderr.strip().splitlines() or ["no message"])[-1]
            sys.stderr.write(f"{path} cannot compile the Taylor kernel ({last}): other engines answer\n")
            return False
        beside = library.with_suffix(f".{os.getpid()}")
        shutil.copyfile(fresh, beside)
        beside.replace(library)
    return True
