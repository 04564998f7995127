"""Scene files spoilt at random: each is a scene or an InputError of one line, and soon so.

    python tests/helpers/mutations.py --count 20000 --seed 0

takes some minutes, says how long the slowest took and how much memory all of them, and keeps what breaks the rule.
"""

import argparse
import random
import re
import resource
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.scene.scenefile import PRESETS, read_text

SECONDS, MEGABYTES = 3.0, 100.0  # the most that a file may take
_ROOT = Path(__file__).resolve().parents[2]
_TOKEN = re.compile(r'"[^"\n]*"|[\w.+-]+|\s+|.', re.DOTALL)
_NUMBER = re.compile(r"(?<![\w.])[+-]?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?")
_VALUE = re.compile(r"(?<== )[^\n#]+")
_QUANTITY = re.compile(r'"[+-]?[0-9.eE+-]+ ?[^"\n]*"')

NUMBERS = (
    "0", "-0.0", "-1", "1e308", "1e-308", "1e9999", "5e-324", "nan", "inf", "-inf", "9" * 4000, "9" * 6000,
    "0x" + "f" * 5000, "0." + "1" * 9000, "1_000", "1e", "+-1", "0o17", "1.7976931348623157e308", "true", "1e0000001",
)  # fmt: skip
UNITS = (
    "m", "", "furlong", "km/h", "degC", "dBm", "m^9^9^9", "m^99", "kg kg kg", "((((m))))", "(" * 90, "1/s/s/s/s",
    "Pa.s", "ΩμÅ", "\\u0000", "m\\n", "yottayottam", "percent", "m**-3", "*", "/", "rad", "_", "kg m / s", "mol",
    "delta_degC", "f" * 150 + "!", "a" * 150, "1/0", "%", "°", "Pa s Pa s", "inch", "lbf ft", "(m", "m)", "m^-1",
)  # fmt: skip
KEYS = ("a.b", '"a b"', "liquid", "particles.radius", "''", "a" * 300, ".".join("a" * 30), "name", "ключ", "custom.x")


def seeds() -> list[bytes]:
    """Scene files to begin with: the presets, and those of the documentation."""
    texts = [read_text(name)[0] for name in PRESETS]
    for page in sorted((_ROOT / "docs" / "reference").glob("*.md")):
        texts += re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    return [text.encode() for text in texts]


def mutated(rng: random.Random, seed: bytes) -> bytes:
    """A scene file with one to four faults."""
    content = seed
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        content = rng.choice(_MUTATIONS)(rng, content)
    return content


def files(count: int, seed: int) -> Iterator[bytes]:
    """The same files for the same seed."""
    rng, originals = random.Random(seed), seeds()
    for _ in range(count):
        yield mutated(rng, rng.choice(originals))


def _as_text(change: Callable[[random.Random, str], str]) -> Callable[[random.Random, bytes], bytes]:
    return lambda rng, content: change(rng, content.decode("utf-8", "replace")).encode("utf-8", "replace")


def _swapped_tokens(rng: random.Random, text: str) -> str:
    tokens = _TOKEN.findall(text)[:5000]
    for _ in range(rng.randint(1, 5)):
        if tokens:
            i, j = rng.randrange(len(tokens)), rng.randrange(len(tokens))
            tokens[i], tokens[j] = tokens[j], tokens[i]
    return "".join(tokens)


