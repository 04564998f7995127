"""Pairs by the Taylor kernel: in their plane where they have one, else with vectors."""

import numpy as np

from ....generated.automaton import LAST_ANSWER, TURNLESS, Status
from ...engines.taylor.call import KernelImpacts, run_kernel
from ...engines.taylor.layout import OWN_LEDGER
from ...engines.taylor.undecided import undecided
from ...model.dimensionless import nondimensionalise
from ...model.model import load, select_model
from .ends import FAILED, OPEN, Ends, is_open, of_kernel
from .pairs import Bodies, Pairs, dot, length, spin_energy, without_spins


def planes(pairs: Pairs) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which pairs move in a plane: all rotation is along one direction across the line of centres.

    Returns:
        The mask, that direction (zero of a head-on pair), and turning and spins along it (pairs, 3).
    """
    radii = np.array(Bodies.of(pairs.scene).radius)
    speeds = np.concatenate([pairs.sliding[:, None], radii[:, None] * pairs.spins], axis=1)
    sizes = length(speeds)
    largest = np.max(sizes, axis=1)
    turned = np.concatenate([pairs.turning[:, None], pairs.spins], axis=1)
    rows = np.arange(pairs.size)
    chosen = np.where(sizes[:, 0] > TURNLESS * largest, 0, 1 + np.argmax(sizes[:, 1:], axis=1))
    axis = turned[rows, chosen]
    axis = axis - dot(axis, pairs.normal) * pairs.normal
    with np.errstate(all="ignore"):
        axis = np.where(pairs.head_on[:, None], 0.0, axis / length(axis)[:, None])
    along = np.einsum("ikj,ij->ik", turned, axis)
    rest = turned - along[:, :, None] * axis[:, None]
    rest[:, 1:] *= radii[:, None]
    rest[:, 0] *= pairs.distance
    size = np.maximum(largest, np.max(np.abs(pairs.velocities), axis=(1, 2)))
    return pairs.head_on | np.all(length(rest) <= TURNLESS * size[:, None], axis=1), axis, along


def by_kernel(pairs: Pairs, rtol: float, threads: int, ledger: bool = False) -> Ends:
    """Ends of the pairs; one that is not decided has the outcome FAILED and its reason."""
    ends = Ends.blank(pairs.size)
    planar, axis, along = planes(pairs)
    if (which := np.flatnonzero(planar)).size:
        ends.put(which, _in_planes(pairs.subset(which), axis[which], along[which], rtol, threads, ledger))
    if (which := np.flatnonzero(~planar)).size:
        ends.put(which, _in_space(pairs.subset(which), rtol, threads, ledger))
    if ledger:  # where it is open the trajectory is wrong
        wrong = is_open(ends.energy, ends.outcome > FAILED, rtol)
        ends.outcome[wrong], ends.reason[wrong] = FAILED, OPEN
    return ends


def _in_space(pairs: Pairs, rtol: float, threads: int, ledger: bool) -> Ends:
    ledgers = np.zeros(pairs.size, OWN_LEDGER) if ledger else None
    answers = run_kernel(pairs.impacts, rtol, False, threads, ledgers=ledgers)
    states = load(select_model(pairs.scene, True, full=ledger, space=True)).state
    ends = _of_answers(pairs, answers, ledgers, tuple(states))
    mask = answers["status"] == Status.DECIDED
    names = load(select_model(pairs.scene, True, space=True)).names("outputs")
    place = {name: k for k, name in enumerate(names)}
    rate = pairs.impacts.rates

    def vector(name: str) -> np.ndarray:
        first = place[f"{name}_x"]
        spins: np.ndarray = answers["shown"][:, first : first + 3]
        return spins

    ends.normal[mask] = vector("final_normal")[mask]
    ends.turning[mask] = (vector("final_rotation_rate") * rate[:, None])[mask]
    for k, name in enumerate(("final_spin", "final_spin_partner")):
        ends.spins[mask, k] = (vector(name) * rate[:, None])[mask]
    ends.opening[mask] = (-pairs.opening * answers["shown"][:, place["restitution"]])[mask]
    return ends


def _in_planes(pairs: Pairs, axis: np.ndarray, along: np.ndarray, rtol: float, threads: int, ledger: bool) -> Ends:
    """By the planar kernel; what rounding leaves of the spins out of the plane stays as it is."""
    same = pairs.scene.partner is None and bool(np.all(along[:, 1] == along[:, 2]))
    scene = without_spins(pairs.scene, own_spins=not same)
    contact = pairs.distance - float(scene.material["film_thickness"])
    angle = np.arctan2(contact * np.abs(along[:, 0]), -pairs.opening)
    sense = np.where(along[:, 0] < 0, -1.0, 1.0)  # the angle is not negative
    others = {"impact_spin": sense * along[:, 1], "impact_partner_spin": sense * along[:, 2]}
    impacts = KernelImpacts(scene, -pairs.opening, angle, others)
    ledgers = np.zeros(pairs.size, OWN_LEDGER) if ledger else None
    answers = run_kernel(impacts, rtol, True, threads, ledgers=ledgers)
    states = load(select_model(scene, not bool(pairs.head_on.all()), full=ledger)).state
    ends = _of_answers(pairs, answers, ledgers, tuple(states))
    mask = answers["status"] == Status.DECIDED
    rest = pairs.spins - along[:, 1:, None] * axis[:, None]
    axis, rate, oblique = sense[:, None] * axis, impacts.rates, impacts.oblique
    ends.slip[:] = np.where(oblique, np.abs(ends.slip), np.nan)  # a ratio of lengths, as in space
    outputs = {name: answers["shown"][:, k] for k, name in enumerate(load(select_model(scene, True)).names("outputs"))}
    moved = {
        name: np.where(oblique, values * rate, 0.0) for name, values in outputs.items() if name.startswith("final")
    }
    moved.setdefault("final_spin_partner", moved["final_spin"])
    turned = np.where(mask, answers["turned"], 0.0)[:, None]
    across = np.cross(axis, pairs.normal)
    ends.normal = np.cos(turned) * pairs.normal + np.sin(turned) * across
    ends.opening[mask] = (-pairs.opening * answers["shown"][:, 0])[mask]
    ends.turning = moved["final_rotation_rate"][:, None] * axis
    ends.energy[:, :2] += spin_energy(pairs, rest)[:, None]
    for k, name in enumerate(("final_spin", "final_spin_partner")):
        ends.spins[:, k] = moved[name][:, None] * axis + rest[:, k]
    return ends


def _of_answers(pairs: Pairs, answers: np.ndarray, ledgers: np.ndarray | None, states: tuple[str, ...]) -> Ends:
    """Ends from the answers of any structure, whose model has these states."""
    ends = Ends.blank(pairs.size)
    touch = answers["status"] == Status.PROVED_AT_TOUCH
    thickness = float(pairs.scene.material["film_thickness"])
    ends.outcome[:] = answers["outcome"]
    ends.certified[:] = answers["certified"] != 0
    ends.time[:] = np.where(touch, 0.0, answers["time"] * thickness / -pairs.opening)
    ends.gap[:] = answers["final_gap"] * thickness
    ends.slip[:] = np.where(answers["outcome"] > 0, answers["slip"], np.nan)
    for k in np.flatnonzero(answers["status"] > LAST_ANSWER):
        n = nondimensionalise(without_spins(pairs.scene), -float(pairs.opening[k]), 0.0)
        ends.outcome[k], ends.reason[k] = FAILED, str(n.in_si(undecided(answers[k], states)))
    if ledgers is not None:
        ends.energy[:] = of_kernel(ledgers) * (float(pairs.scene.material["reduced_mass"]) * pairs.opening**2)[:, None]
    return ends
