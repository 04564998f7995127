"""What can go wrong, as exceptions that read as one line and know their exit status."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Mapping
from typing import Any, ClassVar

_LONGEST = 80  # characters of an offending value that are shown
_LONGEST_NAME = 200  # of what it was given for, which may be a file and a line
_NEAR = 0.6  # likeness, 0 to 1, from which on a name is suggested


def shown(value: object) -> str:
    """Return `value` as it would stand in a scene file, on one line and not too long."""
    if isinstance(value, str):
        text = '"' + repr(value[: _LONGEST + 1])[1:-1] + '"'  # repr escapes whatever would break the line
    elif isinstance(value, Mapping):
        text = "a table"
    else:
        text = " ".join(_Short().repr(value).split())
    return text if len(text) <= _LONGEST else text[: _LONGEST - 4] + "..." + text[-1]


class _Short(reprlib.Repr):
    """A representation of anything, in bounded time: not all of a long list, and of a hostile object its class."""

    def __init__(self) -> None:
        super().__init__()
        self.maxother = self.maxstring = self.maxlong = 2 * _LONGEST

    def repr_int(self, x: int, level: int) -> str:
        """Return an integer, or how long it is: Python refuses to write out more than some thousands of digits."""
        return repr(x) if abs(x) < 10**_LONGEST else f"an integer of {x.bit_length()} bits"


def cut(text: str, longest: int) -> str:
    """Return `text`, its middle left out where it is longer."""
    return text if len(text) <= longest else f"{text[: longest * 2 // 3]}...{text[-longest // 4 :]}"


def one_line(text: str) -> str:
    """Return `text` with whatever would break the line, or drive a terminal, escaped."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def nearest(word: object, known: Iterable[str]) -> str | None:
    """Return the known name most like `word`, one that begins with it before others, or None if none is near.

    The dashes of options do not count.
    """
    from difflib import get_close_matches

    if not isinstance(word, str):
        return None
    names = {name.lower().lstrip("-"): name for name in known}
    asked = word[:_LONGEST].lower().lstrip("-")
    close = get_close_matches(asked, names, cutoff=_NEAR)
    begun = [name for name in close if name.startswith(asked)]
    return names[(begun or close)[0]] if close else None


def did_you_mean(word: object, known: Iterable[str]) -> str:
    """Return `, did you mean NAME?` for the nearest known name, or nothing."""
    name = nearest(word, known)
    return f", did you mean {name}?" if name else ""


class WetDoubletError(Exception):
    """Any failure that is the user's to read: its text is one line."""

    exit_status: ClassVar[int] = 1


class ModelWarning(UserWarning):
    """A law is used outside the range that it was made for; the result is what the law says there."""


class InputError(WetDoubletError, ValueError):
    """Bad input: `FIELD: VALUE problem; accepted: ...`.

    Arguments:
        field: dotted name of the scene entry, or the option (`--rtol`).
        value: what was given; None stands for nothing at all.
        accepted: what would have been right, in words.
        problem: what is wrong with the value (`is not finite`).
    """

    exit_status = 2

    def __init__(self, field: str, value: Any, accepted: str, problem: str = "") -> None:
        super().__init__(field, value, accepted, problem)  # all of them, so that it pickles
        self.field = field
        self.value = value
        self.accepted = accepted
        self.problem = problem

    def __str__(self) -> str:
        """Return the one line."""
        said = self.problem or "is not accepted"
        if self.value is None:
            said = self.problem or "missing"
        else:
            said = f"{shown(self.value)} {said}"
        return one_line(f"{cut(str(self.field), _LONGEST_NAME)}: {said}; accepted: {self.accepted}")


class ComputationError(WetDoubletError, RuntimeError):
    """An integration that could not be completed, with the place where it stopped.

    Arguments:
        message: what failed.
        phase: name of the phase of the trajectory.
        time: s since initial contact.
        state: the last state, name to SI value.
        advice: what to try.
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
        return " ".join("; ".join(part for part in parts if part).split())


class CheckFailed(WetDoubletError):
    """A check was made and did not hold (a law, or the emitted files)."""

    def __str__(self) -> str:
        """Return the one line."""
        return " ".join(super().__str__().split())
