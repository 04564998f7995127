"""The exported law of a scene, compiled here and loaded: what numba and cffi call."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ComputationError
from ..export.law.interface import structures
from ..export.law.texts import source
from ..host.compiler import CannotCompile, compiler, key, library, more_flags
from ..host.user_cache import kept, loaded
from ..scene.scene import Scene

_FLAGS = ("-O2", "-march=native", "-fno-math-errno", "-ffp-contract=fast", "-fPIC", "-shared", "-std=c99", "-w")
_KINDS = {"int": "i4", "double": "f8"}


@dataclass(frozen=True)
class CompiledLaw:
    """A scene's law as a shared library; the prefix of its functions and structures is `law_` for every scene.

    Attributes:
        header: text of its header.
        content: the library.
    """

    header: str
    content: bytes

    def opened(self, by: Callable[[str], Any]) -> Any:
        """What `by` makes of a path of the library, which is valid during this call."""
        return loaded(self.content, by)

    @property
    def declarations(self) -> str:
        """The header without comments and preprocessing."""
        text = re.sub(r"/\*.*?\*/", "", self.header, flags=re.DOTALL)
        text = re.sub(r"^#ifdef __cplusplus\n.*?^#endif$", "", text, flags=re.DOTALL | re.MULTILINE)
        return re.sub(r"\n\s*\n+", "\n", re.sub(r"^#.*$", "", text, flags=re.MULTILINE))

    def dtype(self, structure: str) -> np.dtype[Any]:
        """The numpy type of a structure: "material", "impact", "collision", "pair", "pair_after", "particle"."""
        fields = structures(self.header)[f"law_{structure}"]
        return np.dtype([(member, _KINDS[kind], shape) for kind, member, shape in fields], align=True)


def compiled_law(scene: Scene | str | Path) -> CompiledLaw:
    """The law of a scene, compiled by this machine's C compiler for this processor, and kept.

    Raises:
        InputError: a law of the scene has no recurrence.
        ComputationError: there is no C compiler, or it fails.
    """
    law = source(Scene.load(scene))
    text = law.c.replace('#include "law.h"', law.header)
    if compiler() is None:
        raise ComputationError("the law cannot be compiled: there is no C compiler", advice="install gcc or clang")
    flags = (*_FLAGS, *more_flags())
    try:
        content = kept(f"law-{key(text, flags)}.so", lambda: library(text, flags))
    except CannotCompile as error:
        raise ComputationError(f"the law cannot be compiled: {error}") from None
    return CompiledLaw(law.header, content)
