"""A batch of collisions by the Taylor kernel: columns of SI quantities in, columns of results out."""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache

import numpy as np

from ...generated import scaling
from ...generated.automaton import KINDS, LAST_ANSWER
from ..collision.outcome import absent_terms, open_beyond
from ..engines.taylor import call
from ..engines.taylor.call import run_kernel
from ..engines.taylor.layout import OWN_LEDGER, result
from ..model.model import load, select_model
from ..results import DEFINITIONS, LEDGER, NONE, RATES, REVERSALS, TERMS
from ..scene.entry_rules import FARTHEST
from ..scene.groups import AT_ANY_SPEED, formulas, gap_at_any_speed, never_touching
from ..scene.quantities import NO_GLASS
from ..scene.scene import Scene
from .impacts import Block, Impacts

_STRETCH = 16384  # collisions in one call of the kernel: some 4 MB of records; longer ones are no faster
_MOST = 1e30  # largest magnitude of an SI quantity; its inverse is the smallest
_NEVER = ("glass_transition_pressure", "youngs_modulus")  # set very large to disable a rebound criterion
_CODES = np.full(len(KINDS) + 1, NONE, dtype=np.int8)  # of reversals, by the number of the event; the last for none
_CODES[[KINDS.index(word) for word in REVERSALS]] = range(len(REVERSALS))
_NEAR = 1e-9  # relative distance to a limit of valid input below which the scene itself is validated


def collide_by_kernel(
    request: Impacts, which: np.ndarray | range, threads: int, finished: Callable[[np.ndarray, Block], None]
) -> np.ndarray:
    """Compute the collisions `which` of a batch; returns the indices of those that it does not complete.

    Arguments:
        finished: called with the indices and results of every finished block.
    """
    incomplete = [np.zeros(0, int)]
    ledger = any(name in LEDGER for name in request.of)
    jumps = min((DEFINITIONS[name].jumps for name in request.of if name in DEFINITIONS), default=2)
    for first in range(0, len(which), _STRETCH):
        stretch = which[first : first + _STRETCH]  # of a range: the indices of all are never in memory
        rows = np.arange(stretch.start, stretch.stop) if isinstance(stretch, range) else stretch
        whole = rows.size == request.size and bool((rows == np.arange(rows.size)).all())
        impacts, sound = impacts_of(request if whole else request.subset(rows))
        terms = np.zeros(impacts.size, OWN_LEDGER) if ledger else None
        answers = run_kernel(impacts, request.rtol, "rotation" in request.of, threads, jumps=jumps, ledgers=terms)
        decided = answers["status"] <= LAST_ANSWER
        if terms is not None:  # where the ledger is open the trajectory is wrong
            decided &= _closed(answers, terms, request.rtol)
        if rows.size == decided.size and decided.all():  # the usual case; avoids copies
            finished(rows, block_of(request.of, answers, impacts, terms))
            continue
        done = sound.copy()
        done[sound] = decided
        finished(
            rows[done],
            block_of(request.of, answers[decided], impacts.subset(decided), None if terms is None else terms[decided]),
        )
        incomplete.append(rows[~done])
    return np.concatenate(incomplete)


def impacts_of(request: Impacts) -> tuple[call.KernelImpacts, np.ndarray]:
    """The impacts of a batch in SI, and a mask of their collisions; the others need the scene's own validation."""
    scene = request.scene
    values: dict[str, np.ndarray] = {}
    with np.errstate(all="ignore"):  # overflow and NaN are excluded by the mask
        if request.vary:
            values = request.quantities
            sound = admissible(scene, values)
            unit = scaling.stokes(values["reduced_radius"], values["reduced_mass"], values["viscosity"], 1.0)
            for name, column in values.items():  # a column of one number, repeated, has no stride
                sound &= _usual(column if column.strides[0] else column[:1], 1e200 if name in _NEVER else _MOST)
        else:
            sound, unit = np.full(request.size, _usual_scene(scene)), scene.stokes_per_speed
        speed = request.speed if request.speed is not None else np.asarray(request.stokes) / unit
        sound &= _usual(speed, _MOST)
        sound &= _within_film(scene, {**(values or scene.material), "speed": speed})
    impacts = call.KernelImpacts(scene, speed, request.angle, values, request.small)
    return impacts if sound.all() else impacts.subset(np.flatnonzero(sound)), sound


def _usual(values: np.ndarray, most: float) -> np.ndarray:
    """Mask of values with which no dimensionless group overflows; others are left to `nondimensionalise`."""
    size = np.abs(values)
    return np.asarray((size == 0) | ((size >= 1 / _MOST) & (size <= most)))


