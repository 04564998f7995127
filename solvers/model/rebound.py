"""The jump of a state at a rebound, with the friction of the dry contact where a scene has it."""

import math
from dataclasses import dataclass

import numpy as np
from casadi import SX, Function, densify, if_else, vertcat

from ..host.thread_caches import own_cache
from ..scene.contact import GAPS
from .key import ModelKey
from .model import Model, load

_MOST = ("most", "rest_most")  # Coulomb's limit of a rebound, and of one by which the doublet comes to rest


@dataclass(frozen=True)
class Rebound:
    """A rebound.

    Arguments:
        after: the state after it.
        dry, friction: energies lost along the line of centres and by friction, over m v0^2.
        grip: logarithm of the impulse that sticks over Coulomb's limit, positive if it slides; infinite without one.
    """

    after: np.ndarray
    dry: float
    friction: float = 0.0
    grip: float = math.inf


def rubs(model: Model, kind: str) -> bool:
    """True if a rebound by this criterion has friction."""
    return model.friction and (kind in GAPS or model.choice.structure.endswith("_friction_all"))


def rebounded(model: Model, kind: str, y: np.ndarray, p: np.ndarray, rests: bool = False) -> Rebound:
    """The rebound of a state (leading entries of `y`) by a criterion; `rests`: the doublet comes to rest by it."""
    if not model.friction:
        after = np.array(list(model.values("rebound", y, p).values()))
        return Rebound(after, model.values("rebound_loss", y, p)["dry_contact"])
    rubbing, impulses = rubs(model, kind), model.values("dry_slip", y, p)
    parts = [block.full().ravel() for block in jump(model.choice, rests)(y[: len(model.state)], p, float(rubbing))]
    sticking, most = abs(impulses["sticking"]), impulses[_MOST[rests]]
    grip = math.log(sticking / most) if rubbing and sticking > 0 and most > 0 else math.inf
    return Rebound(parts[0], float(parts[1][0]), float(parts[2][0]), grip)


@own_cache(128)
def jump(choice: ModelKey, rests: bool = False) -> Function:
    """Function (state, groups, 1 with friction) -> state after a rebound, and both losses of energy.

    The tangential impulse is the one that sticks, limited by Coulomb's law.
    """
    model, rubbing = load(choice), SX.sym("rubbing")
    after, friction = model("rebound"), SX(0)
    if model.friction:
        slips = model("dry_slip")
        sticking, most = slips["sticking"], rubbing * slips[_MOST[rests]]
        impulse = if_else(sticking > most, most, if_else(sticking < -most, -most, sticking))
        after = model("rubbed", region={"impulse": impulse}) | {"normal_velocity": after["normal_velocity"]}
        friction = model("friction_loss", region={"impulse": impulse})["dry_friction"]
    dry = model("rebound_loss")["dry_contact"]
    column = densify(vertcat(*(SX(after[name]) for name in model.state)))
    return Function("jump", [model.column, model.parameters, rubbing], [column, SX(dry), SX(friction)])
