"""`equations()`: the model of a scene as plain CasADi functions, and the order of phases of its collision."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field, replace
from functools import partial
from pathlib import Path as FilePath

import numpy as np
from casadi import DM, SX, Function, densify, vertcat

from ...generated.assemble import casadi_functions
from ..collision.by_kernel import sequence_of
from ..collision.text import name_of
from ..engines.casadi.replay import Stopped, replayed
from ..engines.casadi.sequence import PhaseRun
from ..engines.casadi.watch import guards
from ..engines.settings import UNTIL, check_rtol
from ..model.dimensionless import nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow, expressions
from ..results import DEFINITIONS
from ..scene.held import held_quantity
from ..scene.items import item
from ..scene.origin import Record, Result
from ..scene.scene import Scene
from ..sensitivity.parameters import SCALES, kind_of, parameter_map, references
from ..sensitivity.trajectory import Course, course_of

_ENGINE = "rosenbrock"
_OTHERS = ("right_hand_side", "resting_rates", "energy_rates", "jacobian", "event_rates", "start")  # by phase, or made
_LINE = re.compile(r"^- (\w+) \[(.+?)\]: ", re.MULTILINE)
_BY_PHASE = re.compile(r"^(rates|events?|reset)_\d+$")
_OF_SCALES = dict(zip(SCALES, ("m", "s", "rad/s", "J"), strict=True))
_OF_RESULTS = {None: "1", "rate": "Omega"}
_OWN = {  # what functions give that are not emitted; those with _K in phase K
    "groups": "Groups of the entries.", "scales": "Scales of the entries, SI.",
    "start": "State at initial contact, behind what happens there.",
    "rates_K": "Rates of the states per v0/x0.", "events_K": "Guards of the phase's events, positive before them.",
    "event_K": "Guard of the event that ends the phase, 0 at its end.", "reset_K": "State after that event.",
}  # fmt: skip


def units_of(model: Model) -> dict[str, str]:
    """Units of the states and groups of a model, as its emitted text has them."""
    return dict(_LINE.findall(model.structure.__doc__ or ""))


class Phase(Record):
    """A phase of a collision, between two events; every phase takes time."""

    name: str = item("in words")
    duration: float = item("how long it takes", "x0/v0")
    before: np.ndarray = item("the state at its start", repr=False)
    after: np.ndarray = item("the state at its end, before the event's reset", repr=False)
    event: str = item('what ends it, in the words of `Collision.events`; "" where it just ends')
    watched: tuple[str, ...] = item("the events of `events_K`, in order; the kinks of a law's force included")


class Equations(Result):
    """The equations of a scene's model, dimensionless, and what happens in its collision.

    Example:
        >>> import wetdoublet as wd
        >>> found = wd.equations("granulation")
        >>> [phase.event for phase in found.phases]
        ['turned', 'film edge', 'rupture']
        >>> found.functions["rates_0"]
        Function(rates_0:(state[4],groups[13])->(rates[4]) SXFunction)
    """

    _keys = "outcome states entries groups scales phases outputs docs units"

    functions: Mapping[str, Function] = item(
        "CasADi functions by name. Of the entries: `groups`, `scales`. Of the groups: `start`, the state at initial "
        "contact (behind what happens there). Of (state, groups): `energies`, `angular_momentum`, `outputs` and all "
        "others that are emitted; for phase K, counted from 0, `rates_K`, `events_K` (all guards, positive before "
        "their events), `event_K` (that of the event which ends it), `reset_K` (the state after the event)",
        repr=False,
    )
    states: tuple[str, ...] = item("names of the states, in order")
    outputs: Mapping[str, tuple[str, ...]] = item(
        "names of the elements of `energies`, `outputs` and other functions, by function", repr=False
    )
    docs: Mapping[str, str] = item(
        "what each function gives, with its unit; those of phases under `rates_K` and the like", repr=False
    )
    entries: Mapping[str, float] = item(
        "values of the scene and its impact by name, SI, in the order of the functions' arguments; so are the others",
        repr=False,
    )
    groups: Mapping[str, float] = item("values of the groups")
    scales: Mapping[str, float] = item("length x0, time x0/v0, angular velocity Omega and energy m v0^2")
    phases: tuple[Phase, ...] = item(
        "of the scene's collision, in order; of a stick up to where it is certain, or to `until`"
    )
    units: Mapping[str, str] = item(
        "by name, of states, entries, groups, scales, `outputs`, `energies` and the `duration` of phases", repr=False
    )
    outcome: str
    scene: Scene = field(repr=False, compare=False)

    def __str__(self) -> str:
        """States, groups and scales with their units, the phases, and the functions with their arguments."""

        def listed(values: Mapping[str, float]) -> list[str]:
            return [f"  {name:<28}{value:>14.6g} {self.units[name]}" for name, value in values.items()]

        phases = [
            f"  {k:<3}{phase.name:<28}{phase.duration:>11.6g}  {phase.event}" for k, phase in enumerate(self.phases)
        ]
        listing: dict[str, str] = {}  # a function's arguments, once for all phases
        for name, function in self.functions.items():
            label = _BY_PHASE.sub(r"\1_K", name)
            listing.setdefault(label, str(function).rpartition(" ")[0].replace(name, label))
        return "\n".join(
            [
                f"{name_of(self.scene)}: {self.outcome}",
                "state: " + ", ".join(f"{name} [{self.units[name]}]" for name in self.states),
                "groups",
                *listed(self.groups),
                "scales",
                *listed(self.scales),
                "phases" + f"{'duration in x0/v0, and the event that ends it':>61}",
                *(phases or ["  none: the outcome is certain at initial contact; `until` follows it on"]),
                "functions",
                *(line for name, text in listing.items() for line in (f"  {text}", f"      {self.docs[name]}")),
            ]
        )


def equations(
    scene: Scene | str | FilePath,
    model: str | FilePath | None = None,
    *,
    until: float | str | None = None,
    rtol: float = 1e-10,
) -> Equations:
    """The equations of a scene's model as plain CasADi functions, and the order of phases of its collision.

    No integrator is among them: they are to build on. The phases are those that the kernel finds, with states by
    Rosenbrock. While the order of events stays, the functions of the phases one after another are the collision.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name, with an impact.
        model: a user's model, as for `Scene.load`.
        until: time up to which a stick is followed on; s, or a string with its unit.
        rtol: relative tolerance of durations and states.

    Raises:
        InputError: the scene is not acceptable, or has no impact.
        ComputationError: the collision could not be completed.

    Example:
        >>> import wetdoublet as wd
        >>> found = wd.equations("granulation")
        >>> float(found.functions["outputs"](found.phases[-1].after, list(found.groups.values()))[0]) > 0
        True
    """
    loaded, rtol = Scene.load(scene, model), check_rtol(rtol)
    end = None if until is None else UNTIL.number(until)
    v0, theta0 = loaded.need_impact()
    problem = nondimensionalise(loaded, v0, theta0)
    choice = select_model(loaded, problem.oblique, full=True)
    built = load(choice)
    try:
        path, replay = replayed(partial(sequence_of, problem, until=end), choice, (), _ENGINE, rtol)
    except Stopped as stopped:
        raise problem.in_si(stopped.error(_ENGINE, built)) from None
    kind = kind_of(loaded, held_quantity(loaded, None))
    reference, names = references(loaded, kind.entries, v0, theta0), tuple(built.groups)
    values = parameter_map(kind, (), names).values
    numbers = np.asarray(values(reference).full()).ravel()
    course, steps, pieces = course_of(path, replay, choice), iter(path.steps), iter(replay.pieces)
    functions, phases = _shared(built, values), list[Phase]()
    outputs = {name: built.names(name) for name in functions if built.has(name)}
    for leg in course.legs:
        words = leg.event if leg.event in built.kinks else ", ".join(next(steps).kinds)
        if leg.duration > 0:
            piece = next(pieces)
            watched = guards(piece.flow)[1]
            functions |= _of_phase(len(phases), piece.flow, course, leg)
            phases.append(Phase(str(leg.phase), piece.duration, piece.start, piece.end, words or "", watched))
        elif phases:  # what happens where a phase has ended already belongs to its end
            phases[-1] = replace(phases[-1], event=", ".join(filter(None, (phases[-1].event, words))))
            name = f"reset_{len(phases) - 1}"
            functions[name] = _then(functions[name], course.reset(leg))
        else:
            functions["start"] = _then(functions["start"], course.reset(leg))
    emitted = {name: getattr(built.structure, name).__doc__ for name in functions if hasattr(built.structure, name)}
    docs = {name: " ".join(text.partition("\n\n")[0].split()) for name, text in emitted.items()} | _OWN
    entries = dict(zip(kind.entries, reference.tolist(), strict=True))
    fields, states = loaded.fields, dict.fromkeys(built.state)
    units = {name: fields[name].unit or "1" for name in entries} | _OF_SCALES
    units |= {"duration": "x0/v0", "angular_momentum": "1"}
    units |= {name: _OF_RESULTS[DEFINITIONS[name].scale] for name in outputs["outputs"]}
    units |= dict.fromkeys(outputs["energies"], "m v0^2") | units_of(built)
    return Equations(
        functions=functions,
        states=tuple(states),
        outputs=outputs,
        docs=docs,
        entries=entries,
        groups=dict(zip(names, numbers[: len(names)].tolist(), strict=True)),
        scales=dict(zip(SCALES, numbers[len(names) :].tolist(), strict=True)),
        phases=tuple(phases),
        units=units,
        outcome=path.outcome,
        scene=loaded,
    )


def _shared(model: Model, values: Function) -> dict[str, Function]:
    """The functions that are the same in all phases."""
    entries, groups = SX.sym("entries", values.size1_in(0)), model.parameters
    numbers, count = values(entries), groups.numel()
    start = model.function("start")(DM.zeros(len(model.state)), groups)
    emitted = casadi_functions(model.structure, model.laws)
    return {
        "groups": Function("groups", [entries], [numbers[:count]], ["entries"], ["groups"]),
        "scales": Function("scales", [entries], [numbers[count:]], ["entries"], ["scales"]),
        "start": Function("start", [groups], [start], ["groups"], ["state"]),
    } | {name: function for name, function in emitted.items() if name not in _OTHERS}


def _of_phase(k: int, flow: Flow, course: Course, leg: PhaseRun) -> dict[str, Function]:
    """The functions of phase k."""
    model, (watched, names) = flow.model, guards(flow)
    state, groups = model.column, model.parameters
    values = watched(state, vertcat(groups, leg.phase.motion))[0]
    columns = {"rates": expressions(flow).rates, "events": values}
    if leg.event is not None:
        columns["event"] = values[names.index(leg.event)]
        columns["reset"] = course.reset(leg)(state, groups)[0]
    return {
        f"{name}_{k}": Function(f"{name}_{k}", [state, groups], [densify(column)], ["state", "groups"], [name])
        for name, column in columns.items()
    }


def _then(first: Function, second: Function) -> Function:
    """A function of (state, groups) or of the groups, and what happens to its state next."""
    inputs = first.sx_in()
    state = second(first(*inputs), inputs[-1])[0]
    return Function(first.name(), inputs, [state], first.name_in(), first.name_out())
