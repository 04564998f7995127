"""Whether two trees of this repository compute the same: run on one machine, in one go, nothing stored.

    python tests/two_trees.py BEFORE AFTER [--collisions N] [--seed S] [--quick] [--only KIND,...] [--renamed FILE]

BEFORE and AFTER are git revisions or folders with derive/, generated/ and solvers/. Each tree runs in processes of its
own, with caches of its own, through the public interface (`two_trees_worker.py`); what it answers is compared:

* collisions: `collide` and `collide_many` by the CasADi engines, with ledger, events and trajectory: bit for bit;
* kernels: `collide_many` and `collide` by the Taylor kernel: bit for bit with -ffp-contract=off, and with the flags
  that ship to 1e-13 times the conditioning, while outcomes, events and reasons are equal;
* space: `collide_pair` on random vectors, and `collide` where solids chatter until they rest: bit for bit;
* gradients: `gradients_many`, `sensitivities`, `band`: bit for bit;
* boundaries: `boundary`, `boundary_sensitivities`, `atlas`, `regime_map`: bit for bit;
* commands: exit status, standard output, errors and files of every command but `bench`, which measures time.

The flags that ship let the compiler fuse products with sums, and where it does depends on how the code is arranged. The
tolerance of a number is then 1e-13 times the larger of its size and its conditioning: the sum, over four random
perturbations of all entries and the impact at once by about 1e-6, of its change per relative perturbation (in BEFORE).
What cancels (residual of the ledger, drift of the angular momentum) is measured by what it is a difference of. These
collisions are integrated to rtol 1e-13: where rounding decides that a step is taken anew, the result moves by as much.

--renamed FILE has lines `old text -> new text`: words renamed on purpose. They are applied to lines, keys and messages
of BEFORE that AFTER does not have; each use is counted. Exit status: 0 if the trees agree, 1 if
not, or if one of them cannot be run. The full run takes some ten minutes on two quiet cores, --quick two to three.
"""

from __future__ import annotations

import argparse
import difflib
import io
import json
import math
import os
import re
import subprocess
import sys
import tarfile
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("derive", "generated", "solvers")
KINDS = ("collisions", "kernels", "space", "gradients", "boundaries", "commands")
OFF, SHIPPED = "-ffp-contract=off", ""
SHOWN = 4  # records of a kind that differ, and differences of a record, that are printed
_print = partial(print, flush=True)
_NUMBER = re.compile(r"-?(0x[01]\.[0-9a-f]+p[+-]\d+|inf)|nan")


