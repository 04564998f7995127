"""What happens to a state at the end of a phase: a rebound, with or without friction, rest, a declared event."""

import math

import numpy as np
from casadi import SX, Function, densify, if_else, vertcat

from ..host.thread_caches import own_cache
from ..scene.groups import GAPS
from .key import ModelKey
from .model import Model, load

_MOST = ("most", "rest_most")  # Coulomb's limit of a rebound, and of one by which the doublet comes to rest


def rubs(model: Model, criterion: str) -> bool:
    """True if a rebound by this criterion has friction."""
    return model.friction and (criterion in GAPS or model.choice.structure.endswith("_friction_all"))


def grip(model: Model, criterion: str, y: np.ndarray, p: np.ndarray, rests: bool) -> float:
    """Logarithm of the impulse that sticks over Coulomb's limit, positive if it slides; infinite without friction."""
    if not rubs(model, criterion):
        return math.inf
    impulses = model.values("dry_slip", y, p)
    sticking, most = abs(impulses["sticking"]), impulses[_MOST[rests]]
    return math.log(sticking / most) if sticking > 0 and most > 0 else math.inf


def reset(choice: ModelKey, criterion: str, rests: bool = False, own: str = "") -> Function:
    """Function (state, groups) -> state after it; what rebound, friction and declared event take; state rebounded.

    Energies are over m v0^2; the last result is the state after the rebound alone.

    Arguments:
        criterion: by which the doublet rebounds; empty if it does not.
        rests: it comes to rest.
        own: name of a declared event that happens.
    """
    return _reset(choice, bool(criterion), rubs(load(choice), criterion), rests, own)


@own_cache(256)
def _reset(choice: ModelKey, rebounds: bool, rubbing: bool, rests: bool, own: str) -> Function:
    model = load(choice)
    y, p, dry, friction, taken = model.column, model.parameters, SX(0), SX(0), SX(0)
    if rebounds:
        after, dry = model("rebound"), SX(model("rebound_loss")["dry_contact"])
        if rubbing:  # the tangential impulse is the one that sticks, limited by Coulomb's law
            slips = model("dry_slip")
            sticking, most = slips["sticking"], slips[_MOST[rests]]
            impulse = if_else(sticking > most, most, if_else(sticking < -most, -most, sticking))
            after = model("rubbed", region={"impulse": impulse}) | {"normal_velocity": after["normal_velocity"]}
            friction = SX(model("friction_loss", region={"impulse": impulse})["dry_friction"])
        y = vertcat(*(SX(after[name]) for name in model.state))
    rebounded = y
    if rests:  # chatter dissipates what remains of the rebound's energy
        dry += y[1] ** 2 / 2
        y = vertcat(y[0], 0, y[2:])
        dry += _own_energy(model, rebounded, p) - _own_energy(model, y, p)
    if own:
        before, y = y, model.function(f"jump_{own}")(y, p)
        taken = _energy(model, "kinetic", before, p) - _energy(model, "kinetic", y, p)
        taken += _own_energy(model, before, p) - _own_energy(model, y, p)
    names = ["state", "groups"], ["after", "dry_contact", "dry_friction", "own_events", "rebounded"]
    return Function("reset", [model.column, p], [densify(y), dry, friction, taken, densify(rebounded)], *names)


def _energy(model: Model, name: str, y: SX, p: SX) -> SX:
    return model.function("energies")(y, p)[model.names("energies").index(name)]


def _own_energy(model: Model, y: SX, p: SX) -> SX:
    """That of declared terms, added inertia included."""
    return _energy(model, "own_energy", y, p) if "own_energy" in model.names("energies") else SX(0)
