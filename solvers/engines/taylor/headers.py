"""The emitted C headers of a scene's model and of its tangent: committed, or derived on first use and cached."""

from ...host import emitted
from ...host.remarks import say
from ...host.thread_caches import once
from ...model.key import ModelKey

_NONE = "#error "  # start of a header that could not be emitted


def has_events(choice: ModelKey) -> bool:
    """True if a user's model declares events that this structure can have."""
    return choice.package is not None and bool(choice.package.events_in(choice.structure))


def books_own(choice: ModelKey) -> bool:
    """True if the ledger has what a user's model declares: events or terms."""
    return has_events(choice) or (choice.package is not None and choice.package.terms is not None)


@once
def automaton(choice: ModelKey) -> dict[str, str]:
    """Texts of the automaton's headers by name, each with what it includes."""
    includes = {
        "automaton": (), "proofs": ("automaton", "vector"), "criteria": ("automaton", "model"), "guards": ("events",),
        "effects": ("transitions",),
    }  # fmt: skip
    texts = {name: emitted.header(f"taylor/{name}.h") for name in includes}
    if has_events(choice):
        assert choice.package is not None
        texts["automaton"], texts["effects"] = choice.package.automaton_headers()
    return {
        f"{name}.h": "".join(["#pragma once\n", *(f'#include "{header}.h"\n' for header in includes[name]), text])
        for name, text in texts.items()
    }


@once
def headers(choice: ModelKey) -> tuple[str, ...] | None:
    """Texts of the headers of a choice, laws first; None if a law has no recurrence, with one warning."""
    return _sound("no Taylor kernel", _texts(choice, tangent=False))


@once
def tangents(choice: ModelKey) -> tuple[str, ...] | None:
    """Texts of the headers with derivatives of a choice, laws first; None if a law has none, with one warning."""
    return _sound("derivatives are CasADi's, not the Taylor kernel's", _texts(choice, tangent=True))


def _texts(choice: ModelKey, tangent: bool) -> list[str]:
    return [*(_law(choice, slot, name, tangent) for slot, name in choice.laws), _structure(choice, tangent)]


def _sound(without: str, texts: list[str]) -> tuple[str, ...] | None:
    for text in texts:
        if text.startswith(_NONE):
            _say(without, text.removeprefix(_NONE).strip())
            return None
    return tuple(texts)


def _law(choice: ModelKey, slot: str, name: str, tangent: bool) -> str:
    package = choice.package
    if package is not None and (name in package.laws(slot) or package.widens((slot,))):
        return package.law_header(slot, name, tangent)
    return emitted.header(f"{_folder(tangent)}/laws/{slot}_{name.replace('-', '_')}.h")


def _structure(choice: ModelKey, tangent: bool) -> str:
    package, slots = choice.package, tuple(slot for slot, _ in choice.laws)
    if package is not None and package.changes(slots):
        return package.structure_header(choice.structure, tangent)
    return emitted.header(f"{_folder(tangent)}/{choice.structure}.h")


def _folder(tangent: bool) -> str:
    return "taylor/tangent" if tangent else "taylor"


@once  # once per process
def _say(without: str, why: str) -> None:
    say(f"{without} ({why})")
