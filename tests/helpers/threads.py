"""Public functions from several threads at once, beside the same calls in one thread.

    python -X faulthandler tests/helpers/threads.py [SECONDS] [THREADS]

Threads start together in a cold process, each at another place of the list of calls, and go round it until the time is
over; then one thread makes the same calls, once each. What it gives, every thread must have given, to the last bit;
exit status 1 if one has not, or fails.
"""

# ruff: noqa: T201 -- a script that prints
import io
import math
import sys
import threading
import time
import warnings
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from wetdoublet import solvers
from wetdoublet.solvers import Scene, boundary, collide, collide_many, gradients_many, regime_map, sensitivities
from wetdoublet.solvers.engines.casadi.integrators import IntegrationFailed, Tolerance, plain
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Flow, Region

GRANULATION = "granulation"
IMPACT: dict[str, Any] = {"stokes": 0.05, "angle": "60 deg"}
MANY = {"stokes": np.geomspace(0.01, 0.3, 300), "angle": np.linspace(0.0, 1.4, 300)}
WRT = ("liquid.viscosity", "bridge.volume", "impact.angle")
FILE = Path(solvers.__file__).parent / "scene" / "presets" / "pendulum.toml"
VARIED = {"liquid.viscosity": "3 Pa s", "particles.reduced_radius": "0.06 mm"}


def _png(figure: Any) -> bytes:
    into = io.BytesIO()
    figure.savefig(into, format="png", dpi=50)
    return into.getvalue()


def _refused() -> Any:
    try:
        return Scene.load(GRANULATION).with_entries({"liquid.viscosity": "2 furlongs"})
    except solvers.InputError as error:
        return str(error)


def _failing() -> str:
    """An integrator that cannot: what CasADi prints of it, from whichever thread, is nobody's business."""
    choice = select_model(Scene.load(GRANULATION), oblique=True)
    integrate = plain(Flow(choice, Region(1, 1, False)), "cvodes", Tolerance(1e-9, 1e-12))
    try:
        integrate(np.full(len(load(choice).state), math.nan), np.ones(len(load(choice).groups)), 1.0)
    except IntegrationFailed as error:
        return str(error)
    return "done"


CALLS: dict[str, Callable[[], Any]] = {
    "collide by cvodes": lambda: collide(GRANULATION, engine="cvodes", **IMPACT),
    "collide by rosenbrock": lambda: collide(GRANULATION, engine="rosenbrock", trajectory=True, **IMPACT),
    "collide by the kernel": lambda: collide(GRANULATION, **IMPACT),
    "collide on strings": lambda: collide("pendulum", stokes=1.3, angle="45 deg"),
    "collide, drawn": lambda: _png(collide(GRANULATION, trajectory=True, **IMPACT).plot()),
    "a scene from a file": lambda: Scene.load(FILE).to_toml(),
    "a scene with units": lambda: Scene.load(GRANULATION).with_entries(VARIED).to_dict(),
    "a refused unit": _refused,
    "an integration that fails": _failing,
    "many": lambda: collide_many(GRANULATION, of=("rotation", "contact_time"), **MANY),
    "a map": lambda: regime_map(GRANULATION, stokes=np.geomspace(0.01, 0.3, 12), angle=np.linspace(0.2, 1.3, 10)),
    "boundary": lambda: boundary(GRANULATION, angle=np.array([0.6, 0.9])),
    "sensitivities": lambda: sensitivities(GRANULATION, wrt=WRT, engine="rosenbrock", **IMPACT),
    "gradients": lambda: gradients_many(GRANULATION, wrt=WRT, stokes=MANY["stokes"], angle=0.9),
}


def _said(found: Any) -> str:
    """What a result says, to the last bit."""
    if isinstance(found, xr.Dataset):
        found = {str(name): found[name].values.tolist() for name in found.variables} | {"attrs": found.attrs}
    if hasattr(found, "to_dict"):
        trajectory = getattr(found, "trajectory", None)
        found = found.to_dict(), None if trajectory is None else _said(trajectory)
    return repr(found)


def main(seconds: float = 60.0, count: float = 8) -> int:
    warnings.simplefilter("ignore", solvers.ModelWarning)
    found: dict[str, set[str]] = defaultdict(set)
    names, ready, before, threads = list(CALLS), threading.Barrier(int(count)), sys.stderr, int(count)
    end = time.monotonic() + seconds

    def go(own: int) -> None:
        ready.wait()
        done = 0
        while time.monotonic() < end or done < len(names) / threads:  # together at least once round
            name = names[(own * len(names) // threads + done) % len(names)]
            try:
                found[name].add(_said(CALLS[name]()))
            except Exception as error:  # noqa: BLE001 # told
                found[name].add(f"{type(error).__name__}: {error}")
            done += 1

    running = [threading.Thread(target=go, args=(own,)) for own in range(threads)]
    for thread in running:
        thread.start()
    for thread in running:
        thread.join()
    wrong = {name: said for name, said in found.items() if said != {_said(CALLS[name]())}}
    for name, said in wrong.items():
        print("WRONG", name, *(each[:300] for each in said), sep="\n     ")
    return int(bool(wrong) or len(found) < len(names) or sys.stderr is not before)


if __name__ == "__main__":
    sys.exit(main(*map(float, sys.argv[1:])))
