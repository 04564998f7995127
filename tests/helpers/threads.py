"""Every public function from several threads at once, beside the same calls in one thread.

    python -X faulthandler tests/helpers/threads.py THREADS

Threads start together in a cold process, each at another place of the list of calls, and go round it together; then one
thread makes the same calls. What it gives, every thread must have given, to the last bit; exit status 1 if one has not,
or fails.
"""

# ruff: noqa: T201 -- a script that prints
import hashlib
import io
import math
import sys
import threading
import warnings
from collections import defaultdict
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from wetdoublet import solvers
from wetdoublet.solvers import Scene, boundary, collide, collide_many, gradients_many, regime_map, sensitivities
from wetdoublet.solvers.engines.casadi.integrators import IntegrationFailed, Tolerance, plain
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Flow, Phase

GRANULATION, PENDULUM = "granulation", "pendulum"
IMPACT: dict[str, Any] = {"stokes": 0.05, "angle": "60 deg"}
MANY = {"stokes": np.geomspace(0.01, 0.3, 300), "angle": np.linspace(0.0, 1.4, 300)}
FEW = {"stokes": np.geomspace(0.02, 0.3, 6), "angle": 0.9}
WRT = ("liquid.viscosity", "bridge.volume", "impact.angle")
SCENE = Path(solvers.__file__).parent / "scene" / "presets" / "pendulum.toml"


def _png(figure: Any) -> bytes:
    into = io.BytesIO()
    figure.savefig(into, format="png", dpi=50)
    return into.getvalue()


def _traced(**options: Any) -> Any:
    return boundary(GRANULATION, angle=np.array([0.6, 0.9]), rtol=1e-8, **options)


def _mapped(**options: Any) -> xr.Dataset:
    return regime_map(GRANULATION, stokes=np.geomspace(0.01, 0.3, 12), angle=np.linspace(0.2, 1.3, 10), **options)


def _failing() -> str:
    """An integrator that cannot: what CasADi prints of it, from whichever thread, is nobody's business."""
    choice = select_model(Scene.load(GRANULATION), oblique=True)
    integrate = plain(Flow(choice, Phase(1, 1, 0)), "cvodes", Tolerance(1e-9, 1e-12))
    try:
        integrate(np.full(len(load(choice).state), math.nan), np.ones(len(load(choice).groups)), 1.0)
    except IntegrationFailed as error:
        return str(error)
    return "done"


def _refused() -> str:
    try:
        Scene.load(GRANULATION).with_entries({"liquid.viscosity": "2 furlongs"})
    except solvers.InputError as error:
        return str(error)
    return "accepted"


def _remarked() -> str:
    with_remark = Scene.load(GRANULATION).with_entries({"bridge.law": "willett", "bridge.volume": 0.5})
    return " ".join(collide(with_remark, **IMPACT).validity)


def _varied() -> Scene:
    return Scene.load(GRANULATION).with_entries({"liquid.viscosity": "3 Pa s", "particles.reduced_radius": "0.06 mm"})


CALLS: dict[str, Callable[[], Any]] = {
    "collide by cvodes": lambda: collide(GRANULATION, **IMPACT),
    "collide by rosenbrock": lambda: collide(GRANULATION, engine="rosenbrock", trajectory=True, **IMPACT),
    "collide by taylor": lambda: collide(GRANULATION, engine="taylor", trajectory=True, **IMPACT),
    "collide on strings": lambda: collide(PENDULUM, stokes=1.3, angle="45 deg"),
    "collide, drawn": lambda: _png(collide(GRANULATION, trajectory=True, **IMPACT).plot()),
    "a scene from a file": lambda: Scene.load(SCENE).to_toml(),
    "a scene with units": lambda: _varied().to_dict(),
    "a refused unit": _refused,
    "a remark": _remarked,
    "an integration that fails": _failing,
    "few by rosenbrock": lambda: collide_many(GRANULATION, engine="rosenbrock", **FEW),
    "many by taylor": lambda: collide_many(GRANULATION, of=("rotation", "contact_time"), **MANY),
    "a map": _mapped,
    "boundary": _traced,
    "sensitivities": lambda: sensitivities(GRANULATION, wrt=WRT, engine="rosenbrock", **IMPACT),
    "gradients": lambda: gradients_many(GRANULATION, wrt=WRT, engine="taylor", stokes=MANY["stokes"], angle=0.9),
}


def _digest(found: Any) -> str:
    """What a result says, to the last bit."""
    if isinstance(found, np.ndarray):
        return _digest(found.tolist())
    if isinstance(found, xr.Dataset):
        return _digest({name: found[name].values for name in found.variables} | {"attrs": found.attrs})
    if isinstance(found, Mapping):
        return _digest([*found.items()])
    if isinstance(found, (list, tuple)) and not all(isinstance(each, (str, float, int)) for each in found):
        return _digest(" ".join(map(_digest, found)))
    if hasattr(found, "to_dict"):
        return _digest([found.to_dict(), getattr(found, "trajectory", None)])
    return hashlib.sha256(repr(found).encode()).hexdigest()


def together(calls: Mapping[str, Callable[[], Any]], count: int) -> dict[str, dict[str, int]]:
    """What the calls gave in so many threads: by name, how often each digest; a failure is its message."""
    found: dict[str, dict[str, int]] = defaultdict(lambda: defaultdict(int))
    names, guard, ready = list(calls), threading.Lock(), threading.Barrier(count)

    def go(own: int) -> None:
        ready.wait()
        share = -(-len(names) // count)
        for name in names[own * share : (own + 1) * share]:
            try:
                said = _digest(calls[name]())
            except Exception as error:  # noqa: BLE001 # counted, and told
                said = f"{type(error).__name__}: {error}"
            with guard:
                found[name][said] += 1

    threads = [threading.Thread(target=go, args=(own,)) for own in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return found


def main(count: int) -> int:
    warnings.simplefilter("ignore", solvers.ModelWarning)
    calls = {name: call for name, call in CALLS.items() if compiler() is not None or "taylor" not in name}
    before = sys.stderr
    found, wrong = together(calls, count), 0
    for name, said in found.items():
        good = set(said) == {_digest(calls[name]())}
        wrong += not good
        print("ok   " if good else "WRONG", name, sum(said.values()))
        for each in [] if good else said:
            print("     ", each[:300])
    if sys.stderr is not before:
        print("WRONG sys.stderr is not what it was")
        wrong += 1
    print(f"{sum(sum(said.values()) for said in found.values())} calls of {len(found)} kinds, {wrong} wrong")
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1])))
