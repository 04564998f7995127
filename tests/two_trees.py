"""Whether two trees of this repository compute the same, bit for bit: run on one machine, in one go, nothing stored.

    python tests/two_trees.py BEFORE AFTER [--collisions N] [--seed S] [--quick] [--only KIND,...]

BEFORE and AFTER are git revisions or folders with derive/, generated/ and solvers/. Each tree runs in processes of its
own, with caches of its own, through the public interface (`two_trees_worker.py`), and compiles with -ffp-contract=off,
lest the compiler fuse products with sums as it likes. What it answers is compared:

* collisions: `collide` and `collide_many` by each engine, with ledger, events and trajectory;
* space: `collide_pair` on random vectors, and `collide` where solids chatter until they rest;
* gradients: `gradients_many`, `sensitivities`, `band`;
* boundaries: `boundary`, `boundary_sensitivities`, `atlas`, `regime_map`;
* commands: exit status, standard output, errors and files of every command but `bench`, which measures time.

Exit status: 0 if the trees agree, 1 if not, or if one of them cannot be run. The full run takes some ten minutes on two
quiet cores, --quick two to three.
"""

from __future__ import annotations

import argparse
import difflib
import io
import json
import os
import subprocess
import sys
import tarfile
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("derive", "generated", "solvers")
KINDS = ("collisions", "space", "gradients", "boundaries", "commands")
SHOWN = 4  # records of a kind that differ, and differences of a record, that are printed
_print = partial(print, flush=True)


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Path and value of everything below `value` that is neither a mapping nor a list; empty ones are themselves."""
    below = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    empty = True
    for key, each in below:
        empty = False
        yield from leaves(each, f"{path}/{key}")
    if empty:
        yield path, value


def differences(before: dict[str, Any], after: dict[str, Any]) -> Iterator[str]:
    """What differs between two records of the same name, a text each."""
    old, new = ({path: repr(each) for path, each in leaves(record["value"])} for record in (before, after))
    for path in {**old, **new}:
        if path not in old or path not in new:
            yield f"{path}: only {'before' if path in old else 'after'}"
        elif old[path] != new[path]:
            texts = [each.replace("\\n", "\n").splitlines() for each in (old[path], new[path])]
            if max(map(len, texts)) < 2:
                yield f"{path}: {old[path]:.200} before, {new[path]:.200} after"
            else:
                yield "\n".join([f"{path}:", *difflib.unified_diff(*texts, "before", "after", n=1, lineterm="")])


def compared(before: Path, after: Path, say: Any = _print) -> tuple[int, int]:
    """How many records two files of JSON lines have between them, and how many differ; tells of both, kind by kind."""
    old, new = _records(before), _records(after)
    total: dict[str, Counter[str]] = defaultdict(Counter)
    for name in {**old, **new}:
        one, both = old.get(name) or new[name], name in old and name in new
        found = [*differences(old[name], new[name])] if both else ["only " + ("before" if name in old else "after")]
        counts = total[one["what"]]
        counts.update(records=1, compared=one["count"], differ=int(bool(found)))
        if found and counts["differ"] <= SHOWN:
            say(f"  {name}: {' '.join(one.get('about', '').split())}")
            for each in found[:SHOWN]:
                say("    " + each.replace("\n", "\n    "))
    for what, counts in total.items():
        say(f"{what}: {counts['compared']} in {counts['records']} records, {counts['differ']} records differ")
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

    def run(self, kind: str, options: argparse.Namespace) -> Path:
        """Let the worker answer; returns its file of JSON lines. SystemExit if it does not come to an end."""
        file = self.work / f"{kind}.jsonl"
        (self.work / kind).mkdir()
        environment = {key: value for key, value in os.environ.items() if not key.startswith("WETDOUBLET_")}
        environment |= {
            "PYTHONPATH": str(self.work / "path"), "XDG_CACHE_HOME": str(self.work / "cache"),
            "WETDOUBLET_CFLAGS": "-ffp-contract=off", "MPLBACKEND": "agg", "PYTHONHASHSEED": "0",
        }  # fmt: skip
        task = {"source": str(self.source), "kind": kind, "seed": options.seed, "quick": options.quick}
        task |= {"collisions": options.collisions, "file": str(file), "masked": [str(self.source), str(self.work)]}
        worker = Path(__file__).with_name("two_trees_worker.py")
        done = subprocess.run(
            [sys.executable, str(worker), json.dumps(task)],
            cwd=self.work / kind, env=environment, capture_output=True, text=True,
        )  # fmt: skip
        if done.returncode:
            raise SystemExit(f"{self.name}, {kind}: the worker ended with {done.returncode}:\n{done.stderr[-4000:]}")
        return file


def main() -> int:
    parser = argparse.ArgumentParser(description="Whether two trees of this repository compute the same.")
    parser.add_argument("before", metavar="BEFORE")
    parser.add_argument("after", metavar="AFTER")
    parser.add_argument("--collisions", type=int, help="by each engine [1000]")
    parser.add_argument("--seed", type=int, default=13)
    parser.add_argument("--quick", action="store_true", help="100 collisions, and less of everything else")
    parser.add_argument("--only", default=",".join(KINDS), help="of " + ",".join(KINDS))
    options = parser.parse_args()
    options.collisions = options.collisions or (100 if options.quick else 1000)
    kinds = options.only.split(",")
    for kind in kinds:
        if kind not in KINDS:
            parser.error(f"--only {kind}: one of {', '.join(KINDS)}")
    with tempfile.TemporaryDirectory(prefix="two-trees-") as folder, ThreadPoolExecutor(2) as pool:
        trees = [Tree.of(name, getattr(options, name), Path(folder)) for name in ("before", "after")]
        running = [[pool.submit(tree.run, kind, options) for tree in trees] for kind in kinds]
        counts = [compared(*(each.result() for each in pair)) for pair in running]
    records, differ = (sum(each) for each in zip(*counts))
    _print(f"{records} records, {differ} differ" if differ else f"{records} records: the trees agree")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
