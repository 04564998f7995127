"""Checks of arguments of public functions that are no physical quantities: names, flags, whole numbers, mappings."""

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from numbers import Integral
from typing import Any

from ..errors import InputError, did_you_mean


def check_names(requested: object, choices: Sequence[str], label: str, none: str = "") -> tuple[str, ...]:
    """Return the requested name or names, in order, without duplicates; InputError suggests the nearest known name.

    Arguments:
        none: the fault of a list without names ("names no entry"), if it is one.
    """
    accepted = ", ".join(choices)
    if isinstance(requested, str):
        several = [name.strip() for name in requested.split(",")]
        if len(several) > 1 and set(several) <= set(choices):  # as on the command line
            raise InputError(label, requested, json.dumps(several), "is one text")
        requested = (requested,)
    if not isinstance(requested, Collection) or isinstance(requested, (bytes, bytearray)):
        raise InputError(label, requested, accepted, "is not a list of names")
    if none and len(requested) == 0:  # an array has no truth value
        raise InputError(label, "", accepted, none)
    for name in requested:
        if not isinstance(name, str) or name not in choices:
            raise InputError(label, name, accepted, "is not known" + did_you_mean(name, choices))
    return tuple(dict.fromkeys(str(name) for name in requested))


def check_name(requested: object, choices: Sequence[str], label: str) -> str:
    """Return one of the known names; InputError for anything else, which suggests the nearest."""
    if not isinstance(requested, str) or requested not in choices:
        raise InputError(label, requested, ", ".join(choices), "is not known" + did_you_mean(requested, choices))
    return requested


def check_flag(value: object, label: str) -> bool:
    """Return a bool, Python's or numpy's; InputError for anything else."""
    if isinstance(value, bool) or type(value).__name__ in ("bool_", "bool"):  # a numpy bool
        return bool(value)
    raise InputError(label, value, "True or False", "is neither")


def check_whole(value: object, label: str, least: int, most: int) -> int:
    """Return a whole number from `least` to `most`; InputError for anything else."""
    if not isinstance(value, Integral) or isinstance(value, bool) or not least <= int(value) <= most:
        raise InputError(label, value, f"a whole number from {least} to {most}")
    return int(value)


def check_mapping(value: object, label: str, accepted: str) -> Mapping[str, Any]:
    """Return a mapping of names; InputError for anything else."""
    if not isinstance(value, Mapping):
        raise InputError(label, value, accepted, "is not a mapping")
    for name in value:
        if not isinstance(name, str):
            raise InputError(label, name, accepted, "is not a name")
    return value


def check_function(value: object, label: str) -> Callable[..., Any] | None:
    """Return a function or None; InputError for anything else."""
    if value is not None and not callable(value):
        raise InputError(label, value, "a function, or None", "cannot be called")
    return value