@lru_cache(maxsize=64)
def _usual_scene(scene: Scene) -> bool:
    sizes = {name: abs(value) for name, value in scene.material.items()}
    return all(not size or 1 / _MOST <= size <= (1e200 if name in _NEVER else _MOST) for name, size in sizes.items())


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
    return sound & _within_film(scene, values)


def _within_film(scene: Scene, values: Mapping[str, np.ndarray | float]) -> np.ndarray | bool:
    """Mask of collisions whose declared criteria have gaps within the film, with a margin; all whose are not known."""
    sound: np.ndarray | bool = True
    for criterion in scene.package.criteria if scene.package is not None else ():
        formula, arguments = formulas(scene)[criterion.group]
        if all(map(values.__contains__, arguments)):
            gap = np.asarray(formula(*(values[name] for name in arguments)))
            sound &= (gap >= 0) & (gap < 1 - _NEAR)
    return sound


def block_of(
    of: Sequence[str], answers: np.ndarray, impacts: call.KernelImpacts, ledgers: np.ndarray | None = None
) -> Block:
    """Kernel records as the requested columns of a result."""
    separated = answers["outcome"] > 0
    exists = {
        "all": np.ones(separated.size, bool),
        "separated": separated,
        "sliding": separated & (impacts.angle > 0),
        "slipping": separated & impacts.oblique,
        "stick": ~separated,
    }
    block: Block = {
        "outcome": answers["outcome"].astype(np.int8),
        "certified": answers["certified"] != 0,
        "restitution": np.where(separated, answers["shown"][:, 0], 0.0),
    }
    length = impacts.others.get("film_thickness", impacts.scene.liquid.film_thickness)
    rates = rates_of(answers, impacts) if any(name in RATES for name in of) else {}
    terms = {} if ledgers is None else _ledger(ledgers, impacts)
    for name in of:
        row = DEFINITIONS.get(name)
        if name in terms:
            block[name] = terms[name]
        elif name == "reversal":
            block[name] = _CODES[answers["reversal"]]
        elif name not in block and row is not None and row.place is not None:
            values = rates[name] if row.scale == "rate" else result(answers, name)
            if row.scale in ("length", "time"):
                values = values * (length if row.scale == "length" else length / impacts.speed)
            block[name] = np.where(exists[row.exists], values, np.nan)
    return block


def rates_of(answers: np.ndarray, impacts: call.KernelImpacts) -> Block:
    """Spins and rotation rate at separation, rad/s; 0 head-on."""
    scene, unit = impacts.scene, impacts.rates
    rates = {name: result(answers, name) * unit for name in RATES}
    if "final_spin_partner" not in load(select_model(scene, True, fold=not impacts.others)).names("outputs"):
        none = np.full(unit.size, np.nan)
        rates["final_spin_partner"] = np.zeros(unit.size) if scene.wall else rates["final_spin"] if scene.pair else none
    return rates


def _ledger(ledgers: np.ndarray, impacts: call.KernelImpacts) -> Block:
    """The ledger in J, and the drift of the angular momentum; NaN where the scene has no such term."""
    scene, others = impacts.scene, impacts.others
    unit = np.asarray(others.get("reduced_mass", scene.reduced_mass)) * impacts.speed**2
    terms = {name: ledgers[column] * unit for name, column in TERMS.items()}
    terms |= {name: np.full(ledgers.size, 0.0 if name == "strings" else np.nan) for name in absent_terms(scene)}
    initial, final, *spent = terms.values()
    block = {f"energy.{name}": values for name, values in terms.items()}
    block["energy.residual"] = initial - final - sum(map(np.nan_to_num, spent))
    conserved = scene.pendulum is None and not scene.wall
    drift = np.abs(ledgers["momentum"] - 1.0) if conserved else np.nan
    block["angular_momentum_drift"] = np.where(impacts.oblique, drift, 0.0 if scene.pendulum is None else np.nan)
    return block


def _closed(answers: np.ndarray, ledgers: np.ndarray, rtol: float) -> np.ndarray:
    """Where the ledger is as closed as a tolerance leaves it, or the outcome is a stick."""
    terms = np.array([ledgers[name] for name in TERMS.values()])
    residual = np.abs(terms[0] - terms[1:].sum(axis=0))
    largest = np.maximum(np.abs(terms).max(axis=0), residual)
    return np.asarray((answers["outcome"] == 0) | (residual <= open_beyond(rtol) * largest))
