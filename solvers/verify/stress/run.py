"""The stress test: every engine on a quasi-random sample of the space of scenes, on all cores."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from ....generated.automaton import OUTCOMES
from ...engines.taylor.build import Variant, kernel
from ...engines.taylor.call import variant
from ...host.compiler import stop
from ...host.cores import usable_cores
from ...host.environment import environment
from ...host.workers import undisturbed, workers
from ...model.model import select_model
from .judge import SHARE, fast_kernel, judge, runs
from .sample import SEED, sample
from .verdict import FAST, RTOL, Case, Issue, Verdict

DISAGREEMENTS = ("outcome", "restitution", "spin", "side", "ledger", "drift", "certificate", "boundary")
_BLOCK = 12  # cases in a block for a worker
_ALONE = 40  # fewest cases for which starting workers pays
WORST = 20  # cases written as scene files, of each sort

Tell = Callable[[int, int], None]


@dataclass(frozen=True)
class Stress:
    """The result of a stress test.

    Arguments:
        verdicts: verdicts in the order of the sample, incomplete if interrupted.
        wall: wall-clock time, s.
        wanted: requested number of cases.
    """

    verdicts: tuple[Verdict, ...]
    wall: float
    where: dict[str, Any]
    wanted: int = 0

    def issues(self, *kinds: str) -> list[tuple[Verdict, Issue]]:
        """All issues of these kinds, with their cases."""
        return [(one, issue) for one in self.verdicts for issue in one.issues if issue.kind in kinds]

    @property
    def unexplained(self) -> list[tuple[Verdict, Issue]]:
        """Disagreements without an explanation; any of these makes the stress test fail."""
        return [(one, issue) for one, issue in self.issues(*DISAGREEMENTS) if not issue.explained]

    @property
    def interrupted(self) -> bool:
        return len(self.verdicts) < self.wanted

    @property
    def remarks(self) -> Counter[str]:
        """Number of scenes outside a law's range of validity, by law and entry."""
        return Counter(remark for one in self.verdicts for remark in one.remarks)

    def summary(self) -> str:
        """Summary in one line."""
        failed = self.issues("failure")
        strange = sum(not issue.explained for _, issue in failed)
        explained = len(self.issues(*DISAGREEMENTS)) - len(self.unexplained)
        lines = sum(len(one.case.angles) for one in self.verdicts)
        traced = f", {lines} lines of boundaries among them" if lines else ""
        scenes = f"{len(self.verdicts)} of {self.wanted}" if self.interrupted else f"{len(self.verdicts)}"
        return (
            f"stress: {scenes} scenes, {len(self.unexplained)} unexplained disagreements, "
            f"{explained} within the stated error of a boundary, {len(failed)} failures "
            f"({strange} without a physical reason){traced}, {self.wall:.0f} s"
        )


def stress(count: int, seed: int = SEED, tell: Tell = lambda _done, _total: None) -> Stress:
    """Run `count` cases on all cores.

    Arguments:
        tell: called with (done, total).

    Raises:
        InputError: scipy, which provides the quasi-random sequence, is not installed.
    """
    start, where = time.perf_counter(), environment()
    tell(0, count)
    cases = _prepared(count, seed)
    verdicts: dict[int, Verdict] = {}
    try:
        for block, found in _judged(cases):
            verdicts.update(zip(block, found, strict=True))
            tell(len(verdicts), count)
    except KeyboardInterrupt:
        if not verdicts:
            raise
    done = tuple(verdicts[k] for k in sorted(verdicts))
    return Stress(done, time.perf_counter() - start, where, len(cases))


def _prepared(count: int, seed: int) -> list[Case]:
    """The sample, with its kernels compiled once each while boundaries are traced."""
    threads: list[int] = []  # they suffice, as compilers are separate processes
    compiling = ThreadPoolExecutor(usable_cores(), initializer=lambda: threads.append(threading.get_ident()))

    def compile_for(cases: Sequence[Case]) -> None:
        if FAST == "taylor":
            for wanted in dict.fromkeys(_kernel_of(case) for case in cases):
                compiling.submit(kernel, wanted)

    try:
        cases = sample(count, seed, compile_for)
        compile_for(cases)
    except BaseException:
        compiling.shutdown(wait=False, cancel_futures=True)
        stop(threads)
        raise
    compiling.shutdown()
    return cases


def _kernel_of(case: Case) -> Variant:
    """The first kernel that a case needs."""
    if case.angles:
        return variant(case.scene, select_model(case.scene, True), RTOL, True, trajectory=True)
    return fast_kernel(case.scene)


def _judged(cases: Sequence[Case]) -> Iterator[tuple[list[int], list[Verdict]]]:
    """Indices of blocks of cases and their verdicts, in the order in which they finish."""
    blocks = _blocks(cases)
    cores = usable_cores()
    if len(cases) < _ALONE or cores == 1:
        for block in blocks:
            yield block, _block([cases[k] for k in block])
        return
    from concurrent.futures import as_completed

    alone = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}  # numpy's threads would compete with the workers
    with workers(cores, alone) as pool:
        with undisturbed():
            waiting = {pool.submit(_block, [cases[k] for k in block]): block for block in blocks}
        for future in as_completed(waiting):
            yield waiting.pop(future), future.result()


def _blocks(cases: Sequence[Case]) -> list[list[int]]:
    """Blocks of cases; those with one structure and laws go to one worker, which builds and compiles for them once."""
    alike: dict[Any, list[int]] = {}
    for k, case in enumerate(cases):
        alike.setdefault(fast_kernel(case.scene), []).append(k)
    return [group[k : k + _BLOCK] for group in alike.values() for k in range(0, len(group), _BLOCK)]


def _block(cases: Sequence[Case]) -> list[Verdict]:
    return [judge(case) for case in cases]


def record(found: Stress) -> dict[str, Any]:
    """Content of `stress.json`."""
    return {
        "environment": found.where,
        "settings": {"seed": SEED, "rtol": RTOL, "share": SHARE, "engines": list(runs()), "fast": FAST},
        "summary": found.summary(),
        "outside_of_ranges": dict(found.remarks),
        "outcomes": {name: sum(_outcome(one) == name for one in found.verdicts) for name in OUTCOMES},
        "cases": [_case(one) for one in found.verdicts],
        "wall": found.wall,
    }


def _outcome(one: Verdict) -> str:
    return next((each.outcome for each in one.found.values() if each.outcome), "")


def _case(one: Verdict) -> dict[str, Any]:
    return {
        "name": one.case.name,
        "kind": one.case.kind,
        "distance": one.case.distance,
        "change": one.case.change,
        "scene": one.case.scene.to_dict() if one.issues else None,  # the others can be reproduced from seed and number
        "stokes": one.case.scene.stokes,
        "angle": one.case.scene.angle,
        "angles": list(one.case.angles),
        "outcome": _outcome(one),
        "error": one.error,
        "conditioning": one.conditioning if one.conditioning != float("inf") else None,
        "found": {
            name: {"outcome": each.outcome, "restitution": each.restitution, "certified": each.certified,
                   "failure": each.failure, "cpu": each.cpu, **each.more}
            for name, each in one.found.items()
        },
        "issues": [
            {"kind": issue.kind, "between": list(issue.between), "said": issue.said, "explained": issue.explained}
            for issue in one.issues
        ],
    }  # fmt: skip
