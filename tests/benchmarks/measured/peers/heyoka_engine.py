"""Collisions by heyoka's Taylor integrator, in SIMD batches with a queue, from the same emitted equations.

What a practised user of heyoka would do: one adaptive batch integrator whose lanes run on their own (film and freezing
are runtime parameters), groups that are the same for all collisions written in as numbers, terminal events with
callbacks that reverse, refill a finished lane from the queue, and go on; one call of `propagate_until` for all of it.
The level that proves a stick is an event of the energy; it is computed beforehand, at no cost to heyoka.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec, module_from_spec
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
from wetdoublet.solvers.model.key import ModelKey
from wetdoublet.solvers.scene.scene import Scene

from ..tasks import Impact, dimensionless
from .automaton import CERTIFIED, Automaton, automata
from .heyoka_callbacks import Inside

HORIZON = 1e10  # x0/v0: a trajectory that has not ended by then has failed
STEPS = 2000  # of a collision, on average, after which all are given up
_NEVER = -1e4  # a level of energy that is not reached
BATCH = 8
_GENERATED = "wetdoublet.generated"
_FUNCTIONS = ("exp", "log", "sqrt", "sin", "cos", "tan", "atan", "fmax", "fmin")


def translated(choice: ModelKey) -> tuple[ModuleType, Any]:
    """The structure module of a choice in heyoka's expressions, and its laws as attributes by slot."""
    laws = {slot: _copy(f"laws.{slot}_{law.replace('-', '_')}") for slot, law in choice.laws}
    return _copy(choice.structure), SimpleNamespace(**laws)


def _copy(name: str) -> ModuleType:
    spec = find_spec(f"{_GENERATED}.{name}")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    for word in _FUNCTIONS:
        if hasattr(module, word):
            setattr(module, word, elementary(word))
    return module


def elementary(name: str) -> Callable[..., Any]:
    """An elementary function of numbers and of heyoka's expressions."""
    import heyoka

    def expression(value: Any) -> Any:
        return value if isinstance(value, heyoka.expression) else heyoka.expression(float(value))

    if name in ("fmax", "fmin"):  # of expressions by selection, which heyoka expands as a series too
        first = heyoka.gt if name == "fmax" else heyoka.lt
        return lambda x, y: heyoka.select(first(expression(x), expression(y)), expression(x), expression(y))
    of_expression, of_number = getattr(heyoka, name), getattr(math, name)
    return lambda x: of_expression(x) if isinstance(x, heyoka.expression) else of_number(x)


@dataclass(frozen=True)
class System:
    """A structure in heyoka's expressions.

    Arguments:
        rates: of the states, then of the capillary work where it is needed for the energy.
        events: by name; `film_edge` may cross either way, the others fall through zero. Whether a doublet turned or
            fell back decides nothing here.
        varying: groups that are runtime parameters, in their order; then film, active and level.
    """

    rates: list[tuple[Any, Any]]
    events: dict[str, Any]
    varying: tuple[str, ...]


def system(choice: ModelKey, groups: Sequence[Mapping[str, float]], proved: str) -> System:
    """The equations of these collisions; what is the same for all of them is written in."""
    import heyoka

    structure, laws = translated(choice)
    varying = tuple(name for name in structure.GROUPS if len({each[name] for each in groups}) > 1)
    known = {name: float(groups[0][name]) for name in structure.GROUPS if name not in varying}
    p = known | {name: heyoka.par[k] for k, name in enumerate(varying)}
    film, active, level = (heyoka.par[len(varying) + k] for k in range(3))
    y = {name: heyoka.make_vars(name) for name in structure.STATES}
    rates = [(y[name], active * rate) for name, rate in structure.right_hand_side(y, p, laws, film, 1).items()]
    found = structure.events(y, p, laws)
    bridge = choice.law("bridge") is not None
    events = {name: found[name] for name in ("glass", "half_turn", "unwinding") if name in found}
    if p.get("elastic_gap") != 0.0:
        events["elastic"] = found["elastic"]
    events["rough"] = found["rough"]
    events["rupture"] = found["rupture"]
    if bridge:
        events["film_edge"] = found["film_edge"]
    if proved == "energy":
        energy = sum(structure.energies(y, p, laws).values())
        if bridge:
            work = heyoka.make_vars("capillary")
            rate = structure.energy_rates(y, p, laws, film, 1)["capillary"]
            rates.append((work, active * rate))
            energy = energy + work
        events[CERTIFIED] = energy - level
    return System(rates, events, varying)


@dataclass
class Lane:
    """Which collision a lane is on, and whether a criterion has been met."""

    collision: int = -1
    reversed: bool = False


@dataclass
class Start:
    """Where a collision starts, decided by rule, and its parameters."""

    state: np.ndarray
    parameters: np.ndarray
    reversed: bool
    automaton: Automaton


