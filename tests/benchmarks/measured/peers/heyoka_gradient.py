"""Derivatives of e_n by heyoka's variational equations, in SIMD batches with a queue, from the same emitted equations.

What a practised user would do: `var_ode_sys` of first order in the groups that the rates depend on, and in two initial
values. The columns of these obey the homogeneous equations, so that they can carry what an event alone depends on: they
are zero up to a reversal, and hold from there the derivatives in the criterion's own group and in the dry restitution.
heyoka knows no jump of derivatives at an event: the saltation is a compiled function (`cfunc`) of the emitted event and
reversal. Last, all collisions land on the rupture together, and one product with the derivatives of
the groups leads to the parameters.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from wetdoublet.generated.automaton import CRITERIA
from wetdoublet.solvers.model.dimensionless import Problem
from wetdoublet.solvers.model.key import ModelKey

from .automaton import Automaton, automata
from .heyoka_callbacks import Inside
from .heyoka_engine import Batch, Start, as_expression, elementary, translated

_OWN_GROUP = {"glass": "glass_number", "elastic": "elastic_gap", "rough": "rough_gap"}
_JUMP_ONLY = (*_OWN_GROUP.values(), "dry_restitution", "rupture_gap")
_CARRIERS = ("gap", "normal_velocity")  # initial values whose columns carry what only events depend on


@dataclass(frozen=True)
class Variational:
    """A structure with its first variation, in heyoka's expressions.

    Arguments:
        rates: of the states.
        events: by name, each positive before it.
        groups: runtime parameters, in their order; then film and active.
        smooth: groups that the rates depend on: the first columns. Two more follow, for the criterion and for the dry
            restitution.
        jumps: by criterion, the state and its columns behind the reversal as a compiled function of those before it.
        begin: the state and its columns at initial contact; with `rebound`, after a rebound there.
        end: e_n's derivatives in the columns and in the rupture gap, of the state and its columns at the rupture.
    """

    rates: list[tuple[Any, Any]]
    events: dict[str, Any]
    groups: tuple[str, ...]
    smooth: tuple[str, ...]
    jumps: dict[str, Any]
    begin: dict[bool, Any]
    end: Any

    @property
    def columns(self) -> int:
        return len(self.smooth) + 2


def variational(choice: ModelKey, criteria: Sequence[str]) -> Variational:
    """The equations of a structure with all its groups as parameters.

    Arguments:
        criteria: those that can be met.
    """
    import heyoka

    structure, laws = translated(choice, elementary)
    names = tuple(structure.GROUPS)
    groups = {name: heyoka.par[k] for k, name in enumerate(names)}
    film, active = heyoka.par[len(names)], heyoka.par[len(names) + 1]
    y = {name: heyoka.make_vars(name) for name in structure.STATES}
    flow = structure.right_hand_side(y, groups, laws, film, 1)
    table = structure.events(y, groups, laws)
    bridge = choice.law("bridge") is not None
    wanted = (*criteria, "half_turn", "unwinding", "rupture", *(("film_edge",) if bridge else ()))
    events = {name: table[name] for name in wanted if name in table}
    smooth = tuple(name for name in names if name not in _JUMP_ONLY)
    jump = _Jump(structure, laws, y, groups, film, flow, smooth)
    return Variational(
        [(y[name], active * rate) for name, rate in flow.items()],
        events,
        names,
        smooth,
        {name: jump.reversal(name, table[name]) for name in criteria},
        {after: jump.start(after) for after in (False, True)},
        jump.rupture(table["rupture"], "rupture_gap" in names),
    )


@dataclass
class _Jump:
    """What events do to a state and its columns, as compiled functions of (state, columns by rows; parameters)."""

    structure: Any
    laws: Any
    y: dict[str, Any]
    groups: dict[str, Any]
    film: Any
    flow: dict[str, Any]
    smooth: tuple[str, ...]

    def _columns(self) -> dict[str, list[Any]]:
        import heyoka

        count = len(self.smooth) + 2
        return {name: [heyoka.make_vars(f"{name}_{k}") for k in range(count)] for name in self.y}

    def _compiled(self, outputs: Sequence[Any]) -> Any:
        import heyoka

        given = [*self.y.values(), *(each for row in self._columns().values() for each in row)]
        return heyoka.cfunc([as_expression(each) for each in outputs], vars=given)

    def _total(self, function: Any, columns: Mapping[str, Sequence[Any]], own: Sequence[str | None]) -> list[Any]:
        """Derivatives of a function of state and groups along the columns; `own` names the group of each column."""
        import heyoka

        function = as_expression(function)
        found = []
        for k, group in enumerate(own):
            slope = sum((heyoka.diff(function, self.y[name]) * columns[name][k] for name in self.y), as_expression(0.0))
            found.append(slope if group is None else slope + heyoka.diff(function, self.groups[group]))
        return found

    def reversal(self, criterion: str, g: Any) -> Any:
        """A criterion falls through zero: the solids reverse the motion, at a moment that moves with the columns."""
        import heyoka

        columns, own = self._columns(), (*self.smooth, _OWN_GROUP[criterion], "dry_restitution")
        g = as_expression(g)
        rate = sum((heyoka.diff(g, self.y[name]) * self.flow[name] for name in self.y), as_expression(0.0))
        later = [-slope / rate for slope in self._total(g, columns, own)]
        there = {name: [row[k] + self.flow[name] * later[k] for k in range(len(own))] for name, row in columns.items()}
        after = self.structure.rebound(self.y, self.groups, self.laws)
        flow = self.structure.right_hand_side(after, self.groups, self.laws, self.film, 1)
        behind = {name: self._total(after[name], there, own) for name in self.y}
        rows = [behind[name][k] - flow[name] * later[k] for name in self.y for k in range(len(own))]
        return self._compiled([*after.values(), *rows])

    def start(self, rebound: bool) -> Any:
        """Initial contact, whose time is given."""
        first = self.structure.start(self.y, self.groups, self.laws)
        if rebound:
            first = self.structure.rebound(first, self.groups, self.laws)
        none = {name: [as_expression(0.0)] * (len(self.smooth) + 2) for name in self.y}
        rows = [
            each
            for value in first.values()
            for each in self._total(value, none, (*self.smooth, None, "dry_restitution"))
        ]
        return self._compiled([*first.values(), *rows])

    def rupture(self, g: Any, moves: bool) -> Any:
        """e_n where the rupture gap is reached; its derivative in that gap is the last."""
        import heyoka

        columns, own = self._columns(), (*self.smooth, None, None)
        e_n = as_expression(self.structure.outputs(self.y, self.groups, self.laws)["restitution"])
        g = as_expression(g)
        rate = sum((heyoka.diff(g, self.y[name]) * self.flow[name] for name in self.y), as_expression(0.0))
        along = sum((heyoka.diff(e_n, self.y[name]) * self.flow[name] for name in self.y), as_expression(0.0))
        slopes = zip(self._total(e_n, columns, own), self._total(g, columns, own), strict=True)
        found = [of_e_n - along * of_g / rate for of_e_n, of_g in slopes]
        gap = -along * heyoka.diff(g, self.groups["rupture_gap"]) / rate if moves else 0.0
        return self._compiled([*found, gap])


@dataclass
class Gradients(Batch):
    """An integrator with its queue, that leaves e_n and its derivatives.

    Arguments:
        equations: what it integrates.
        slopes: derivatives of the groups in the parameters, (collisions, groups, parameters).
        gradient: after `run`, derivatives of e_n, (collisions, parameters); NaN where it failed.
    """

    equations: Variational | None = None
    slopes: np.ndarray = field(default_factory=lambda: np.zeros(0))
    gradient: np.ndarray = field(default_factory=lambda: np.zeros(0))
    criteria: list[str | None] = field(default_factory=list)
    _last: np.ndarray = field(default_factory=lambda: np.zeros(0))

    def run(self) -> None:
        """All collisions, once, and their derivatives."""
        self._last = np.full((self.integrator.state.shape[0], len(self.starts)), math.nan)
        self.criteria = [None] * len(self.starts)
        super().run()
        self.gradient = self._landed()

    def ended(self, lane: int, separated: bool) -> bool:
        if separated:
            self._last[:, self.lanes[lane].collision] = self.integrator.state[:, lane]
        return super().ended(lane, separated)

    def callback(self, event: str) -> Any:
        """What heyoka calls when an event happens in a lane."""
        if event not in CRITERIA:
            return super().callback(event)
        assert self.equations is not None
        jump = self.equations.jumps[event]

        def rebounds(ta: Any, _: int, lane: int) -> bool:
            collision = self.lanes[lane].collision
            before = self.criteria[collision]
            if before not in (None, event):
                return self.ended(lane, False)  # its column is taken: left out, and counted as failed
            self.criteria[collision] = event
            ta.state[:, lane] = jump(ta.state[:, lane].copy(), pars=ta.pars[: jump.nparams, lane].copy())
            self.lanes[lane].reversed = True
            return True

        return rebounds

    def _landed(self) -> np.ndarray:
        """The columns of all collisions landed on the rupture, put to their groups, and led to the parameters."""
        assert self.equations is not None
        of = self.equations
        pars = np.array([start.parameters for start in self.starts]).T
        pars[len(of.groups)] = 0.0 if "film_edge" in of.events else 1.0
        columns = of.end(self._last, pars=np.ascontiguousarray(pars[: of.end.nparams]))
        by_group = np.zeros((len(self.starts), len(of.groups)))
        place = {name: k for k, name in enumerate(of.groups)}
        for k, name in enumerate(of.smooth):
            by_group[:, place[name]] = columns[k]
        own = [place[_OWN_GROUP[met]] if met else -1 for met in self.criteria]
        met = np.flatnonzero(np.array(own) >= 0)
        by_group[met, np.array(own)[met]] = columns[len(of.smooth), met]
        by_group[:, place["dry_restitution"]] = columns[len(of.smooth) + 1]
        if "rupture_gap" in place:
            by_group[:, place["rupture_gap"]] = columns[-1]
        found: np.ndarray = np.einsum("cg,cgp->cp", by_group, self.slopes)
        return found


def prepare(numbers: Sequence[Problem], slopes: np.ndarray, rtol: float, watch: Inside | None = None) -> Gradients:
    """An integrator for these collisions, all of which separate, compiled, with its queue.

    Arguments:
        slopes: derivatives of the groups in the parameters, (collisions, groups, parameters).
        watch: takes the time within callbacks.

    ComputationError as of `automata`.
    """
    import heyoka

    followed = automata(numbers, rtol)
    criteria = [name for name in CRITERIA if name != "elastic" or numbers[0].groups["elastic_gap"] != 0.0]
    equations = variational(followed[0].model.choice, criteria)
    batch = Gradients(film=len(equations.groups), equations=equations, slopes=slopes)
    batch.starts = [_begin(equations, automaton) for automaton in followed]
    arguments = [heyoka.par[equations.groups.index(name)] for name in equations.smooth]
    arguments += [heyoka.make_vars(name) for name in _CARRIERS]
    batch.build(heyoka.var_ode_sys(equations.rates, arguments, order=1), equations.events, rtol, watch)
    return batch


def _begin(equations: Variational, automaton: Automaton) -> Start:
    """At initial contact; one that meets a criterion there rebounds there, at a moment that nothing moves."""
    rebound = automaton.criterion() is not None
    film = 0.0 if rebound else 1.0
    parameters = np.array([*(automaton.groups[name] for name in equations.groups), film, 1.0])
    count = len(automaton.model.state)
    first = equations.begin[rebound]
    state = first(np.zeros(count * (1 + equations.columns)), pars=parameters[: first.nparams])
    return Start(np.array(state), parameters, rebound, automaton)
