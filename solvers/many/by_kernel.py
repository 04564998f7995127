"""A batch of collisions by the Taylor kernel: columns of SI quantities in, columns of results out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from ...generated import scaling
from ...generated.automaton import KINDS, LAST_ANSWER
from ..collision.outcome import open_beyond
from ..engines.taylor.call import Impacts, run_kernel
from ..engines.taylor.record import run_with_books
from ..errors import ComputationError
from ..model.model import load, select_model
from ..scene.contact import AT_ANY_SPEED, gap_at_any_speed, never_touching
from ..scene.entry_rules import FARTHEST
from ..scene.groups import formulas, rate_scales, si_values
from ..scene.quantities import NO_GLASS
from ..scene.scene import Scene
from .batch import Batch
from .columns import varied_columns
from .results import LEDGER as OF_LEDGER
from .results import NONE, RATES, REVERSALS, TIMES, Block

_STRETCH = 65536  # collisions in one call of the kernel, so that progress is reported and memory stays bounded
_MOST = 1e30  # largest magnitude of an SI quantity; its inverse is the smallest
_NEVER = ("glass_transition_pressure", "youngs_modulus")  # set very large to disable a rebound criterion
_TERMS = {
    "initial": "initial",
    "final": "final",
    "normal_lubrication": "normal",
    "tangential_lubrication": "tangential",
    "capillary": "capillary",
    "attraction": "attraction",
    "dry_contact": "dry",
    "dry_friction": "friction",
    "strings": "lifted",
}  # of the ledger, and the kernel's name for each
_CODES = np.full(len(KINDS) + 1, NONE, dtype=np.int8)  # of reversals, by the number of the event; the last for none
_CODES[[KINDS.index(word) for word in REVERSALS]] = range(len(REVERSALS))
_NEAR = 1e-9  # relative distance to a limit of valid input below which the scene itself is validated


def collide_by_kernel(
    request: Batch, which: np.ndarray, threads: int, finished: Callable[[np.ndarray, Block], None]
) -> np.ndarray:
    """Compute the collisions `which` of a batch; returns the indices of those that need another engine.

    Arguments:
        finished: called with the indices and results of every finished block.
    """
    left = [which[:0]]
    ledger = any(name in OF_LEDGER for name in request.of)
    jumps = 0 if any(name in TIMES for name in request.of) else 1 if "smallest_gap" in request.of else 2
    for first in range(0, which.size, _STRETCH):
        part = which[first : first + _STRETCH]
        whole = part.size == request.size and bool((part == np.arange(part.size)).all())
        impacts, sound = impacts_of(request if whole else request.part(part))
        books = None
        if ledger:
            both = run_with_books(impacts, request.rtol, threads)
            found, books = both if both is not None else (None, None)
        else:
            found = run_kernel(impacts, request.rtol, "rotation" in request.of, threads, jumps=jumps)
        if found is None:
            if request.whole:  # other chunks may have been computed by the kernel
                advice = 'look at what the compiler reports, or choose another engine, as "rosenbrock"'
                raise ComputationError("the kernel of this request cannot be compiled here", advice=advice)
            return which
        kept = found["status"] <= LAST_ANSWER
        if books is not None:  # where the ledger is open the trajectory is wrong
            kept &= _closed(found, books, request.rtol)
        if part.size == kept.size and kept.all():  # the usual case; avoids copies
            finished(part, block_of(request, found, impacts, books))
            continue
        done = sound.copy()
        done[sound] = kept
        finished(part[done], block_of(request, found[kept], impacts.part(kept), None if books is None else books[kept]))
        left.append(part[~done])
    return np.concatenate(left)


def impacts_of(request: Batch) -> tuple[Impacts, np.ndarray]:
    """The impacts of a batch in SI, and a mask of their collisions; the others need the scene's own validation."""
    scene = request.scene
    values: dict[str, np.ndarray] = {}
    with np.errstate(all="ignore"):  # overflow and NaN are excluded by the mask
        if request.vary:
            values = varied_columns(request)
            sound = admissible(scene, values)
            unit = scaling.stokes(values["reduced_radius"], values["reduced_mass"], values["viscosity"], 1.0)
        else:
            sound, unit = np.ones(request.size, bool), scene.stokes_per_speed
        speed = request.speed if request.speed is not None else np.asarray(request.stokes) / unit
        for name, column in (values or si_values(scene, None, None)).items():
            sound &= _usual(column, name)
        sound &= _usual(speed)
    impacts = Impacts(scene, speed, request.angle, values)
    return impacts if sound.all() else impacts.part(np.flatnonzero(sound)), sound


def _usual(values: np.ndarray | float, name: str = "") -> np.ndarray:
    """Mask of values with which no dimensionless group overflows; others are left to `nondimensionalise`."""
    size = np.abs(values)
    most = 1e200 if name in _NEVER else _MOST
    usual: np.ndarray = (size == 0) | ((size >= 1 / _MOST) & (size <= most))
    return usual


