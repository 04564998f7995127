"""A sphere and a wall: the line of centres does not turn, so the planar kernel gives the motion in space exactly.

The normal motion does not depend on the tangential one. Friction is linear in sliding and rolling and the same in every
direction along the wall, so both components of these vectors go through one linear map. Two planar collisions with the
same normal motion give it: one that slides, and one that slides and spins. Spin along the normal stays as it is.

Energies are quadratic in both vectors: for a ledger two more collisions, of which one only spins, give their
coefficients.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from ....generated.automaton import LAST_ANSWER, OUTCOMES, STICK
from ...engines.casadi.replay import Replay, Stopped, replayed
from ...engines.casadi.sequence import EventSequence
from ...engines.taylor.call import KernelImpacts, run_kernel
from ...engines.taylor.layout import OWN_LEDGER
from ...engines.taylor.undecided import undecided
from ...errors import WetDoubletError
from ...model.dimensionless import Problem, nondimensionalise
from ...model.model import Model, load, select_model
from ..by_kernel import followed, sequence_of
from ..by_replay import confirmed
from .ends import FAILED, OPEN, TERMS, TRANSVERSE, Ends, is_open, of_kernel, of_replay
from .pairs import Pairs, dot, length

_SLIDES = np.pi / 4  # slides as fast as it approaches
_BEYOND = 1 + 1e-6  # times that of a decision: a contact there is then behind all motions, by every engine


@dataclass
class Planar:
    """Planar collisions with a wall; lengths over x0, times over x0/v0, speeds over v0, energies over m v0^2."""

    outcome: np.ndarray
    certified: np.ndarray
    reason: np.ndarray
    time: np.ndarray
    gap: np.ndarray
    opening: np.ndarray
    slide: np.ndarray
    roll: np.ndarray
    energy: np.ndarray


def _by_kernel(impacts: KernelImpacts, rtol: float, threads: int, ledger: bool) -> Planar:
    """Planar collisions by the kernel."""
    ledgers = np.zeros(impacts.size, OWN_LEDGER) if ledger else None
    answers = run_kernel(impacts, rtol, False, threads, ledgers=ledgers)
    terms = np.full((answers.size, len(TERMS)), np.nan) if ledgers is None else of_kernel(ledgers)
    opening, slide, _, roll = answers["shown"].T[:4]
    outcome, certified = answers["outcome"].astype(int), answers["certified"] != 0
    reason = np.full(answers.size, "", object)
    states = tuple(load(select_model(impacts.scene, True, full=ledger)).state)
    for k in np.flatnonzero(answers["status"] > LAST_ANSWER):
        n = impacts.problem(int(k))
        outcome[k], reason[k] = FAILED, str(n.in_si(undecided(answers[k], states)))
    return Planar(outcome, certified, reason, answers["time"], answers["final_gap"], opening, slide, roll, terms)


def _by_replay(impacts: KernelImpacts, plugin: str, rtol: float, ledger: bool) -> Planar:
    """Planar collisions by Rosenbrock or CVODES, one after the other."""
    size = impacts.size
    time, gap, opening, slide, roll = (np.full(size, np.nan) for _ in range(5))
    outcome, reason = np.full(size, FAILED), np.full(size, "", object)
    terms = np.full((size, len(TERMS)), np.nan)
    result = Planar(outcome, np.zeros(size, bool), reason, time, gap, opening, slide, roll, terms)
    for k in range(size):
        try:
            path, replay, model, p = _replayed(_problem(impacts, k), plugin, rtol, ledger)
        except WetDoubletError as error:
            result.reason[k] = str(error)
            if confirmed(_problem(impacts, k), rtol, plugin):
                for name, values in vars(_by_kernel(impacts.subset(slice(k, k + 1)), rtol, 1, ledger)).items():
                    getattr(result, name)[k] = values[0]
            continue
        outputs = model.values("outputs", replay.y, p)
        outcome[k], result.certified[k] = OUTCOMES.index(path.outcome), path.certified
        time[k], gap[k], opening[k] = replay.time, float(replay.y[0]), outputs["restitution"]
        slide[k], roll[k] = outputs["tangential_restitution"], outputs["final_spin"]
        if ledger:
            terms[k] = of_replay(model, replay, p)
    return result


def _problem(impacts: KernelImpacts, k: int) -> Problem:
    scene = impacts.scene.with_entries({"impact.spin": float(impacts.others["impact_spin"][k])})
    return nondimensionalise(scene, float(impacts.speed[k]), float(impacts.angle[k]))


def _replayed(
    n: Problem, plugin: str, rtol: float, ledger: bool, until: float | None = None
) -> tuple[EventSequence, Replay, Model, np.ndarray]:
    """One planar collision by Rosenbrock or CVODES; `until` (s) as for `followed`."""
    model = load(select_model(n.scene, True, full=ledger))
    extras = model.names("energy_rates") if ledger else ()
    try:
        path, replay = replayed(partial(sequence_of, n, until=until), model.choice, extras, plugin, rtol)
    except Stopped as stopped:
        raise n.in_si(stopped.error(plugin, model)) from None
    return path, replay, model, model.group_values(n.groups)


def _terms_at(n: Problem, engine: str, rtol: float, until: float) -> np.ndarray:
    """The terms of a stick's ledger at a time, s."""
    if engine != "taylor":
        try:
            _, replay, model, p = _replayed(n, engine, rtol, True, until)
            return of_replay(model, replay, p)
        except WetDoubletError:
            if not confirmed(n, rtol, engine, until):
                raise
    account = followed(n, rtol, until, ledger=True).ledger
    assert account is not None  # requested
    terms: np.ndarray = of_kernel(account)[0]
    return terms


