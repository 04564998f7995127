"""The stress test: every engine on a quasi-random sample of the space of scenes, on all cores."""

import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from ...engines.taylor.build import compile_all
from ...engines.taylor.call import variant
from ...engines.taylor.source import Variant
from ...host.environment import environment
from ...host.progress import Progress
from ...host.workers import undisturbed, usable_cores, workers
from .judge import fast_kernel, judge
from .sample import SEED, sample
from .verdict import DISAGREEMENTS, RTOL, Case, Issue, Verdict

_LAST, _SMALL = 0.2, 4  # share of the cases that comes last, in blocks so small that the workers end together
_COSTS = {"sampled": 1, "lines": 3, "beside": 3}  # of a case, about
_ALONE = 40  # fewest cases for which starting workers pays


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
        return [(verdict, issue) for verdict in self.verdicts for issue in verdict.issues if issue.kind in kinds]

    @property
    def unexplained(self) -> list[tuple[Verdict, Issue]]:
        """Disagreements without an explanation; any of these makes the stress test fail."""
        return [(verdict, issue) for verdict, issue in self.issues(*DISAGREEMENTS) if not issue.explained]

    @property
    def interrupted(self) -> bool:
        return len(self.verdicts) < self.wanted

    @property
    def remarks(self) -> Counter[str]:
        """Number of scenes outside a law's range of validity, by law and entry."""
        return Counter(remark for verdict in self.verdicts for remark in verdict.remarks)

    def summary(self) -> str:
        """Summary in one line."""
        failed = self.issues("failure")
        strange = sum(not issue.explained for _, issue in failed)
        explained = len(self.issues(*DISAGREEMENTS)) - len(self.unexplained)
        lines = sum(len(verdict.case.angles) for verdict in self.verdicts)
        traced = f", {lines} lines of boundaries among them" if lines else ""
        scenes = f"{len(self.verdicts)} of {self.wanted}" if self.interrupted else f"{len(self.verdicts)}"
        return (
            f"stress: {scenes} scenes, {len(self.unexplained)} unexplained disagreements, "
            f"{explained} within the stated error of a boundary, {len(failed)} failures "
            f"({strange} without a physical reason){traced}, {self.wall:.0f} s"
        )


def stress(count: int, seed: int = SEED, tell: Progress = lambda _done, _total: None) -> Stress:
    """Run `count` cases on all cores.

    Arguments:
        tell: called with (done, total).
    """
    start, where = time.perf_counter(), environment()
    tell(0, count)
    cases = sample(count, seed)
    compile_all({_kernel_of(case) for case in cases})
    verdicts: dict[int, Verdict] = {}
    try:
        for block, judged in _judged(cases):
            verdicts.update(zip(block, judged, strict=True))
            tell(len(verdicts), count)
    except KeyboardInterrupt:
        if not verdicts:
            raise
    done = tuple(verdicts[k] for k in sorted(verdicts))
    return Stress(done, time.perf_counter() - start, where, len(cases))


def _kernel_of(case: Case) -> Variant:
    """The first kernel that a case needs."""
    if case.angles:
        return variant(case.scene, True, RTOL, trajectory=True, fold=False)
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
    """Blocks of cases, the most expensive first; those of one model go to one worker, which builds for them once."""
    alike: dict[Any, list[int]] = {}
    for k, case in enumerate(cases):
        alike.setdefault(_kernel_of(case), []).append(k)
    rest, blocks = len(cases), []
    for group in sorted(alike.values(), key=lambda group: -sum(_COSTS[cases[k].kind] for k in group)):
        size = len(group) if rest > _LAST * len(cases) else _SMALL
        blocks += [group[k : k + size] for k in range(0, len(group), size)]
        rest -= len(group)
    return blocks


def _block(cases: Sequence[Case]) -> list[Verdict]:
    return [judge(case) for case in cases]
