"""The kernel under AddressSanitizer and UndefinedBehaviorSanitizer, in a process with their library from the start."""

# ruff: noqa: T201 -- a script that prints
import json
import math
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import InputError, Scene, prove
from wetdoublet.solvers.engines.kernels import differentiates
from wetdoublet.solvers.engines.taylor.call import KernelImpacts, run_kernel
from wetdoublet.solvers.engines.taylor.record import run_recorded
from wetdoublet.solvers.engines.taylor.tangent import run_tangent
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.groups import si_values

# Compiled in a third of the time: checks are calls, and what AddressSanitizer sees anyway is not checked twice.
FLAGS = (
    "-O1 -fno-expensive-optimizations -fno-tree-pre -fno-gcse --param=asan-instrumentation-with-call-threshold=0 "
    "-fsanitize=address,undefined -fno-sanitize=null,object-size -fno-sanitize-recover=all "
    "-fno-inline -Dalways_inline="
)
RTOL = 1e-7
BUDGET = 3000  # steps: what creeps for longer shows nothing new
Replay = Callable[[KernelImpacts, bool], bool]  # False where there is no such kernel


def _recorded(**options: Any) -> Replay:
    return lambda impacts, oblique: run_recorded(impacts, oblique, RTOL, budget=BUDGET, **options) is not None


def _carried(backward: bool) -> Replay:
    def replay(impacts: KernelImpacts, oblique: bool) -> bool:
        if differentiates(impacts.scene, (oblique,)):
            run_tangent(impacts, oblique, RTOL, False, budget=BUDGET, backward=backward)
        return differentiates(impacts.scene, (oblique,))

    return replay


KINDS: dict[str, Replay] = {
    "plain": lambda impacts, _: run_kernel(impacts, RTOL, budget=BUDGET, jumps=2) is not None,
    "ledger and trajectory": _recorded(ledger=True, trajectory=True, room=(4, 4)),
    "steps not kept": _recorded(ledger=True, trajectory=True, keep=False, room=(1, 1)),
    "forwards": _carried(backward=False),
    "backwards": _carried(backward=True),
}


def random_impacts(scene: Scene, count: int, oblique: bool, seed: int) -> KernelImpacts:
    """Impacts whose every quantity is random about the scene's; one in fifty has a number that no scene may have."""
    draw = np.random.default_rng(seed)
    speed = scene.speed_of(1.0) * 10.0 ** draw.uniform(-3, 1.5, count)
    angle = np.radians(draw.uniform(0.01, 89.99, count)) if oblique else np.zeros(count)
    others = {
        name: value * 10.0 ** draw.uniform(-1, 1, count)
        for name, value in si_values(scene, None, None).items()
        if name not in ("speed", "angle") and value
    }
    for name in ("dry_restitution", "contact_tangential_restitution", "kept"):
        if name in others or name == "dry_restitution":
            others[name] = draw.uniform(0, 1, count)
    for name in ("impact_spin", "impact_partner_spin"):
        if name in others:
            others[name] = others[name] * draw.choice([-1.0, 0.0, 1.0], count)
    if "poisson_ratio" in others:
        others["poisson_ratio"] = draw.uniform(0, 0.5, count)
    columns = [speed, *others.values()]
    for k in np.flatnonzero(draw.uniform(size=count) < 0.02):
        columns[draw.integers(len(columns))][k] = draw.choice([0.0, -1.0, math.inf, math.nan, 1e308, 5e-324])
    return KernelImpacts(scene, speed, angle, others)


def replay(preset: str, kind: str, oblique: bool, count: int) -> bool:
    """Integrate random collisions of a preset, or of granulation with a model file; False if it has no such kernel."""
    scene = Scene.load("granulation", model=preset) if preset.endswith(".py") else Scene.load(preset)
    impacts = random_impacts(scene, count, oblique, seed=len(preset) + 7 * len(kind))
    return KINDS[kind](impacts, oblique)


def enclose_random(preset: str, count: int) -> None:
    """Prove random collisions and boxes of a preset, of speeds and angles that no particles have, too."""
    random = np.random.default_rng(count)
    extremes = [(1e-300, 1.0), (1e300, 0.5), (1e-8, 1.5707), (1e8, 1e-9)]
    speeds, angles = np.exp(random.uniform(np.log(1e-4), np.log(30), count)), random.uniform(0.01, 1.55, count)
    proved = 0
    for k, (stokes, angle) in enumerate([*extremes, *zip(speeds.tolist(), angles.tolist(), strict=True)]):
        within = None if k % 2 else float(10 ** random.uniform(-6, -1))
        with suppress(InputError):
            proved += bool(prove(preset, stokes=stokes, angle=angle, within=within))
    assert proved > count / 2


def process(what: list[Any], folder: Path) -> subprocess.CompletedProcess[str]:
    """Have a fresh process do it, with the sanitizers and a cache in this folder."""
    environment = os.environ | {
        "LD_PRELOAD": " ".join(libraries()), "ASAN_OPTIONS": "detect_leaks=0", "UBSAN_OPTIONS": "print_stacktrace=1",
        "WETDOUBLET_CFLAGS": FLAGS, "WETDOUBLET_CACHE": str(folder),
    }  # fmt: skip
    command = [sys.executable, __file__, json.dumps(what)]
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def libraries() -> list[str]:
    """The sanitizers' libraries; none where the compiler has not got them."""
    found = compiler()
    if found is None:
        return []
    names = ("libasan.so", "libubsan.so")
    asked = [
        subprocess.run([*found.command, f"-print-file-name={name}"], capture_output=True, text=True, check=False).stdout
        for name in names
    ]
    paths = [Path(said.strip()) for said in asked]
    return [str(path.resolve()) for path in paths] if all(path.is_absolute() for path in paths) else []


def _inside(what: list[Any]) -> None:
    os.environ.pop("LD_PRELOAD", None)  # the compiler is faster without
    missing: list[str] = []
    for name, *arguments in what:
        if name == "enclosed":
            enclose_random(*arguments)
        elif not replay(*arguments):
            missing.append(" ".join(map(str, arguments)))
    if missing:
        sys.exit(f"no kernel: {'; '.join(missing)}")
    print("done")


if __name__ == "__main__":
    _inside(json.loads(sys.argv[1]))
