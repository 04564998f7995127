"""What crosses between Python and the kernel, declared once: as numpy types, and as the C structures they are.

The kernel's source begins with `declarations()`, which the C compiler holds to the sizes that numpy has. Every buffer
goes over with its size in bytes; how many rows it holds is for the kernel to find, and it writes no others.
"""

from __future__ import annotations

import ctypes

import numpy as np

BUFFER = np.dtype([("at", np.uintp), ("bytes", "i8")], align=True)
ANSWER = np.dtype(
    [
        # restitution, tangential restitution, rotation rate, spin, partner's spin; handed over: states after the gap
        ("shown", "f8", 5),
        ("time", "f8"),
        ("smallest_gap", "f8"),
        ("turned", "f8"),
        ("final_gap", "f8"),
        ("outcome", "i4"),
        ("certified", "i4"),
        ("status", "i4"),
        ("steps", "i4"),
        ("reversal", "i4"),  # the first rebound criterion met; -1 for none
        ("events", "i4"),  # those that the log had no room for as well
    ],
    align=True,
)
HAPPENING = np.dtype([("kind", "f8"), ("time", "f8")], align=True)
LEDGER = np.dtype(
    [
        (name, "f8")
        for name in (
            "initial",
            "final",
            "lifted",
            "normal",
            "tangential",
            "capillary",
            "attraction",
            "dry",
            "momentum",  # angular momentum over its start value
        )
    ],
    align=True,
)
NEARNESS = np.dtype([("least", "f8"), ("boundary", "f8"), ("hint", "f8")], align=True)
# What a kernel is asked: numbers, then buffers; those that are not asked for are empty.
TASK = np.dtype(
    [
        ("count", "i8"),
        ("budget", "i8"),  # steps of a trajectory
        ("purpose", "i8"),  # kernels with a trajectory heed it
        ("asked", "i8"),  # groups whose derivatives are carried, as bits
        ("steps", "i8"),  # comes back: of all trajectories, those that found no row as well
        ("rtol", "f8"),
        ("quantities", BUFFER),  # a BUFFER for each of `quantity_names`: `count` doubles in SI, or one for all
        ("answers", BUFFER),  # of ANSWER
        ("log", BUFFER),  # of HAPPENING, equally many for each collision
        ("books", BUFFER),  # of LEDGER
        ("rows", BUFFER),  # of step_row, as many as there are
        ("peaks", BUFFER),  # a double a collision: the largest margin of the glass criterion while closing
        ("by_group", BUFFER),  # RESULTS doubles for each of `group_names`, of each collision
        ("gradients", BUFFER),  # RESULTS doubles for each of `quantity_names`, of each collision
        ("near", BUFFER),  # of NEARNESS
    ],
    align=True,
)
RESULTS = 8  # that are differentiated: those shown, then time, smallest gap, angle turned
MOST_STEPS = 300  # of a trajectory whose derivatives are taken back
_STRUCTURES = {"buffer": BUFFER, "answer": ANSWER, "happening": HAPPENING, "ledger": LEDGER, "nearness": NEARNESS}
_C_TYPES = {"f8": "double", "i8": "int64_t", "i4": "int32_t"}


def declarations(ledger: bool) -> str:
    """C structures of these types, and proofs that a C compiler lays them out as numpy does."""
    lines = ["#include <stddef.h>", "#include <stdint.h>"]
    for name, layout in (*_STRUCTURES.items(), ("task", TASK)):
        if name == "ledger" and not ledger:
            continue
        lines.append("typedef struct {")
        lines += [f"    {_member(field, kind)};" for field, (kind, *_) in (layout.fields or {}).items()]
        lines.append(f"}} {name};")
        lines += [
            f'_Static_assert(offsetof({name}, {field}) == {where}, "{name}");'
            for field, (_, where, *_) in (layout.fields or {}).items()
        ]
        lines.append(f'_Static_assert(sizeof({name}) == {layout.itemsize}, "{name}");')
    return "\n".join(lines)


def _member(name: str, kind: np.dtype) -> str:
    base, shape = kind.subdtype or (kind, ())
    structure = next((key for key, value in _STRUCTURES.items() if value == base), None)
    if name == "at":
        return "void *at"
    return f"{structure or _C_TYPES[base.str[1:]]} {name}{''.join(f'[{size}]' for size in shape)}"


def step_row(library: ctypes.CDLL) -> np.dtype:
    """A step of a trajectory as this kernel writes it, by its own account of the states and terms that it has."""
    states, terms, size = (number(library, name) for name in ("row_states", "row_terms", "row_bytes"))
    flags = [(name, "i4") for name in ("phase", "closing", "resting", "film")]
    found = np.dtype(
        [("time", "f8"), ("length", "f8"), ("collision", "i8"), *flags, ("series", "f8", (states, terms))], align=True
    )
    assert found.itemsize == size
    return found


def number(library: ctypes.CDLL, symbol: str) -> int:
    """A constant int of a kernel."""
    return ctypes.c_int.in_dll(library, symbol).value


def names(library: ctypes.CDLL, symbol: str) -> tuple[str, ...]:
    """A kernel's list of names."""
    return tuple(ctypes.string_at(ctypes.addressof(ctypes.c_char.in_dll(library, symbol))).decode().split())


class Task:
    """One call of a kernel: the numbers and buffers that it is given, which live as long as this."""

    def __init__(self, library: ctypes.CDLL, count: int, rtol: float, budget: int) -> None:
        self._library = library
        self._task = np.zeros((), TASK)
        self._task["count"], self._task["rtol"], self._task["budget"] = count, rtol, budget
        self._held: list[np.ndarray] = []

    def columns(self, columns: list[np.ndarray]) -> None:
        """Quantities in SI in the order of `quantity_names`, each a number for every collision or one for all."""
        table = np.zeros(len(columns), BUFFER)
        for row, column in zip(table, columns, strict=True):
            self._hold(row, column)
        self.buffer("quantities", table)

    def buffer(self, name: str, array: np.ndarray) -> None:
        """Where results of that name go, or what is read."""
        self._hold(self._task[name], array)

    def number(self, name: str, value: int) -> None:
        """Something else that is asked."""
        self._task[name] = value

    def _hold(self, place: np.void | np.ndarray, array: np.ndarray) -> None:
        assert array.flags.c_contiguous
        self._held.append(array)
        place["at"], place["bytes"] = array.ctypes.data, array.nbytes

    def run(self) -> int:
        """Have it done; how many steps it took, if they are counted.

        Raises:
            MemoryError: the kernel finds a buffer too small for what it would write, or has no memory of its own.
        """
        said: bytes | None = self._library.collide(self._task.ctypes.data)
        if said is not None:
            raise MemoryError(f"the kernel was not run: {said.decode()}")
        return int(self._task["steps"])
