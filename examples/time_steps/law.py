"""The exported law's forces for time steps, by ctypes. Runs in any Python with numpy."""

import ctypes
import os
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

_VECTOR = ctypes.c_double * 3
_TWO = _VECTOR * 2


class Motion(ctypes.Structure):
    """NAME_pair_motion."""

    _fields_ = [("position", _VECTOR), ("velocity", _VECTOR), ("spins", _TWO), ("forces", _TWO), ("torques", _TWO)]


class History(ctypes.Structure):
    """NAME_pair_history."""

    _fields_ = [("joined", ctypes.c_int), ("rebound", ctypes.c_int)] + [
        (name, ctypes.c_double) for name in ("gap", "smallest_gap", "speed", "time", "lead", "spare")
    ]


class Force(ctypes.Structure):
    """NAME_pair_force."""

    _fields_ = [("status", ctypes.c_int), ("events", ctypes.c_int), ("outcome", ctypes.c_int), ("force", _VECTOR),
                ("torques", _TWO), ("gap", ctypes.c_double), ("restitution", ctypes.c_double)]  # fmt: skip


def exported(scene: Any, folder: Path) -> Path:
    """The folder, with the law of a Scene; needs `wetdoublet`."""
    (folder / "scene.toml").write_text(scene.to_toml())
    command = [sys.executable, "-m", "wetdoublet", "export", str(folder / "scene.toml"), "--to", "c"]
    subprocess.run([*command, "--out", str(folder)], check=True, stdout=subprocess.DEVNULL)
    return folder


class Law:
    """An exported law, compiled in its folder; its material can be changed."""

    def __init__(self, folder: Path, name: str) -> None:
        self.name = name
        library = folder / "law.so"
        flags = ["-std=c99", "-O2", "-fPIC", "-shared", "-o", str(library), str(folder / f"{self.name}.c"), "-lm"]
        subprocess.run([*shlex.split(os.environ.get("CC", "cc")), *flags], check=True)
        self.library = ctypes.CDLL(str(library))
        header = (folder / f"{self.name}.h").read_text().split("typedef struct {")[1].split("}")[0]
        names = [line.split()[1].rstrip(";") for line in header.splitlines() if line.strip().startswith("double")]
        kind = type("Material", (ctypes.Structure,), {"_fields_": [(member, ctypes.c_double) for member in names]})
        self._call("default_material").restype = kind
        self.material = self._call("default_material")()

    def _call(self, name: str) -> Any:
        return getattr(self.library, f"{self.name}_{name}")

    def force(self, motion: Motion, dt: float, history: History, force: Force) -> None:
        """The force of a pair for a step."""
        rest = ctypes.c_double(dt), ctypes.byref(history), ctypes.byref(force)
        if status := self._call("contact_force")(ctypes.byref(self.material), ctypes.byref(motion), *rest):
            raise RuntimeError(f"status {status}")

    def contact_distance(self) -> float:
        """The distance at which the films touch, m."""
        function = self._call("contact_distance")
        function.restype = ctypes.c_double
        return float(function(ctypes.byref(self.material)))

    def join(self, gap: float, speed: float, history: History) -> None:
        """A contact that is there beforehand."""
        given = ctypes.c_double(gap), ctypes.c_double(speed), ctypes.byref(history)
        if status := self._call("contact_join")(ctypes.byref(self.material), *given):
            raise RuntimeError(f"status {status}")
