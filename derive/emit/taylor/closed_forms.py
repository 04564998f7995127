"""Functions of a structure in closed form: edge of the tangential force, work of attractions, momentum of the film."""

import sympy as sp

from ...equations.model import Model
from ...physics.forces import FILM
from ...physics.law import slot_calls
from ...vocabulary.quantities import normal_velocity
from .constants import Constants
from .layout import comment, compiled_if, documented, function
from .program import Call

WORKS = {"capillary": "bridge", "attraction": "attraction"}  # name in the ledger, and slot of the force
Calls = dict[str, Call]


def attracting(model: Model) -> list[str]:
    """Slots of the attractive forces."""
    return [slot for slot in WORKS.values() if slot in model.slots]


def edge_function(event: sp.Expr, constants: Constants) -> list[str]:
    """C function with the gap beyond which the tangential force vanishes."""
    (call,) = slot_calls(event)
    head = "static inline vec tangential_edge(const constants *c)"
    return documented(
        "Gap beyond which there is no tangential force.", head, [f"return {constants.factor(call, 'edge')};"]
    )


def work_function(model: Model, constants: Constants, calls: Calls) -> list[str]:
    """C function of the work against attractions, from the laws' antiderivatives by the chain rule."""
    gap, terms = model.states[0], []
    for slot in attracting(model):
        force = next(value for symbol, value in model.definitions if symbol.name == f"{slot}_force")
        (call,) = slot_calls(force)
        name = next(name for name, (called_slot, _, _) in calls.items() if called_slot == slot)
        per = sp.cancel(force / call / call.args[0].diff(gap))
        scale = constants.factor(call.args[0].diff(gap), f"{slot}_gap_factor")
        factor = constants.factor(per, f"{slot}_work_factor")
        at = "gap" if scale == "1.0" else f"{scale}*gap"
        terms.append(f"{factor}*{slot}_force_work(&c->{name}, {at})")
    what = "Capillary work" if attracting(model) == ["bridge"] else "Work against the attractions"
    doc = f"{what} up to a gap over m v0^2, from a fixed but arbitrary gap."
    head = "static inline vec capillary_work(const constants *c, vec gap)"
    lines = [*comment(doc), *function(head, [f"return {' + '.join(terms)};"])]
    return [*compiled_if("!CAPILLARY_STATE", lines), ""]


def momentum_functions(model: Model, constants: Constants, calls: Calls) -> list[str]:
    """C functions of the loss of normal velocity in the film: du/dx is minus the force over the velocity."""
    force = next(value for symbol, value in model.definitions if symbol.name == "film_force").subs(FILM, 1)
    (call,) = slot_calls(force)
    name = next(name for name, (slot, _, _) in calls.items() if slot == "film")
    if call.free_symbols & {*model.states[1:]}:
        return ["#define FILM_MOMENTUM 0 /* its resistance varies with more than the gap */", ""]
    factor = constants.factor(sp.cancel(force / call / normal_velocity), "film_momentum_factor")
    slowing, momentum = (
        function(
            f"static inline vec film_{what}(const constants *c, vec gap)",
            [f"return {factor}*film_resistance_{of}(&c->{name}, gap);"],
        )
        for what, of in (("slowing", "value"), ("momentum", "work"))
    )
    doc = "Loss of normal velocity in the film up to a gap, over v0, from a fixed but arbitrary gap."
    return [
        "#define FILM_MOMENTUM 1",
        *comment("Loss of normal velocity in the film per gap, over v0/x0."),
        *slowing,
        *compiled_if("defined(FILM_RESISTANCE_WORK)", [*comment(doc), *momentum]),
        "",
    ]