def admissible(scene: Scene, values: Mapping[str, np.ndarray]) -> np.ndarray:
    """Mask of collisions that satisfy `scene.entry_rules` with a margin; the scene itself validates the others."""
    film = values["film_thickness"]
    sound = np.ones(film.shape, bool)
    for word in AT_ANY_SPEED:
        sound &= gap_at_any_speed(word, values) < 1 - _NEAR
    rupture = film
    if scene.bridge is not None:
        formula, arguments = formulas(scene)["rupture_gap"]
        gap = np.asarray(formula(*(values[name] for name in arguments)))
        sound &= (gap > 1 + _NEAR) & np.isfinite(gap)
        rupture = gap * film
    if scene.pendulum is not None:
        sound &= values["string_length"] > (4 * values["reduced_radius"] + rupture / 2) * (1 + _NEAR)
    # attraction diverges at zero gap, and without glass criterion nothing stops the approach
    stopped = (scene.attraction is None) & (values["glass_transition_pressure"] < NO_GLASS)
    sound &= ~np.asarray(never_touching(values)) | stopped
    for ratio in ("radius_ratio", "mass_ratio"):
        if scene.partner is not None and ratio in values:
            sound &= (values[ratio] * FARTHEST > 1 + _NEAR) & (values[ratio] < FARTHEST * (1 - _NEAR))
    return sound


def block_of(request: Batch, found: np.ndarray, impacts: Impacts, books: np.ndarray | None) -> Block:
    """Kernel records as the requested columns of a result."""
    separated = found["outcome"] > 0

    def thickness() -> np.ndarray | float:
        return impacts.others.get("film_thickness", request.scene.liquid.film_thickness)

    def where(defined: np.ndarray, values: np.ndarray) -> np.ndarray:
        return np.where(defined, values, np.nan)

    columns: dict[str, Callable[[], np.ndarray]] = {
        "tangential_restitution": lambda: where(separated & (impacts.angle > 0), found["shown"][:, 1]),
        "slip_restitution": lambda: where(separated & impacts.oblique, found["slip"]),
        "contact_time": lambda: where(separated, found["time"] * (thickness() / impacts.speed)),
        "smallest_gap": lambda: where(separated, found["smallest_gap"] * thickness()),
        "rotation": lambda: where(separated, found["turned"]),
        "until": lambda: where(~separated, found["time"] * (thickness() / impacts.speed)),
        "reversal": lambda: _CODES[found["reversal"]],
        "steps": lambda: found["steps"].astype(float),
    }
    block: Block = {
        "outcome": found["outcome"].astype(np.int8),
        "certified": found["certified"] != 0,
        "restitution": np.where(separated, found["shown"][:, 0], 0.0),
    }
    if any(name in RATES for name in request.of):
        rates = _rates(request.scene, found, impacts)
        columns |= {name: partial(where, separated, column) for name, column in rates.items()}
    if books is not None:
        block |= {name: column for name, column in _ledger(request, books, impacts).items() if name in request.of}
    return block | {name: column() for name, column in columns.items() if name in request.of}


def _rates(scene: Scene, found: np.ndarray, impacts: Impacts) -> dict[str, np.ndarray]:
    """Spins and rotation rate at separation, rad/s; 0 head-on."""
    given = si_values(scene, None, None) | dict(impacts.others) | {"speed": impacts.speed, "angle": impacts.angle}
    unit = rate_scales(scene, given)
    names = load(select_model(scene, True, fold=not impacts.others)).names("outputs")
    shown = {name: found["shown"][:, k] * unit for k, name in enumerate(names) if name in RATES}
    none = np.full(unit.size, np.nan)
    partner = np.zeros(unit.size) if scene.wall else shown["final_spin"] if scene.pair else none
    return {"final_spin_partner": partner, "final_rotation_rate": none, **shown}


def _ledger(request: Batch, books: np.ndarray, impacts: Impacts) -> Block:
    """The ledger in J, and the drift of the angular momentum; NaN where the scene has no such term."""
    scene, others = request.scene, impacts.others
    unit = np.asarray(others.get("reduced_mass", scene.reduced_mass)) * impacts.speed**2
    smooth = scene.particles.friction is None
    absent = {"attraction": scene.attraction is None, "friction": smooth, "lifted": scene.pendulum is None}
    undefined = ("attraction", "dry_friction")
    terms = {
        name: np.full(books.size, np.nan if name in undefined else 0.0) if absent.get(own) else books[own] * unit
        for name, own in _TERMS.items()
    }
    spent = [np.nan_to_num(terms[name]) for name in list(_TERMS)[2:]]
    block = {f"energy.{name}": values for name, values in terms.items()}
    block["energy.residual"] = terms["initial"] - terms["final"] - sum(spent)
    kept = scene.pendulum is None and not scene.wall
    drift = np.abs(books["momentum"] - 1.0) if kept else np.nan
    block["angular_momentum_drift"] = np.where(impacts.oblique, drift, 0.0 if scene.pendulum is None else np.nan)
    return block


def _closed(found: np.ndarray, books: np.ndarray, rtol: float) -> np.ndarray:
    """Where the ledger is as closed as a tolerance leaves it, or the outcome is a stick."""
    terms = np.array([books[name] for name in _TERMS.values()])
    residual = np.abs(terms[0] - terms[1:].sum(axis=0))
    largest = np.maximum(np.abs(terms).max(axis=0), residual)
    closed: np.ndarray = (found["outcome"] == 0) | (residual <= open_beyond(rtol) * largest)
    return closed
