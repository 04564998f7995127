"""Bindings of other frameworks: their own gradient checkers on random scenes, and what a call costs beside the kernel.

python -m tests.benchmarks.frameworks [SCENES] [SEED]
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene, collide_many, gradients_many
from wetdoublet.solvers.engines.taylor.call import Impacts, run_kernel
from wetdoublet.solvers.formatting.markdown import table

from .near_presets import drawn_truth, window_of

RTOL = 1e-12
STEP, TOLERANCE = 1e-5, 1e-4
"""Relative step and tolerance of the checkers: differences have errors of RTOL over STEP times the conditioning, and of
STEP squared times the third derivative, which grows towards a change of outcome."""
CLEAR = 0.01
"""Cases keep their outcome within this of their speed and angle, relative, so that no difference crosses a change."""
SIZES = (1, 100, 10_000)


@dataclass(frozen=True)
class Case:
    """A collision that separates, on a scene some of whose entries are drawn."""

    scene: Scene
    entries: Mapping[str, float]
    speed: float
    angle: float

    def moved(self, law: Callable[..., Any]) -> Callable[[Any], Any]:
        """The restitution as a function of relative changes of speed, angle and entries, all near 0."""

        def restitution(theta: Any) -> Any:
            entries = {name: value * (1 + theta[2 + k]) for k, (name, value) in enumerate(self.entries.items())}
            return law(self.speed * (1 + theta[0]), self.angle * (1 + theta[1]), entries)

        return restitution


def cases(seed: int) -> Iterator[Case]:
    """Cases without end; a quarter of the impacts, at most, on one scene."""
    random = np.random.default_rng(seed)
    while True:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # outside the ranges of laws the derivatives have to be right, too
            preset, entries = drawn_truth(random, 4)
            scene = preset.with_si(entries)
            window = window_of(scene)
            if window is None:
                continue
            stokes = np.exp(random.uniform(*np.log(window), 32))
            angle = np.radians(random.uniform(5.0, 80.0, 32))
            factors = np.array([1.0, 1 - CLEAR, 1 + CLEAR])
            many = collide_many(
                scene,
                stokes=(factors[:, None, None] * stokes).repeat(3, axis=1).ravel(),
                angle=np.broadcast_to(factors[:, None] * angle, (3, 3, 32)).ravel(),
            )
        outcome = many["outcome"].values.reshape(9, 32)
        kept = np.flatnonzero((outcome[0] > 0) & (outcome == outcome[0]).all(axis=0))
        if kept.size:
            k = int(kept[0])
            yield Case(scene, entries, float(stokes[k] / scene.stokes_per_speed), float(angle[k]))


def check_by_jax(case: Case) -> None:
    """Both modes, by `jax.test_util.check_grads`; AssertionError where derivatives and differences are apart."""
    import jax
    from jax.test_util import check_grads
    from wetdoublet.solvers.bindings.jax import law

    jax.config.update("jax_enable_x64", True)
    at = np.zeros(2 + len(case.entries))
    check_grads(
        case.moved(law(case.scene, rtol=RTOL, undifferentiable="raise")), (at,), order=1, modes=("fwd", "rev"),
        eps=STEP, atol=TOLERANCE, rtol=TOLERANCE,
    )  # fmt: skip


def check_by_torch(case: Case) -> None:
    """Both modes, by `torch.autograd.gradcheck`."""
    import torch
    from wetdoublet.solvers.bindings.torch import law

    at = torch.zeros(2 + len(case.entries), dtype=torch.float64, requires_grad=True)
    torch.autograd.gradcheck(
        case.moved(law(case.scene, rtol=RTOL, undifferentiable="raise")), (at,), eps=STEP, atol=TOLERANCE,
        rtol=TOLERANCE, check_forward_ad=True,
    )  # fmt: skip


CHECKS = {"jax": check_by_jax, "torch": check_by_torch}


def checked(count: int, seed: int) -> dict[str, list[str]]:
    """Of each framework that is here, what its checker says of the cases that fail."""
    found: dict[str, list[str]] = {name: [] for name in CHECKS if find_spec(name)}
    for k, case in zip(range(count), cases(seed)):
        for name, failures in found.items():
            try:
                CHECKS[name](case)
            except Exception as error:  # noqa: BLE001 # of any kind: it is shown
                failures.append(f"case {k}, {case.scene.name}: {' '.join(str(error).split())[-300:]}")
    return found


def overhead() -> str:
    """A table: CPU time of a call over that of the kernel alone, by what is called and the number of collisions."""
    scene = Scene.load("granulation")
    rows: dict[str, list[str]] = {}
    for size in SIZES:
        speed, angle = np.linspace(3.0, 4.0, size), np.linspace(0.1, 0.4, size)
        best = {name: _cpu(run) for name, run in _calls(scene, speed, angle)}
        for name, (base, cpu) in ((name, (best[_base(name)], cpu)) for name, cpu in best.items()):
            rows.setdefault(name, []).append(f"{1e6 * cpu / size:.3g} us ({cpu / base:.3g})")
    head = ["CPU time of a collision (over the first line of its kind)", *(f"{size} in a call" for size in SIZES)]
    return table(head, [[name, *cells] for name, cells in rows.items()])


def _base(name: str) -> str:
    return "kernel alone" if not name.startswith("gradient") else "gradient, gradients_many"


def _calls(scene: Scene, speed: np.ndarray, angle: np.ndarray) -> Iterator[tuple[str, Callable[[], Any]]]:
    impacts, mu = Impacts(scene, speed, angle, {}), "liquid.viscosity"
    wrt = ["impact.speed", "impact.angle", mu]
    yield "kernel alone", lambda: run_kernel(impacts, 1e-9)
    yield "collide_many", lambda: collide_many(scene, speed=speed, angle=angle)
    yield ("gradient, gradients_many", lambda: gradients_many(scene, speed=speed, angle=angle, wrt=wrt, hold="speed"))
    if find_spec("jax"):
        import jax
        from wetdoublet.solvers.bindings.jax import law as for_jax

        jax.config.update("jax_enable_x64", True)
        by_jax = for_jax(scene)
        plain = jax.jit(by_jax)
        total = jax.jit(jax.grad(lambda v, a, m: by_jax(v, a, {mu: m}).sum(), (0, 1, 2)))
        yield "jax, jit", lambda: plain(speed, angle).block_until_ready()
        yield "gradient, jax, jit(grad)", lambda: total(speed, angle, 2.0)[2].block_until_ready()
    if find_spec("torch"):
        import torch
        from wetdoublet.solvers.bindings.torch import law as for_torch

        by_torch = for_torch(scene)
        tensors = [torch.tensor(each, dtype=torch.float64, requires_grad=True) for each in (speed, angle, 2.0)]
        yield "torch", lambda: by_torch(*(each.detach() for each in tensors[:2]))
        yield "gradient, torch", lambda: by_torch(*tensors[:2], {mu: tensors[2]}).sum().backward()


def _cpu(run: Callable[[], Any], seconds: float = 0.3) -> float:
    """CPU time of a call, s: the least of several means."""
    run()
    start = time.process_time()
    run()
    count = max(1, int(seconds / 5 / max(time.process_time() - start, 1e-7)))
    best = np.inf
    for _ in range(5):
        start = time.process_time()
        for _ in range(count):
            run()
        best = min(best, (time.process_time() - start) / count)
    return float(best)


def main(arguments: list[str]) -> int:
    """Print both; status 1 where a checker fails."""
    count, seed = (int(each) for each in (*arguments, *("200", "1")[len(arguments) :]))
    found = checked(count, seed)
    for name, failures in found.items():
        sys.stdout.write("\n".join([f"{name}: {count - len(failures)} of {count} scenes pass", *failures, ""]))
    sys.stdout.write(overhead() + "\n")
    return int(any(found.values()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
