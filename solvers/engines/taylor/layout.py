"""Data exchanged between Python and the kernel, declared once: as numpy types and as the corresponding C structures.

The kernel's source begins with `declarations()`; the C compiler checks it against the sizes in numpy. Every buffer is
passed with its size in bytes, and the kernel writes only as many rows as it holds.
"""

import ctypes
from functools import cache

import numpy as np

from ...results import DEFINITIONS

BUFFER = np.dtype([("at", np.uintp), ("bytes", "i8")], align=True)
SHOWN, SHOWN_IN_SPACE = 5, 13  # results of a collision: the outputs of its structure; in space also of a stick
_ANSWER = [
    # restitution, tangential restitution, rotation rate, spin, partner's spin; if undecided: states after the gap
    ("shown", "f8", SHOWN),
    ("time", "f8"),
    ("smallest_gap", "f8"),
    ("turned", "f8"),
    ("final_gap", "f8"),
    ("slip", "f8"),  # of the surfaces at the contact, at separation over initial contact; NaN where there is none
    ("outcome", "i4"),
    ("certified", "i4"),
    ("status", "i4"),
    ("steps", "i4"),
    ("reversal", "i4"),  # the first rebound criterion met; -1 for none
    ("events", "i4"),  # including those for which the log had no room
]
ANSWER = np.dtype(_ANSWER, align=True)
ANSWER_IN_SPACE = np.dtype([("shown", "f8", SHOWN_IN_SPACE), *_ANSWER[1:]], align=True)
MODE = ("closing", "resting", "film", "shear", "sliding", "rolling")
# an event, and the mode after it
HAPPENING = np.dtype([("kind", "i4"), *((name, "i4") for name in MODE), ("time", "f8")], align=True)
_TERMS = "initial final lifted normal tangential capillary attraction dry friction"
# then the angular momentum over its initial value
LEDGER = np.dtype([(name, "f8") for name in (*_TERMS.split(), "momentum")], align=True)
NEARNESS = np.dtype([("least", "f8"), ("boundary", "f8"), ("hint", "f8")], align=True)
# A task for a kernel: numbers, then buffers; those not needed are empty.
TASK = np.dtype(
    [
        ("count", "i8"),
        ("budget", "i8"),  # steps of a trajectory
        ("purpose", "i8"),  # used by kernels with a trajectory
        ("jumps", "i8"),  # the slow manifold may replace: 0 nothing, 1 what follows the turn, 2 the approach too
        ("requested", "i8"),  # groups by which derivatives are computed, as bits
        ("steps", "i8"),  # returned: number of steps of all trajectories, including those without room
        ("rtol", "f8"),
        ("until", "f8"),  # time (x0/v0) to which a kernel with a limit follows a stick
        ("nearest", "f8"),  # least measure of nearness to a boundary at which the adjoint takes derivatives
        ("quantities", BUFFER),  # one BUFFER for each of `quantity_names`: `count` doubles in SI, or a single one
        ("answers", BUFFER),  # of ANSWER
        ("log", BUFFER),  # of HAPPENING, the same number for each collision
        ("books", BUFFER),  # of LEDGER
        ("rows", BUFFER),  # of step_row
        ("peaks", BUFFER),  # one double per collision: the largest margin of the glass criterion while closing
        ("by_group", BUFFER),  # RESULTS doubles for each of `group_names`, per collision
        ("gradients", BUFFER),  # RESULTS doubles for each of `quantity_names`, per collision
        ("near", BUFFER),  # of NEARNESS
    ],
    align=True,
)
MORE_RESULTS = ("time", "smallest_gap", "turned")  # that have derivatives, in columns after those of the outputs
RESULTS = SHOWN + len(MORE_RESULTS)
MOST_STEPS = 300  # most steps of a trajectory with an adjoint sweep
# of a model that declares events or terms
OWN_LEDGER = np.dtype([*LEDGER.descr, ("own_events", "f8"), ("own_terms", "f8")], align=True)
_STRUCTURES = {"buffer": BUFFER, "answer": ANSWER, "happening": HAPPENING, "ledger": LEDGER, "nearness": NEARNESS}
_C_TYPES = {"f8": "double", "i8": "int64_t", "i4": "int32_t"}