@dataclass
class Batch:
    """An integrator with its queue. `run` returns outcome, e_n for each collision; NaN where it failed.

    Arguments:
        dry: restitution of the dry contact.
    """

    integrator: Any = None
    starts: list[Start] = field(default_factory=list)
    dry: float = 1.0
    film: int = 0
    lanes: list[Lane] = field(default_factory=list)
    queue: Any = None
    left: int = 0
    outcomes: list[str] = field(default_factory=list)
    restitutions: list[float] = field(default_factory=list)

    def build(self, equations: System, rtol: float, watch: Inside | None) -> None:
        """Compile the integrator; `watch` takes the time within callbacks."""
        import heyoka

        either, falling = heyoka.event_direction.any, heyoka.event_direction.negative
        self.lanes = [Lane() for _ in range(BATCH)]
        first = self.starts[0]
        self.integrator = heyoka.taylor_adaptive_batch(
            equations.rates,
            state=np.repeat(first.state[:, None], BATCH, axis=1),
            pars=np.repeat(first.parameters[:, None], BATCH, axis=1),
            t_events=[
                heyoka.t_event_batch(
                    guard,
                    callback=watch.watched(self.callback(name)) if watch else self.callback(name),
                    direction=either if name == "film_edge" else falling,
                )
                for name, guard in equations.events.items()
            ],
            tol=rtol,
            compact_mode=False,
            force_avx512=True,
            fast_math=True,
        )

    def run(self) -> None:
        """All collisions, once."""
        ta, count = self.integrator, len(self.starts)
        size = len(self.lanes)
        self.outcomes, self.restitutions = [""] * count, [math.nan] * count
        self.queue, self.left = iter(range(count)), count
        ta.set_time(0.0)
        for lane in range(size):
            ta.reset_cooldowns(lane)
            ta.state[:, lane], ta.pars[:, lane] = self.starts[0].state, self.starts[0].parameters
            self._next(lane)
        ta.propagate_until(np.full(size, HORIZON), max_steps=STEPS * (1 + count // size))

    def _next(self, lane: int) -> bool:
        """Give a lane its next collision; freeze it if there is none. True while any lane is at work."""
        ta = self.integrator
        k = next(self.queue, None)
        if k is None:
            ta.pars[self.film + 1, lane] = 0.0
            return self.left > 0
        start = self.starts[k]
        ta.state[:, lane] = start.state
        ta.pars[:, lane] = start.parameters
        self.lanes[lane] = Lane(k, start.reversed)
        return True

    def _proved(self, lane: int) -> bool:
        return self.starts[self.lanes[lane].collision].automaton.sticks(self.integrator.state[:, lane].copy())

    def ended(self, lane: int, separated: bool) -> bool:
        """Record how a collision ended and take the next."""
        now = self.lanes[lane]
        self.left -= 1
        if separated:
            self.outcomes[now.collision] = "bounce" if now.reversed else "stick-rotate-separate"
            self.restitutions[now.collision] = float(self.integrator.state[1, lane])
        else:
            self.outcomes[now.collision], self.restitutions[now.collision] = "stick", 0.0
        return self._next(lane)

    def callback(self, event: str) -> Callable[[Any, int, int], bool]:
        """What heyoka calls when an event happens in a lane; False ends the whole batch."""

        def rebounds(ta: Any, _: int, lane: int) -> bool:
            ta.state[1, lane] *= -self.dry
            self.lanes[lane].reversed = True
            # the loss may jump over the level, which then is no crossing
            return self.ended(lane, False) if self._proved(lane) else True

        def edge(ta: Any, _: int, lane: int) -> bool:
            ta.pars[self.film, lane] = 1.0 if ta.state[1, lane] < 0 else 0.0
            return True

        if event in ("glass", "elastic", "rough"):
            return rebounds
        if event == "film_edge":
            return edge
        separated = event == "rupture"
        return lambda _ta, _sign, lane: self.ended(lane, separated)


def starts(followed: Sequence[Automaton], varying: Sequence[str]) -> list[Start]:
    """State and parameters at initial contact; one that meets a criterion there rebounds there.

    Parameters are the groups named, then film, active and level.
    """
    begun = []
    for automaton in followed:
        if word := automaton.criterion():
            automaton.rebound(word)
        level, film = automaton.level(automaton.y), float(automaton.phase.film)
        parameters = [*(automaton.groups[name] for name in varying), film, 1.0, _NEVER if level is None else level]
        begun.append(Start(automaton.y, np.array(parameters), automaton.reversed, automaton))
    return begun


def collisions(scene: Scene, impacts: Sequence[Impact], rtol: float, watch: Inside | None = None) -> Batch:
    """An integrator for a scene's impacts, compiled, with its queue.

    Arguments:
        watch: takes the time within callbacks.

    ComputationError as of `automata`.
    """
    numbers = [dimensionless(scene, impact) for impact in impacts]
    followed = automata(numbers, rtol)
    proved = followed[0].proof
    equations = system(followed[0].model.choice, [each.groups for each in numbers], proved)
    batch = Batch(dry=numbers[0].groups["dry_restitution"], film=len(equations.varying))
    batch.starts = starts(followed, equations.varying)
    if not proved:  # heyoka wants no parameter that is not used
        for start in batch.starts:
            start.parameters = start.parameters[:-1]
    batch.build(equations, rtol, watch)
    return batch
