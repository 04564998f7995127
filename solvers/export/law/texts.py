"""The folder of an exported law: its C file and header, and what shows how to use it."""

from __future__ import annotations

import re
from importlib.metadata import version

from ...scene.scene import Scene
from ...settings import RTOL
from ..equations import file_name
from .amalgam import OWN, digests, merged
from .header import default_material, header, message_function
from .items import items
from .kernels import Kernel, kernels
from .material import checks, impact, material, results

ROOTS = ("integrate.h",)
"""Files of a kernel whose functions the law calls, with what they include."""
CALLERS = ("law.h",)
"""Files behind the kernels, which call their functions."""
_LANES = """\
/* Doubles side by side: as many as a vector register holds, or one in plain C. -DLAW_LANES=1 chooses. */
#if defined(LAW_LANES)
#define LANES LAW_LANES
#elif defined(__AVX512DQ__) && defined(__GNUC__)
#define LANES 8
#elif defined(__AVX2__) && defined(__GNUC__)
#define LANES 4
#elif (defined(__SSE2__) || defined(__ARM_NEON)) && defined(__GNUC__)
#define LANES 2
#else
#define LANES 1
#endif
#if defined(__FAST_MATH__)
#error "NaN and infinity are compared here: compile without -ffast-math"
#endif
"""


def texts(scene: Scene, rtol: float = RTOL) -> dict[str, str]:
    """Texts of the files by name."""
    name = file_name(scene)
    own = kernels(scene, rtol)
    return {
        f"{name}.h": _named(name, _head(scene, own) + _header(scene, own)),
        f"{name}.c": _named(name, _law(scene, own)),
    }


def _header(scene: Scene, own: tuple[Kernel, ...]) -> str:
    of_material, of_impact = material(scene, own), impact(scene)
    return header(scene, of_material, of_impact, results((*of_material, *of_impact)))


def _law(scene: Scene, own: tuple[Kernel, ...]) -> str:
    of_material, of_impact = material(scene, own), impact(scene)
    behind = "\n".join(
        [
            default_material(of_material),
            message_function(results((*of_material, *of_impact))),
            checks(scene, of_material, of_impact, own),
            *((OWN / name).read_text().replace("#pragma once\n", "") for name in CALLERS),
        ]
    )
    sources = [kernel.source(ROOTS) for kernel in own]
    text, includes = merged(sources, items("law", behind)[1])
    return "\n".join([_head(scene, own), '#include "law.h"', "", *includes, "", _LANES, text, behind])


def _head(scene: Scene, own: tuple[Kernel, ...]) -> str:
    """The comment at the head of both files: what they are, and what they come from."""
    lines = [f"Collisions of wet particles: the law of the scene `{scene.name or 'scene'}`.", ""]
    lines += [f"Exported by wetdoublet {version('wetdoublet')}. Do not edit: change the scene and export it again."]
    for kernel in own:
        laws = ", ".join(f"{slot} {law}" for slot, law in kernel.choice.laws)
        lines.append(f"Kernel {kernel.prefix}: structure {kernel.choice.structure}; laws: {laws}.")
    lines += [f"Equations sha256 {digest}" for digest in digests(kernel.source(ROOTS) for kernel in own)]
    inside = "\n".join(f" * {line}".rstrip() for line in lines).replace("*/", "* /")
    return f"/*\n{inside}\n */\n"


def _named(name: str, text: str) -> str:
    """The text with the law's own prefix."""
    text = text.replace('"law.h"', f'"{name}.h"')
    text = re.sub(r"\blaw_(?=\w)", f"{name}_", text)
    return re.sub(r"\bLAW_(?=\w)", f"{name.upper()}_", text)
