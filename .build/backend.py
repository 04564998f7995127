"""The build backend: setuptools, with a C compiler from the registry where the machine has none."""

from __future__ import annotations

import os
import shutil
from typing import Any

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403 # the hooks that a backend has


def get_requires_for_build_wheel(settings: dict[str, Any] | None = None) -> list[str]:
    """What a wheel needs besides: its kernels are compiled."""
    names = [*os.environ.get("CC", "").split()[:1], "cc", "gcc", "clang"]
    kernels = os.environ.get("WETDOUBLET_INSTRUCTION_SETS", "" if os.name == "nt" else None) != ""  # as in setup.py
    needed = kernels and not any(map(shutil.which, names))
    return [*build_meta.get_requires_for_build_wheel(settings), *(["ziglang"] if needed else [])]
