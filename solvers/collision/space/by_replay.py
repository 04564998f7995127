"""One pair in space by Rosenbrock or CVODES, in axes that go with the pair: the phases that the kernel has found.

CasADi's integrators measure errors by component, so the axes must not be the laboratory's: the first is the line of
centres, the second the fastest direction across it. A rotation of the whole pair then changes rounding only.
During the integration they turn about the angular momentum as a rigid doublet would (`model.phases`).
"""

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ....generated import scaling
from ....generated.automaton import LAST_ANSWER, LEAST_SLIP, OUTCOMES, TURNLESS
from ...engines.casadi.replay import Replay, Stopped, replayed
from ...engines.casadi.sequence import EventSequence, sequence
from ...engines.taylor.record import recorded_in_space
from ...engines.taylor.undecided import undecided
from ...errors import ComputationError, WetDoubletError
from ...model.dimensionless import Problem, nondimensionalise
from ...model.model import Model, load, select_model
from ..by_kernel import sequence_of, words_of
from .ends import FAILED, OPEN, Ends, is_open, of_replay
from .pairs import AXES, Bodies, Pairs, components, length, spin_energy, without_spins

EXTRAS = ("rotation",)
_LEAST = 1e-300  # in place of zero where it divides


def pairs_by_replay(pairs: Pairs, plugin: str, rtol: float, ledger: bool = False) -> Ends:
    """Ends of pairs integrated one after the other; a failed pair has the outcome FAILED and its reason."""
    ends = Ends.blank(pairs.size)
    for k in range(pairs.size):
        try:
            ends.put(np.array([k]), _end(pairs.subset(np.array([k])), plugin, rtol, ledger))
        except WetDoubletError as error:
            ends.outcome[k], ends.reason[k] = FAILED, str(error)
    return ends


def sequence_in_space(pair: Pairs, n: Problem, rtol: float) -> EventSequence:
    """The phases and events of one pair that turns, as the kernel finds them in the laboratory's axes."""
    model = load(select_model(pair.scene, True, space=True))
    answer, log = recorded_in_space(pair.impacts, rtol)
    if answer["status"] > LAST_ANSWER:
        raise n.in_si(undecided(answer, tuple(model.state), log[-1] if log.size else None))
    return sequence(answer, log, words_of(pair.scene), model, n.groups)


def own_axes(pair: Pairs) -> np.ndarray:
    """Axes of one pair at initial contact, as rows: normal, fastest direction across it, their cross product."""
    normal = pair.normal[0]
    radii = Bodies.of(pair.scene).radius
    speeds = [pair.distance * pair.turning[0], radii[0] * pair.spins[0, 0], radii[1] * pair.spins[0, 1]]
    across = np.array([speed - (speed @ normal) * normal for speed in speeds])
    sizes = length(across)
    second = across[int(np.argmax(sizes))]
    if not sizes.max() > TURNLESS * max(length(np.array(speeds)).max(), _LEAST):  # nothing turns n: any direction does
        second = np.eye(3)[int(np.argmin(np.abs(normal)))]
    second = second - (second @ normal) * normal
    second = second / np.sqrt(second @ second)
    return np.stack([normal, second, np.cross(normal, second)])


def groups_of(pair: Pairs, axes: np.ndarray) -> Problem:
    """The groups of one pair, with the components of vectors along these axes."""
    speed = -float(pair.opening[0])
    n = nondimensionalise(pair.scene, speed, 0.0)
    vectors = components(
        turning=axes @ pair.turning[0], spin=axes @ pair.spins[0, 0], partner_spin=axes @ pair.spins[0, 1]
    )
    quantities: dict[str, float] = {**pair.scene.material, "speed": speed}
    quantities |= {f"impact_{name}": float(value) for name, value in vectors.items()}

    def formula(name: str) -> float:
        return float(getattr(scaling, name)(*(quantities[argument] for argument in scaling.ARGUMENTS[name])))

    obliquity = quantities["obliquity"] = formula("obliquity_space")
    rate = formula("rate_scale_pair")
    first = {f"initial_{name}": float(value) / max(rate, _LEAST) for name, value in vectors.items()}
    groups: dict[str, Any] = {"obliquity": obliquity, **first, **components(initial_normal=axes @ pair.normal[0])}
    return replace(n, groups={**n.groups, **groups}, rate=rate)


def _end(pair: Pairs, plugin: str, rtol: float, ledger: bool) -> Ends:
    turns, axes = not pair.head_on[0], own_axes(pair)
    n = groups_of(pair, axes) if turns else nondimensionalise(without_spins(pair.scene), -float(pair.opening[0]), 0.0)
    record = partial(sequence_in_space, pair, n) if turns else partial(sequence_of, n)
    choice = select_model(pair.scene, turns, full=ledger, space=turns)
    model = load(choice)
    extras = (EXTRAS if turns else ()) + (model.names("energy_rates") if ledger else ())
    try:
        path, replay = replayed(record, choice, extras, plugin, rtol)
    except Stopped as stopped:
        raise n.in_si(stopped.error(plugin, model)) from None
    p, y = model.group_values(n.groups), replay.y
    outputs = model.values("outputs", y, p)
    ends = Ends.blank(1)
    ends.outcome[0], ends.certified[0] = OUTCOMES.index(path.outcome), path.certified
    ends.time[0], ends.gap[0] = replay.time * n.time, float(y[0]) * n.length
    ends.opening[0] = outputs["restitution"] * n.speed
    ends.normal[:], ends.turning[:], ends.spins[:] = pair.normal, 0.0, pair.spins
    if turns:
        axes = _turned_back(model, replay, p) @ axes
        names = ("final_normal", "final_rotation_rate", "final_spin", "final_spin_partner")
        vectors = [np.array([outputs[f"{name}_{axis}"] for axis in AXES]) @ axes for name in names]
        ends.normal[0], ends.turning[0], ends.spins[0] = vectors[0], vectors[1] * n.rate, np.array(vectors[2:]) * n.rate
    if turns and path.separated:
        first, last = (model.values("surface_slip", state, p)["surface_slip"] for state in (model.start(p), y))
        ends.slip[0] = last / first if first > LEAST_SLIP else np.nan
    if ledger:
        ends.energy[0] = n.energy * of_replay(model, replay, p)
        ends.energy[:, :2] += 0.0 if turns else spin_energy(pair, pair.spins)[0]
        if is_open(ends.energy, ends.outcome > FAILED, rtol)[0]:
            raise ComputationError(OPEN)
    return ends


def _turned_back(model: Model, replay: Replay, p: np.ndarray) -> np.ndarray:
    """The axes at the end of the integration, as rows, in components along those at its start (`model.phases`)."""
    parts = model.values("precession", replay.y, p)
    momentum = np.array([parts[f"momentum_{axis}"] for axis in AXES])
    angle = float(np.sqrt(momentum @ momentum)) * replay.extra(EXTRAS[0])
    if angle == 0.0:
        return np.eye(3)
    line = momentum / np.sqrt(momentum @ momentum)
    along = np.outer(line, line)
    turned = along + np.cos(angle) * (np.eye(3) - along) + np.sin(angle) * np.cross(line, np.eye(3)).T
    return np.asarray(turned.T)
