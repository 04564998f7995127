"""Random collisions in space beside the independent reference of the tests.

    python -m tests.benchmarks.in_space [COUNT] [SEED] [MODELS]

COUNT (1000) random pairs of MODELS (20) structures and laws, 5 of each random scene in one call: spheres equal and
unequal, walls, films, attractions, any directions, spins up to five times the approach speed at the surface. By
`collide_pair` at rtol 1e-12 and by `tests/helpers/in_space.py`, in two processes. Prints the largest differences and
every disagreement with its scene; status 1 where there is one. What differs by more than 1e-8 is compared with the
reference's own change for a normal speed that differs by 1e-7: near a boundary no engine can do better. A pair for
which either takes too long is left out, and counted.
"""

from __future__ import annotations

import math
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from itertools import groupby
from multiprocessing import Pipe, Process
from multiprocessing.connection import Connection
from resource import RLIMIT_CPU, setrlimit
from types import FrameType

import numpy as np
from wetdoublet.solvers import Scene, collide_pair

from ..helpers.flow import Unfinished
from ..helpers.in_space import Arrival, Spatial, plus
from ..helpers.phases import Chatter, End
from ..helpers.random_in_space import arrivals, differences, quantities, request
from ..helpers.random_spinning import Model, numbers, tables
from ..helpers.random_spinning import models as drawn
from ..helpers.two_bodies import Bodies, bodies_of
from .verdicts import OUTCOMES, SAME, Verdict, summary

RTOL, STEP = 1e-12, 1e-7
OF_A_SCENE = 5
LONGEST = 4  # s of CPU time, for a scene's call or one pair of the reference
Found = dict[str, np.ndarray]


class OutOfTimeError(Exception):
    """It took too long."""


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Stop what takes longer; CasADi's integrators turn what interrupts them into a KeyboardInterrupt."""
    late = False

    def stop(_: int, __: FrameType | None) -> None:
        nonlocal late
        late = True
        raise OutOfTimeError

    signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    except KeyboardInterrupt:
        raise OutOfTimeError if late else KeyboardInterrupt from None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def followed(bodies: Bodies, arrival: Arrival) -> End | str:
    """The reference's end, or why it has none; in a process of its own, as an alarm inside scipy's DOP853 is lost."""
    ours, theirs = Pipe(duplex=False)
    child = Process(target=_follow, args=(theirs, bodies, arrival))
    child.start()
    theirs.close()
    try:
        return ours.recv()
    except EOFError:
        return OutOfTimeError.__name__
    finally:
        child.join()


def _follow(told: Connection, bodies: Bodies, arrival: Arrival) -> None:
    setrlimit(RLIMIT_CPU, (LONGEST, LONGEST))
    try:
        told.send(Spatial(bodies, arrival).run())
    except (Chatter, Unfinished) as error:
        told.send(type(error).__name__)


def faster(arrival: Arrival) -> Arrival:
    """The same with a normal speed that differs a little."""
    first, second = arrival.velocities
    return replace(arrival, velocities=(plus(first, STEP * arrival.speed, arrival.normal), second))


def judged(described: dict[str, object], arrival: Arrival, found: Found, outcome: str) -> Verdict:
    """The reference's answer beside the one found."""
    bodies = bodies_of(Scene.from_dict(described))
    end = followed(bodies, arrival)
    if isinstance(end, str):
        return Verdict(described, arrival, end, outcome, remark=str(found["reason"]))
    if end.outcome != outcome:
        return Verdict(described, arrival, end.outcome, outcome, remark=f"{end.events} {end.time} {found['reason']}")
    expected = quantities(bodies, arrival, end)
    apart, sharpest = differences(bodies, arrival, found, expected), SAME
    if max(apart.values(), default=0.0) > SAME:
        other = followed(bodies, faster(arrival))
        sharpest = math.inf
        if not isinstance(other, str) and (values := quantities(bodies, arrival, other)):
            sharpest = SAME * max(1.0, max(differences(bodies, arrival, values, expected).values()) / STEP)
    return Verdict(described, arrival, end.outcome, outcome, apart, sharpest)


def computed(scene: Scene, bodies: Bodies, arrived: list[Arrival]) -> list[tuple[Found, str]]:
    """What `collide_pair` says: all of them at once, each alone if one takes too long."""
    try:
        with within(LONGEST):
            data = collide_pair(scene, *request(bodies, arrived), rtol=RTOL, engine="taylor")
    except OutOfTimeError:
        if len(arrived) == 1:
            return [({"reason": np.array("")}, "OutOfTimeError")]
        return [one for each in arrived for one in computed(scene, bodies, [each])]
    words = ["not completed" if each < 0 else OUTCOMES[each] for each in data.outcome.values]
    return [({name: data[name].values[k] for name in data.data_vars}, word) for k, word in enumerate(words)]


def scenes(count: int, seed: int, of: int) -> Iterator[tuple[Model, dict[str, object], list[Arrival]]]:
    """Models one after another, their scenes, and arrivals at each."""
    every = drawn(min(of, count), seed)
    for k, model in enumerate(every):
        draw, left = np.random.default_rng((seed, 3, k)), count // len(every) + (k < count % len(every))
        kept = model
        while left:
            described = tables(kept, numbers(kept, draw))
            scene = Scene.from_dict(described)
            size = min(left, OF_A_SCENE)
            yield kept, described, arrivals(bodies_of(scene), scene.need_impact()[0], size, draw)
            left -= size


def compared(count: int, seed: int, of: int) -> Iterator[list[Verdict]]:
    """The comparisons of each model, in two processes (new ones: scipy's DOP853 loses memory by every call)."""
    for _, group in groupby(scenes(count, seed, of), key=lambda each: each[0]):
        jobs = []
        for _, described, arrived in group:
            scene = Scene.from_dict(described)
            found = computed(scene, bodies_of(scene), arrived)
            jobs += [(described, arrival, *one) for arrival, one in zip(arrived, found, strict=True)]
        with ProcessPoolExecutor(2) as pool:
            yield list(pool.map(judged, *zip(*jobs, strict=True), chunksize=4))


def main(count: int = 1000, seed: int = 16, of: int = 20) -> int:
    return summary(compared(count, seed, of), ("restitution", "time", "normal", "velocities", "spins"))


if __name__ == "__main__":
    sys.exit(main(*(int(each) for each in sys.argv[1:4])))