@dataclass
class Renaming:
    """Words renamed on purpose, old to new, and how often each was needed."""

    words: Sequence[tuple[str, str]] = ()
    uses: Counter[str] = field(default_factory=Counter)

    @classmethod
    def read(cls, file: Path) -> Renaming:
        """From lines `old text -> new text`; empty lines and those that begin with # are passed over."""
        lines = [line for line in file.read_text().splitlines() if line.strip() and not line.startswith("#")]
        for line in lines:
            if line.count(" -> ") != 1:
                raise SystemExit(f"--renamed {file}: {line!r} is not `old text -> new text`")
        return cls([tuple(line.split(" -> ")) for line in lines])

    def __call__(self, text: str, accepted: Sequence[str] | set[str]) -> str:
        """`text` with all words renamed if that is among what is `accepted`; else as it is."""
        found, used = text, []
        for old, new in self.words:
            if old in found:
                used.append(f"{old} -> {new}")
                found = found.replace(old, new)
        if found == text or found not in accepted:
            return text
        self.uses.update(used)
        return found


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Path and value of everything below `value` that is neither a mapping nor a list; empty ones are themselves."""
    below = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    empty = True
    for key, each in below:
        empty = False
        yield from leaves(each, f"{path}/{key}")
    if empty:
        yield path, value


def differences(before: dict[str, Any], after: dict[str, Any], renamed: Renaming) -> list[str]:
    """What differs between two records of the same name, a text each.

    Arguments:
        before, after: records with a `value`, floats in hexadecimal; that of `before` may have a `tolerance`, path ->
            largest difference.
        renamed: words of `before` that may have become others.
    """
    old, new = dict(leaves(before["value"])), dict(leaves(after["value"]))
    tolerance = before.get("tolerance", {})
    left = {path for path in new if path not in old}
    moved = {path: renamed(path, left) if path not in new else path for path in old}
    found = [f"{path}: only after: {new[path]!r:.200}" for path in sorted(left - set(moved.values()))]
    for path, value in old.items():
        if moved[path] not in new:
            found.append(f"{path}: only before: {value!r:.200}")
            continue
        told = _told(path, value, new[moved[path]], tolerance.get(path), renamed)
        found += [told] if told else []
    return found


def _told(path: str, old: Any, new: Any, tolerance: str | None, renamed: Renaming) -> str:
    """How a value differs from what it was; empty if it agrees."""
    if type(old) is type(new) and old == new:
        return ""
    if not isinstance(old, str) or not isinstance(new, str):
        return f"{path}: {old!r:.200} before, {new!r:.200} after"
    if _NUMBER.fullmatch(old) and _NUMBER.fullmatch(new):
        one, two = float.fromhex(old), float.fromhex(new)
        if tolerance is not None and abs(one - two) <= float.fromhex(tolerance):
            return ""
        relative = abs(one - two) / max(abs(one), abs(two)) if math.isfinite(one - two) and one != two else math.nan
        allowed = f", {float.fromhex(tolerance):.1e} is allowed" if tolerance is not None else ""
        return f"{path}: {one!r} before, {two!r} after: {relative:.1e} relative, {abs(one - two):.1e} absolute{allowed}"
    lines, others = old.splitlines(), new.splitlines()
    accepted = set(others)
    lines = [line if line in accepted else renamed(line, accepted) for line in lines]
    if lines == others:
        return "" if old.endswith("\n") == new.endswith("\n") else f"{path}: one of the two ends with a newline"
    if len(lines) < 2 and len(others) < 2:
        return f"{path}: {old!r} before, {new!r} after"
    return "\n".join([f"{path}:", *difflib.unified_diff(lines, others, "before", "after", n=1, lineterm="")])


def compared(before: Path, after: Path, renamed: Renaming, say: Any = _print) -> tuple[int, int]:
    """How many records two files of JSON lines have between them, and how many differ; tells of both, kind by kind."""
    old, new = _records(before), _records(after)
    total: dict[str, Counter[str]] = defaultdict(Counter)
    told: dict[str, list[str]] = defaultdict(list)
    met: Counter[str] = Counter()
    for name in dict.fromkeys([*old, *new]):
        one = old.get(name) or new[name]
        met.update(
            str(value) for path, value in leaves(one["value"]) if path.endswith(("/kind", "/outcome", "/raises"))
        )
        if name in old and name in new:
            found = differences(old[name], new[name], renamed)
        else:
            found = ["only " + ("before" if name in old else "after")]
        counts = total[one["what"]]
        counts.update(records=1, compared=one["count"], differ=int(bool(found)))
        if found:
            shown = "\n".join(found[:SHOWN] + [f"... {len(found) - SHOWN} more"] * (len(found) > SHOWN))
            about = "; ".join(line for line in one.get("about", "").splitlines() if line)
            told[one["what"]].append(f"  {name}: {about}\n" + re.sub("^", "    ", shown, flags=re.M))
    for what, counts in total.items():
        say(f"{what}: {counts['compared']} in {counts['records']} records, {counts['differ']} records differ")
        for each in told[what][:SHOWN]:
            say(each)
        if len(told[what]) > SHOWN:
            say(f"  ... and {len(told[what]) - SHOWN} more")
    if met:
        say("met: " + ", ".join(f"{what} {times}" for what, times in met.most_common()))
    return sum(each["records"] for each in total.values()), sum(each["differ"] for each in total.values())


def _records(file: Path) -> dict[str, dict[str, Any]]:
    with file.open() as lines:
        return {record["name"]: record for record in map(json.loads, lines)}


@dataclass(frozen=True)
class Tree:
    """A tree that is imported as `wetdoublet` from a folder of links to its own folders."""

    name: str
    source: Path
    work: Path

    @classmethod
    def of(cls, name: str, given: str, work: Path) -> Tree:
        """The tree of a folder or a git revision, which is exported below `work`."""
        source, work = Path(given).resolve(), work / name
        package = work / "path" / "wetdoublet"
        package.mkdir(parents=True)
        if not source.is_dir():
            done = subprocess.run(["git", "-C", str(ROOT), "archive", given], capture_output=True)
            if done.returncode:
                raise SystemExit(f"{given}: neither a folder nor a git revision: {done.stderr.decode().strip()}")
            source = work / "tree"
            with tarfile.open(fileobj=io.BytesIO(done.stdout)) as archive:
                archive.extractall(source, filter="data")
        for folder in FOLDERS:
            if not (source / folder).is_dir():
                raise SystemExit(f"{given}: no tree: {source} has no folder {folder}/")
            (package / folder).symlink_to(source / folder)
        own = source / "solvers" / "package" / "__init__.py"
        # a package without __init__ would give way to one with it, wherever that is installed
        (package / "__init__.py").write_text(own.read_text() if own.is_file() else "")
        return cls(name, source, work)

    def run(self, kind: str, flags: str, options: argparse.Namespace) -> Path:
        """Let the worker answer; returns its file of JSON lines. SystemExit if it does not come to an end."""
        label = f"{kind}{'-shipped' if kind == 'kernels' and not flags else ''}"
        file, cache = self.work / f"{label}.jsonl", self.work / ("cache-off" if flags else "cache-shipped")
        (self.work / label).mkdir()
        environment = {key: value for key, value in os.environ.items() if not key.startswith("WETDOUBLET_")}
        environment |= {
            "PYTHONPATH": str(self.work / "path"), "XDG_CACHE_HOME": str(cache), "WETDOUBLET_CFLAGS": flags,
            "MPLBACKEND": "agg", "PYTHONHASHSEED": "0",
        }  # fmt: skip
        task = {"source": str(self.source), "kind": kind, "seed": options.seed, "quick": options.quick}
        task |= {"collisions": options.collisions, "conditioning": not flags and self.name == "before"}
        task |= {"exact": bool(flags), "file": str(file), "masked": [str(self.source), str(self.work)]}
        worker = Path(__file__).with_name("two_trees_worker.py")
        done = subprocess.run(
            [sys.executable, str(worker), json.dumps(task)],
            cwd=self.work / label, env=environment, capture_output=True, text=True,
        )  # fmt: skip
        if done.returncode:
            raise SystemExit(f"{self.name}, {label}: the worker ended with {done.returncode}:\n{done.stderr[-4000:]}")
        return file


def main() -> int:
    parser = argparse.ArgumentParser(description="Whether two trees of this repository compute the same.")
    parser.add_argument("before", metavar="BEFORE")
    parser.add_argument("after", metavar="AFTER")
    parser.add_argument("--collisions", type=int, help="by the kernel, and in proportion by other engines [2000]")
    parser.add_argument("--seed", type=int, default=13)
    parser.add_argument("--quick", action="store_true", help="200 collisions, and less of everything else")
    parser.add_argument("--only", default=",".join(KINDS), help="of " + ",".join(KINDS))
    parser.add_argument("--renamed", type=Path, help="file of lines `old text -> new text`")
    options = parser.parse_args()
    options.collisions = options.collisions or (200 if options.quick else 2000)
    kinds = options.only.split(",")
    for kind in kinds:
        if kind not in KINDS:
            parser.error(f"--only {kind}: one of {', '.join(KINDS)}")
    renamed = Renaming.read(options.renamed) if options.renamed else Renaming()
    jobs = [(kind, flags) for kind in kinds for flags in ((OFF, SHIPPED) if kind == "kernels" else (OFF,))]
    with tempfile.TemporaryDirectory(prefix="two-trees-") as folder, ThreadPoolExecutor(2) as pool:
        trees = [Tree.of(name, getattr(options, name), Path(folder)) for name in ("before", "after")]
        running = [[pool.submit(tree.run, kind, flags, options) for tree in trees] for kind, flags in jobs]
        counts = [compared(*(each.result() for each in pair), renamed) for pair in running]
    for words in renamed.words:
        _print(f"renamed {renamed.uses[' -> '.join(words)]} times: {' -> '.join(words)}")
    records, differ = (sum(each) for each in zip(*counts))
    _print(f"{records} records, {differ} differ" if differ else f"{records} records: the trees agree")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
