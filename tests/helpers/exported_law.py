"""An exported law as a library: compiled, and called with numpy arrays."""

import ctypes
import re
import shutil
import subprocess
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene
from wetdoublet.solvers.export.law import texts as law_texts
from wetdoublet.solvers.export.law.texts import law_name, source, texts

from .flags import CALLS

COMPILERS = {"gcc": "g++", "clang": "clang++"}
_SANITIZED = "-fsanitize=address,undefined -fno-sanitize-recover=all -fno-sanitize=null,object-size"
# Compiled in a tenth of the time: checks are calls, and what AddressSanitizer sees anyway is not checked twice.
_CALLS = (
    f"-O1 -fno-inline {CALLS} -fno-expensive-optimizations -fno-tree-pre -fno-gcse "
    "--param=asan-instrumentation-with-call-threshold=0"
)
SANITIZED = {"gcc": f"{_SANITIZED} {_CALLS}".split(), "clang": f"{_SANITIZED} -O0".split()}
FOUND = [name for name, other in COMPILERS.items() if shutil.which(name) and shutil.which(other)]


def written(scene: Scene, folder: Path) -> Path:
    """The folder, with the files of the scene's law."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts(scene).items():
        (folder / name).write_text(text)
    return folder


def law_alone(scene: Scene, folder: Path) -> Path:
    """The folder, with C file and header: there are no test vectors, for which kernels would be compiled."""
    folder.mkdir(parents=True, exist_ok=True)
    name, law = law_name(scene), source(scene)
    for suffix, text in ((".h", law.header), (".c", law.c)):
        (folder / f"{name}{suffix}").write_text(law_texts._named(name, text))
    return folder


class Law:
    """The law in a folder, compiled as a library."""

    def __init__(self, scene: Scene, folder: Path, *flags: str, compiler: str = "gcc") -> None:
        self.name = law_name(scene)
        self._folder = folder
        self.library = folder / f"{self.name}-{len(list(folder.glob('*.so')))}.so"
        source = str(folder / f"{self.name}.c")
        command = [compiler, "-std=c99", "-O1", "-fno-math-errno", *flags, "-fPIC", "-shared"]
        subprocess.run([*command, "-o", str(self.library), source, "-lm"], check=True)
        self._library = ctypes.CDLL(str(self.library))

    def function(self, name: str) -> Any:
        """NAME_name, of ctypes."""
        return getattr(self._library, f"{self.name}_{name}")

    @cached_property
    def header(self) -> str:
        """The text of its header."""
        return (self._folder / f"{self.name}.h").read_text()

    def dtype(self, structure: str) -> np.dtype:
        """The type of a structure ("material", "impact", "contact", "pair" ...), read from the header."""
        body = re.search(rf"typedef struct \{{([^}}]*)\}} {self.name}_{structure};", self.header)
        assert body is not None
        fields = re.findall(rf"^ *(int|double|{self.name}_\w+) (\w+)((?:\[\d+\])*);", body[1], re.MULTILINE)
        kinds = {"int": np.dtype("i4"), "double": np.dtype("f8")}
        found = [
            (
                name,
                kinds.get(kind) or self.dtype(kind.removeprefix(f"{self.name}_")),
                tuple(map(int, re.findall(r"\d+", shape))),
            )
            for kind, name, shape in fields
        ]
        return np.dtype(found, align=True)

    def number(self, enumerator: str) -> int:
        """The value of NAME_ENUMERATOR."""
        found = re.search(rf"\b{self.name.upper()}_{enumerator} = (-?\d+)", self.header)
        assert found is not None, enumerator
        return int(found[1])

    def material(self) -> np.ndarray:
        """The scene's numbers, as a row of its type."""
        kind = self.dtype("material")
        structure = type(
            "Material", (ctypes.Structure,), {"_fields_": [(name, ctypes.c_double) for name in kind.names]}
        )
        function = self.function("default_material")
        function.restype = structure
        return np.frombuffer(bytearray(function()), kind).copy()

    def message(self, status: int) -> str:
        """A status in words."""
        function = self.function("message")
        function.restype = ctypes.c_char_p
        found: bytes = function(status)
        return found.decode()

    def impacts(self, **columns: np.ndarray | float) -> np.ndarray:
        """Rows of impacts from columns; zero where nothing is given."""
        size = max(np.size(column) for column in columns.values())
        rows = np.zeros(size, self.dtype("impact"))
        for name, column in columns.items():
            rows[name] = column
        return rows

    def _many(self, name: str, rows: np.ndarray, structure: str, rtol: float, material: Any, budget: int) -> np.ndarray:
        """The results of rows, by one call for all."""
        found = np.zeros(rows.size, self.dtype(structure))
        material = self.material() if material is None else material
        function = self.function(name)
        function.restype = ctypes.c_long
        given = (ctypes.c_void_p(each.ctypes.data) for each in (material, rows))
        settings = ctypes.c_long(rows.size), ctypes.c_double(rtol), ctypes.c_int(budget)
        assert function(*given, *settings, ctypes.c_void_p(found.ctypes.data)) == np.count_nonzero(found["status"])
        return found

    def collide(self, impacts: np.ndarray, rtol: float = 1e-9, material: Any = None, budget: int = 0) -> np.ndarray:
        """The results of impacts."""
        return self._many("collide_many", impacts, "collision", rtol, material, budget)

    def collide_pairs(self, pairs: np.ndarray, rtol: float = 1e-9, material: Any = None, budget: int = 0) -> np.ndarray:
        """The results of pairs in space."""
        return self._many("collide_pair_many", pairs, "pair_after", rtol, material, budget)

    def one(self, impact: np.ndarray, rtol: float = 1e-9, material: np.ndarray | None = None) -> np.ndarray:
        """The result of a single impact, by the call for one."""
        found = np.zeros(1, self.dtype("collision"))
        material = self.material() if material is None else material
        function = self.function("collide")
        pointers = (ctypes.c_void_p(each.ctypes.data) for each in (material, np.ascontiguousarray(impact)))
        status = function(*pointers, ctypes.c_double(rtol), ctypes.c_int(0), ctypes.c_void_p(found.ctypes.data))
        assert status == found["status"][0]
        return found

    def begin(
        self, impact: np.ndarray, rtol: float = 1e-9, budget: int = 0, material: np.ndarray | None = None
    ) -> np.ndarray:
        """A contact at its beginning, as a row of its type."""
        contact = np.zeros(1, self.dtype("contact"))
        material = self.material() if material is None else material
        function = self.function("begin")
        pointers = (ctypes.c_void_p(each.ctypes.data) for each in (material, np.ascontiguousarray(impact)))
        settings = ctypes.c_double(rtol), ctypes.c_int(budget)
        assert function(*pointers, *settings, ctypes.c_void_p(contact.ctypes.data)) == contact["status"][0]
        return contact

    def advance(self, contact: np.ndarray, time: float) -> int:
        """Advance a contact to a time; its status."""
        function = self.function("advance")
        status: int = function(ctypes.c_void_p(contact.ctypes.data), ctypes.c_double(time))
        return status

    def pairs(self, normal: object, velocities: np.ndarray, spins: np.ndarray) -> np.ndarray:
        """Rows of pairs; beside a wall one velocity and one spin suffice."""
        rows = np.zeros(len(velocities), self.dtype("pair"))
        rows["normal"] = normal
        for name, given in (("velocities", velocities), ("spins", spins)):
            rows[name][:, : np.shape(given)[1]] = given
        return rows

    def collide_particles(
        self, particles: np.ndarray, tolerance: float = 1e-9, rtol: float = 1e-9, material: np.ndarray | None = None
    ) -> np.ndarray:
        """The result of two particles (rows of their type), which are moved in place."""
        found = np.zeros(1, self.dtype("pair_after"))
        material = self.material() if material is None else material
        first, second = (ctypes.c_void_p(particles[k : k + 1].ctypes.data) for k in range(2))
        function = self.function("collide_particles")
        rest = ctypes.c_double(tolerance), ctypes.c_double(rtol), ctypes.c_int(0), ctypes.c_void_p(found.ctypes.data)
        assert function(ctypes.c_void_p(material.ctypes.data), first, second, *rest) == found["status"][0]
        return found

    def contact_distance(self) -> float:
        """The distance at which a collision begins, m."""
        function, material = self.function("contact_distance"), self.material()
        function.restype = ctypes.c_double
        return float(function(ctypes.c_void_p(material.ctypes.data)))

    def contact_force(
        self, material: np.ndarray, motion: np.ndarray, dt: float, history: np.ndarray, force: np.ndarray
    ) -> int:
        """The force of a pair for a step, into rows of their types; its status."""
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in (material, motion, history, force)]
        function = getattr(self._library, f"{self.name}_contact_force")
        status: int = function(*pointers[:2], ctypes.c_double(dt), *pointers[2:])
        assert status == force["status"][0]
        return status

    def contact_join(self, material: np.ndarray, gap: float, speed: float, history: np.ndarray) -> int:
        """Put a contact in place; the status."""
        function, numbers = getattr(self._library, f"{self.name}_contact_join"), (gap, speed)
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in (material, history)]
        status: int = function(pointers[0], *map(ctypes.c_double, numbers), pointers[1])
        return status