def _lines(rng: random.Random, text: str) -> str:
    lines = text.split("\n")[:5000]
    at = rng.randrange(len(lines))
    kind = rng.randrange(4)
    if kind == 0:
        lines.insert(rng.randrange(len(lines)), lines[at])  # twice
    elif kind == 1:
        del lines[at]
    elif kind == 2:
        rng.shuffle(lines)
    else:
        lines[at] = lines[at][: len(lines[at]) // 2]
    return "\n".join(lines)


def _replaced(pattern: re.Pattern[str], new: Callable[[random.Random, str], str]) -> Callable[..., str]:
    """One of the places where a pattern is found, made into something else."""

    def change(rng: random.Random, text: str) -> str:
        places = list(pattern.finditer(text))
        if not places:
            return text
        place = rng.choice(places)
        return text[: place.start()] + new(rng, place[0]) + text[place.end() :]

    return change


def _nested(rng: random.Random, value: str) -> str:
    depth = rng.choice((1, 2, 8, 9, 100, 3000))
    kind = rng.randrange(5)
    if kind == 0:
        return "[" * depth + value + "]" * depth
    if kind == 1:
        return "{a = " * depth + value + "}" * depth
    if kind == 2:
        return "[" * depth
    if kind == 3:
        return "{" + ".".join("a" * min(depth, 500)) + " = 1}"
    return f'"""{value}"""' if '"' not in value else "'''" + value


def _header(rng: random.Random, text: str) -> str:
    key = rng.choice(KEYS)
    line = rng.choice((f"[{key}]", f"[[{key}]]", f"{key} = 1", f"[{key}", f"{key} = {{}}", f"{key}.{key} = [1, 2]"))
    lines = text.split("\n")
    lines.insert(rng.randrange(len(lines) + 1), line)
    return "\n".join(lines)


def _repeated(rng: random.Random, content: bytes) -> bytes:
    at = rng.randrange(len(content) + 1)
    part = content[at : at + rng.choice((1, 2, 5, 20, 200))]
    times = rng.choice((2, 100, 10_000, 100_000))
    return content[:at] + part * min(times, 300_000 // max(1, len(part))) + content[at:]


def _bytes(rng: random.Random, content: bytes) -> bytes:
    spoilt = bytearray(content)
    for _ in range(rng.choice((1, 1, 3, 20))):
        at = rng.randrange(len(spoilt) + 1)
        kind = rng.randrange(3)
        if kind == 0:
            spoilt[at:at] = rng.randbytes(rng.choice((1, 2, 8)))
        elif kind == 1:
            spoilt[at : at + 1] = bytes([rng.choice(b"[]{}='\"\\#.,\n\r\t\0 _-+eE0:")])
        else:
            del spoilt[at : at + rng.choice((1, 1, 5, 50))]
    return bytes(spoilt)


def _encoded(rng: random.Random, content: bytes) -> bytes:
    kind = rng.randrange(4)
    if kind == 0:
        return b"\xef\xbb\xbf" + content
    if kind == 1:
        return content.decode("utf-8", "replace").encode("utf-16")
    return content.replace(b"\n", b"\r\n" if kind == 2 else b"\r")


_MUTATIONS: tuple[Callable[[random.Random, bytes], bytes], ...] = (
    _as_text(_swapped_tokens),
    _as_text(_lines),
    _as_text(_header),
    _as_text(_replaced(_NUMBER, lambda rng, _: rng.choice(NUMBERS))),
    _as_text(_replaced(_VALUE, lambda rng, _: rng.choice(NUMBERS))),
    _as_text(_replaced(_QUANTITY, lambda rng, _: f'"{rng.choice(NUMBERS)[:190]} {rng.choice(UNITS)}"')),
    _as_text(_replaced(_QUANTITY, lambda rng, value: f'"{value[1:-1].split(" ")[0]} {rng.choice(UNITS)}"')),
    _as_text(_replaced(_VALUE, _nested)),
    lambda rng, content: content[: rng.randrange(len(content) + 1)],
    _repeated,
    _bytes,
    _encoded,
)


def judged(content: bytes, file: Path) -> bool:
    """Whether a file is a scene, which is then the same after a journey through TOML; only InputError is caught."""
    file.write_bytes(content)
    try:
        scene = Scene.load(file)
    except InputError as error:
        line = str(error)
        if "\n" in line or len(line) > 3000:
            raise AssertionError(f"no line to be read: {line[:3000]}") from None
        return False
    if Scene.from_toml(scene.to_toml()) != scene:
        raise AssertionError("is another scene after a journey through TOML")
    return True


def main() -> int:
    """Judge as many as are asked for; exit status 1 if one breaks the rule."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=20000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, default=Path("mutations"), help="folder for files that break the rule")
    asked = parser.parse_args()
    asked.keep.mkdir(exist_ok=True)
    file = asked.keep / "scene.toml"
    judged(seeds()[0].replace(b"50 um", b"0.002 inch"), file)  # what is imported once is not a file's
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    valid, slowest, broken = 0, 0.0, 0
    for number, content in enumerate(files(asked.count, asked.seed)):
        begun = time.process_time()
        try:
            valid += judged(content, file)
            problem = ""
        except BaseException as error:  # noqa: BLE001 # the one thing that must not happen
            problem = f"{type(error).__name__}: {error}"
        took = time.process_time() - begun
        slowest = max(slowest, took)
        if problem or took > SECONDS:
            broken += 1
            (asked.keep / f"{asked.seed}-{number}.toml").write_bytes(content)
            sys.stdout.write(f"{asked.seed}-{number}: {problem or f'{took:.1f} s'}\n")
    file.unlink()
    unit = 2**20 if sys.platform == "darwin" else 2**10
    more = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / unit
    sys.stdout.write(
        f"{asked.count} files, seed {asked.seed}: {valid} scenes, {asked.count - valid - broken} refused, "
        f"{broken} broke the rule; slowest {slowest:.2f} s, {more:.0f} MB more than before\n"
    )
    return int(broken > 0 or more > MEGABYTES)


if __name__ == "__main__":
    sys.exit(main())