def declarations(ledger: bool, own: bool = False, space: bool = False) -> str:
    """C structures of these types, with static assertions that the compiler lays them out as numpy does.

    Arguments:
        own: the ledger has what a model declares.
        space: answers have room for vectors.
    """
    lines = ["#include <stddef.h>", "#include <stdint.h>"]
    structures = {**_STRUCTURES, **({"ledger": OWN_LEDGER} if own else {})}
    structures |= {"answer": ANSWER_IN_SPACE} if space else {}
    for name, layout in (*structures.items(), ("task", TASK)):
        if name == "ledger" and not ledger:
            continue
        lines.append("typedef struct {")
        lines += [f"    {_member(field, kind)};" for field, (kind, *_) in (layout.fields or {}).items()]
        lines.append(f"}} {name};")
        lines += [
            f"STATIC_ASSERT(offsetof({name}, {field}) == {where});"
            for field, (_, where, *_) in (layout.fields or {}).items()
        ]
        lines.append(f"STATIC_ASSERT(sizeof({name}) == {layout.itemsize});")
    return "\n".join(lines)


def _member(name: str, kind: np.dtype) -> str:
    base, shape = kind.subdtype or (kind, ())
    structure = next((key for key, value in _STRUCTURES.items() if value == base), None)
    if name == "at":
        return "void *at"
    return f"{structure or _C_TYPES[base.str[1:]]} {name}{''.join(f'[{size}]' for size in shape)}"


def step_row(library: ctypes.CDLL) -> np.dtype:
    """The type of a step's row in this kernel, from its exported states and terms."""
    states, terms, size = (number(library, name) for name in ("row_states", "row_terms", "row_bytes"))
    flags = [(name, "i4") for name in ("phase", "closing", "resting", "film")]
    row = np.dtype(
        [("time", "f8"), ("length", "f8"), ("collision", "i8"), *flags, ("series", "f8", (states, terms))], align=True
    )
    assert row.itemsize == size
    return row


def result(answers: np.ndarray, name: str) -> np.ndarray:
    """A dimensionless result of answers, by name."""
    place = DEFINITIONS[name].place
    values: np.ndarray = answers[place] if isinstance(place, str) else answers["shown"][:, place]
    return values


def derivative_column(name: str) -> int:
    """Column of a result among those that the kernel differentiates."""
    place = DEFINITIONS[name].place
    assert place is not None
    return SHOWN + MORE_RESULTS.index(place) if isinstance(place, str) else place


@cache
def number(library: ctypes.CDLL, symbol: str) -> int:
    """A constant int exported by a kernel."""
    return ctypes.c_int.in_dll(library, symbol).value


@cache
def names(library: ctypes.CDLL, symbol: str) -> tuple[str, ...]:
    """A list of names exported by a kernel."""
    return tuple(ctypes.string_at(ctypes.addressof(ctypes.c_char.in_dll(library, symbol))).decode().split())


class Task:
    """A call of a kernel: its numbers and buffers, kept alive as long as this object."""

    def __init__(self, library: ctypes.CDLL, count: int, rtol: float, budget: int) -> None:
        self._library = library
        self._task = np.zeros((), TASK)
        self._task["count"], self._task["rtol"], self._task["budget"] = count, rtol, budget
        self._held: list[np.ndarray] = []

    def columns(self, columns: list[np.ndarray | float]) -> None:
        """Quantities in SI in the order of `quantity_names`, each an array of one per collision or a common number."""
        common = np.array([column if isinstance(column, float) else 0.0 for column in columns])
        first, size = self._hold(common)[0], common.itemsize
        rows = [
            (first + size * k, size) if isinstance(column, float) else self._hold(column)
            for k, column in enumerate(columns)
        ]
        self.buffer("quantities", np.array(rows, BUFFER))

    def buffer(self, name: str, array: np.ndarray) -> None:
        self._task[name] = self._hold(array)

    def number(self, name: str, value: float) -> None:
        self._task[name] = value

    def _hold(self, array: np.ndarray) -> tuple[int, int]:
        """Address and size in bytes of an array, which is kept alive."""
        assert array.flags.c_contiguous
        self._held.append(array)
        return array.ctypes.data, array.nbytes

    def run(self) -> int:
        """Run the task; returns the number of steps, if they are counted.

        Raises:
            MemoryError: the kernel finds a buffer too small, or cannot allocate memory.
        """
        message: bytes | None = self._library.collide(self._task.ctypes.data)
        if message is not None:
            raise MemoryError(f"the kernel was not run: {message.decode()}")
        return int(self._task["steps"])
