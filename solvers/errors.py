"""Exceptions of the package: each prints as one line and has an exit status."""

import reprlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar

_LONGEST = 80  # most characters shown of an offending value
_LONGEST_NAME = 200  # most characters of its field, which may be a file and a line
_NAMED = 8  # most names in a sentence
_NEAR = 0.6  # least similarity, 0 to 1, at which a name is suggested


def excerpt(value: object) -> str:
    """Return `value` as in a scene file, on one line of at most 80 characters."""
    if isinstance(value, str):
        text = '"' + repr(value[: _LONGEST + 1])[1:-1] + '"'  # repr escapes line breaks
    elif isinstance(value, Mapping):
        text = "a table"
    else:
        text = " ".join(_Short().repr(value).split())
    return text if len(text) <= _LONGEST else text[: _LONGEST - 4] + "..." + text[-1]


class _Short(reprlib.Repr):
    """`repr` in bounded time: long lists are shortened, objects whose own repr fails show their class."""

    def __init__(self) -> None:
        super().__init__()
        self.maxother = self.maxstring = self.maxlong = 2 * _LONGEST

    def repr_int(self, x: int, level: int) -> str:
        """Return an integer, or its length in bits: Python refuses to print more than some thousand digits."""
        return repr(x) if abs(x) < 10**_LONGEST else f"an integer of {x.bit_length()} bits"


def cut(text: str, longest: int) -> str:
    """Return `text`, with its middle replaced by `...` if it exceeds `longest` characters."""
    return text if len(text) <= longest else f"{text[: longest * 2 // 3]}...{text[-longest // 4 :]}"


def install_extra(name: str) -> str:
    """Return the advice to install an extra of the package, which is installed from a clone."""
    return f"in the clone run pip install '.[{name}]'"


def one_line(text: str) -> str:
    """Return `text` with line breaks and control characters escaped."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def several(names: Sequence[str], mark: str = ", ") -> str:
    """The first names in a sentence, and how many more there are."""
    more = len(names) - _NAMED
    return mark.join(names[:_NAMED]) + f" and {more} more" * (more > 0)


def nearest(word: object, candidates: Iterable[str]) -> str | None:
    """Return the known name most similar to `word`, preferably one that begins with it, or None if none is near.

    Leading dashes of options are ignored.
    """
    from difflib import get_close_matches

    if not isinstance(word, str):
        return None
    names = {name.lower().lstrip("-"): name for name in candidates}
    wanted = word[:_LONGEST].lower().lstrip("-")
    close = get_close_matches(wanted, names, cutoff=_NEAR)
    begun = [name for name in close if name.startswith(wanted)]
    return names[(begun or close)[0]] if close else None


def did_you_mean(word: object, candidates: Iterable[str]) -> str:
    """Return `, did you mean NAME?` for the nearest known name, or an empty text."""
    name = nearest(word, candidates)
    return f", did you mean {name}?" if name else ""


class WetDoubletError(Exception):
    """Base of all failures reported to the user; the text is one line.

    Example:
        >>> from wetdoublet.solvers import InputError, WetDoubletError
        >>> issubclass(InputError, WetDoubletError)
        True
    """

    exit_status: ClassVar[int] = 1


class ModelWarning(UserWarning):
    """A law is used outside its range of validity; the result is its extrapolation.

    Example:
        >>> import warnings
        >>> from wetdoublet.solvers import ModelWarning, Scene, collide
        >>> scene = Scene.load("granulation").with_entries({"bridge.law": "willett", "bridge.volume": 0.2})
        >>> with warnings.catch_warnings(record=True, category=ModelWarning) as told:
        ...     warnings.simplefilter("always")
        ...     outcome = collide(scene).outcome
        >>> len(told)
        1
    """


class InputError(WetDoubletError, ValueError):
    """Bad input: `FIELD: VALUE problem; accepted: ...`.

    Arguments:
        field: dotted name of the scene entry, or the option (`--rtol`).
        value: the given value; None if it is missing.
        accepted: the accepted values, in words.
        problem: the fault of the value (`is not finite`).

    Example:
        >>> from wetdoublet.solvers import InputError, collide
        >>> try:
        ...     collide("granulation", angle="95 deg")
        ... except InputError as error:
        ...     print(error.field, error.value)
        impact.angle 95 deg
    """

    exit_status = 2

    def __init__(self, field: str, value: Any, accepted: str, problem: str = "") -> None:
        super().__init__(field, value, accepted, problem)  # all arguments, so that it can be pickled
        self.field = field
        self.value = value
        self.accepted = accepted
        self.problem = problem

    def __str__(self) -> str:
        """Return the one line."""
        text = self.problem or "is not accepted"
        if self.value is None:
            text = self.problem or "missing"
        else:
            text = f"{excerpt(self.value)} {text}"
        return one_line(f"{cut(str(self.field), _LONGEST_NAME)}: {text}; accepted: {self.accepted}")


class ComputationError(WetDoubletError, RuntimeError):
    """An integration that could not be completed, with the phase, time and state where it stopped.

    Arguments:
        message: the failure.
        phase: name of the phase of the trajectory.
        time: s since initial contact.
        state: the last state, name -> SI value.
        advice: a remedy to try.

    Example:
        >>> from wetdoublet.solvers import ComputationError
        >>> str(ComputationError("gave up", phase="closing", time=1e-6, advice="try another engine"))
        'gave up in phase closing at t = 1e-06 s; try another engine'
    """

    def __init__(
        self,
        message: str,
        phase: str | None = None,
        time: float | None = None,
        state: Mapping[str, float] | None = None,
        advice: str = "",
    ) -> None:
        super().__init__(message, phase, time, state, advice)
        self.message = message
        self.phase = phase
        self.time = time
        self.state: dict[str, float] = dict(state or {})
        self.advice = advice

    def __str__(self) -> str:
        """Return the one line."""
        where = f" in phase {self.phase}" if self.phase is not None else ""
        when = f" at t = {self.time:.6g} s" if self.time is not None else ""
        state = ", ".join(f"{name} = {value:.6g}" for name, value in self.state.items())
        parts = [self.message + where + when, state and f"state {state}", self.advice]
        return " ".join("; ".join(text for text in parts if text).split())


class CheckFailed(WetDoubletError):
    """A check failed (of a law, or of the emitted files).

    Example:
        >>> from wetdoublet.solvers import CheckFailed
        >>> CheckFailed("energy ledger: 2e-3 > 1e-8").exit_status
        1
    """

    def __str__(self) -> str:
        return " ".join(super().__str__().split())
