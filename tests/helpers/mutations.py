"""Scene files spoilt at random: each is a scene or an InputError of one line."""

import random
import re
from collections.abc import Callable, Iterator
from pathlib import Path

from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.scene.scenefile import PRESETS, read_text

_TOKEN = re.compile(r'"[^"\n]*"|[\w.+-]+|\s+|.', re.DOTALL)
_NUMBER = re.compile(r"(?<![\w.])[+-]?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?")
_VALUE = re.compile(r"(?<== )[^\n#]+")
_QUANTITY = re.compile(r'"[+-]?[0-9.eE+-]+ ?[^"\n]*"')
NUMBERS = (
    "0", "-0.0", "-1", "1e308", "1e-308", "1e9999", "5e-324", "nan", "inf", "-inf", "9" * 6000, "1_000", "1e", "+-1",
    "0x" + "f" * 5000, "0." + "1" * 9000, "0o17", "1.7976931348623157e308", "true", "1e0000001",
)  # fmt: skip
UNITS = (
    "m", "", "furlong", "degC", "dBm", "m^9^9^9", "m^99", "kg kg kg", "((((m))))", "(" * 90, "1/s/s/s/s", "Pa.s",
    "ΩμÅ", "\\u0000", "m\\n", "percent", "m**-3", "*", "rad", "mol", "f" * 150 + "!", "1/0", "%", "°", "(m", "m)",
)  # fmt: skip
KEYS = ("a.b", '"a b"', "liquid", "particles.radius", "''", "a" * 300, ".".join("a" * 30), "name", "ключ", "custom.x")


def _replaced(pattern: re.Pattern[str], new: Callable[[random.Random, str], str]) -> Callable[..., str]:
    """One of the places where a pattern is found, made into something else."""

    def change(rng: random.Random, text: str) -> str:
        places = list(pattern.finditer(text))
        if not places:
            return text
        place = rng.choice(places)
        return text[: place.start()] + new(rng, place[0]) + text[place.end() :]

    return change


def _tokens(rng: random.Random, text: str) -> str:
    tokens = _TOKEN.findall(text)[:5000]
    for _ in range(rng.randint(1, 5) if tokens else 0):
        i, j = rng.randrange(len(tokens)), rng.randrange(len(tokens))
        tokens[i], tokens[j] = tokens[j], tokens[i]
    return "".join(tokens)


def _lines(rng: random.Random, text: str) -> str:
    lines, key = text.split("\n"), rng.choice(KEYS)
    at, more = rng.randrange(len(lines)), (f"[{key}]", f"[[{key}]]", f"{key} = 1", f"[{key}", f"{key}.{key} = [1, 2]")
    lines[at : at + 1] = rng.choice(([], [lines[at]] * 2, [lines[at][: len(lines[at]) // 2]], [rng.choice(more)]))
    return "\n".join(lines)


def _nested(rng: random.Random, value: str) -> str:
    depth = rng.choice((1, 2, 8, 9, 100, 3000))
    return rng.choice(("[" * depth + value + "]" * depth, "{a = " * depth + value + "}" * depth, "[" * depth))


def _bytes(rng: random.Random, text: str) -> str:
    at, part = rng.randrange(len(text) + 1), rng.choice(("[", "]", "=", '"', "\\", "#", "\r", "\0", "\ufeff", "ÿ"))
    return text[:at] + part * rng.choice((1, 2, 100_000)) + text[at + rng.choice((0, 1, 50)) :]


_MUTATIONS: tuple[Callable[[random.Random, str], str], ...] = (
    _tokens, _lines, _bytes, _replaced(_VALUE, _nested), lambda rng, text: text[: rng.randrange(len(text) + 1)],
    _replaced(_NUMBER, lambda rng, _: rng.choice(NUMBERS)), _replaced(_VALUE, lambda rng, _: rng.choice(NUMBERS)),
    _replaced(_QUANTITY, lambda rng, _: f'"{rng.choice(NUMBERS)[:190]} {rng.choice(UNITS)}"'),
    _replaced(_QUANTITY, lambda rng, value: f'"{value[1:-1].split(" ")[0]} {rng.choice(UNITS)}"'),
)  # fmt: skip


def files(count: int, seed: int) -> Iterator[bytes]:
    """The same files for the same seed: presets with one to four faults, some in another encoding."""
    rng, originals = random.Random(seed), [read_text(name)[0] for name in PRESETS]
    for _ in range(count):
        text = rng.choice(originals)
        for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
            text = rng.choice(_MUTATIONS)(rng, text)
        yield text.encode(rng.choice(["utf-8"] * 8 + ["utf-16", "latin-1"]), "replace")


def judged(content: bytes, file: Path) -> bool:
    """Whether a file is a scene, which is then the same after a journey through TOML; only InputError is caught."""
    file.write_bytes(content)
    try:
        scene = Scene.load(file)
    except InputError as error:
        assert "\n" not in str(error) and len(str(error)) < 3000
        return False
    assert Scene.from_toml(scene.to_toml()) == scene
    return True