def beside_wall(pairs: Pairs, engine: str, rtol: float, threads: int, ledger: bool = False) -> Ends:
    """Ends of collisions with a wall; one that is not decided has the outcome FAILED and its reason."""
    radius = float(pairs.scene.material["reduced_radius"])
    speed = -pairs.opening

    def collided(angle: float, spinning: float) -> Planar:
        spin = {"impact_spin": spinning * speed / radius}
        impacts = KernelImpacts(pairs.scene, speed, np.full(pairs.size, angle), spin)
        planar.append(impacts)
        if engine == "taylor":
            return _by_kernel(impacts, rtol, threads, ledger)
        return _by_replay(impacts, engine, rtol, ledger)

    planar: list[KernelImpacts] = []
    cases = ((_SLIDES, 0.0), (_SLIDES, 1.0), (0.0, 1.0), (_SLIDES, -1.0))[: 4 if ledger else 2]
    parts = [collided(*case) for case in cases]
    slides, both = parts[:2]
    # sliding is that of the sphere along the wall; rolling turns it about normal x sliding
    sliding = -pairs.sliding
    rolling = radius * np.cross(pairs.normal, pairs.spins[:, 0])
    ends = Ends.blank(pairs.size)
    for name in ("outcome", "certified", "reason"):
        getattr(ends, name)[:] = getattr(slides, name)
    for motion in parts[1:]:  # of one that has spent its steps the others are not known
        lost = (ends.outcome != FAILED) & (motion.outcome == FAILED)
        ends.outcome[lost], ends.certified[lost], ends.reason[lost] = FAILED, False, motion.reason[lost]
    thickness = float(pairs.scene.material["film_thickness"])
    ends.time[:] = slides.time * thickness / speed
    ends.gap[:] = slides.gap * thickness
    ends.opening[:] = speed * slides.opening
    ends.normal[:] = pairs.normal
    ends.turning[:] = 0.0
    alone = slides.slide[:, None], slides.roll[:, None]
    more = (both.slide - slides.slide)[:, None], (both.roll - slides.roll)[:, None]
    later = [value * sliding + other * rolling for value, other in zip(alone, more, strict=True)]
    ends.sliding[:] = later[0]
    twist = dot(pairs.spins[:, 0], pairs.normal) * pairs.normal
    ends.spins[:, 0] = np.cross(later[1], pairs.normal) / radius + twist
    first, last = length(sliding - rolling), length(later[0] - later[1])
    with np.errstate(all="ignore"):
        ends.slip[:] = np.where((first > 0) & (ends.outcome > 0), last / first, np.nan)
    if ledger:
        for k in np.flatnonzero(ends.outcome == OUTCOMES.index(STICK)):  # each was decided at a time of its own
            ends.time[k] = _BEYOND * max(motion.time[k] for motion in parts) * thickness / speed[k]
            for motion, impacts in zip(parts, planar, strict=True):
                try:
                    motion.energy[k] = _terms_at(_problem(impacts, int(k)), engine, rtol, float(ends.time[k]))
                except WetDoubletError as error:
                    ends.outcome[k], ends.certified[k], ends.reason[k] = FAILED, False, str(error)
        ends.energy[:] = _energies(pairs, sliding, rolling, [motion.energy for motion in parts])
        wrong = is_open(ends.energy, ends.outcome > FAILED, rtol)
        ends.outcome[wrong], ends.reason[wrong] = FAILED, OPEN
    return ends


def _energies(pairs: Pairs, sliding: np.ndarray, rolling: np.ndarray, planar: list[np.ndarray]) -> np.ndarray:
    """The ledger, J: quadratic forms in sliding and rolling, which collisions with unit vectors determine.

    Arguments:
        planar: terms of one that slides, one with both, one that spins, and one with both against each other.
    """
    slides, both, spins, against = (terms[:, TRANSVERSE] for terms in planar)
    along = slides + spins - (both + against) / 2  # the normal motion's
    forms = slides - along, spins - along, (both - against) / 2
    mass, speed = float(pairs.scene.material["reduced_mass"]), -pairs.opening[:, None]
    squares = dot(sliding, sliding), dot(rolling, rolling), dot(sliding, rolling)
    energies: np.ndarray = planar[0] * mass * speed**2
    across = sum(form * square for form, square in zip(forms, squares, strict=True))
    energies[:, TRANSVERSE] = mass * (along * speed**2 + across)
    twist = dot(pairs.spins[:, 0], pairs.normal)
    radius = float(pairs.scene.material["reduced_radius"])
    energies[:, TRANSVERSE[:2]] += 0.2 * mass * radius**2 * twist**2
    return energies
