"""`prove`: the outcome of one collision, or of all in a box, by enclosure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from time import perf_counter

from ....generated.automaton import OUTCOMES
from ...scene.held import impact_quantity, impact_value
from ...scene.items import item
from ...scene.origin import Result
from ...scene.scene import Scene
from .build import NotProvable
from .call import BOX, OUTCOME, REASONS, SHARP, Enclosure, Range, enclose
from .inputs import Inputs, Within

_REFUSED = "not provable here: "
_HELD = {
    "stokes": "at St {:.10g}: the speed varies with the box",
    "speed": "at a normal speed of {:.10g} m/s",
    "relative_speed": "at a relative speed of {:.10g} m/s",
}


class Proof(Result, kw_only=True):
    """What is proved of a collision, or of every collision in a box.

    Example:
        >>> from wetdoublet.solvers import prove
        >>> bool(prove("granulation", stokes=0.3, angle="20 deg"))
        True
    """

    _keys = "proved outcome restitution reason smallest_gap rebounds steps seconds inputs=ranges within=box held"

    outcome: str | None = item('"stick", "stick-rotate-separate" or "bounce"; None if nothing is proved')
    restitution: Range | None = item("low and high of e_n, (0, 0) for a stick; None if nothing is proved")
    reason: str = item('why nothing is proved; "" for a proof')
    smallest_gap: float | None = item(
        "a bound below the gap up to separation, m; None for a stick, and if nothing is proved"
    )
    steps: int = item("of the enclosure")
    rebounds: int
    ranges: Mapping[str, Range] = item("low and high of the quantities that the proof holds for, SI")
    box: Mapping[str, Range] = item("low and high of the entries of the box, SI, as the scene gives them")
    scene: Scene
    seconds: float = item("wall time of the proof", compare=False)

    @property
    def proved(self) -> bool:
        """True if the outcome is proved, as is the proof itself."""
        return self.outcome is not None

    @property
    def held(self) -> Mapping[str, float]:
        """The impact's Stokes number or speed (m/s), by dotted name; empty where the box has a range of it."""
        quantity = impact_quantity(self.scene)
        value = None if quantity is None else impact_value(self.scene, quantity)
        name = f"impact.{quantity}"
        return {name: value} if value is not None and name not in self.box else {}

    def __bool__(self) -> bool:
        return self.proved

    def __str__(self) -> str:
        if self.outcome is None or self.restitution is None:
            lines = [f"{_REFUSED}{self.reason}"]
        else:
            low, high = self.restitution
            lines = [f"proved: {self.outcome}"]
            lines += [f"restitution e_n between {low:.17g} and {high:.17g}"] if high > 0 else []
            counts = ((self.rebounds, "rebound"), (self.steps, "step"))
            lines += [", ".join(f"{n} {word}{'s' * (n != 1)}" for n, word in counts) + " of the enclosure"]
        for name, ends in self.box.items():
            is_angle = self.scene.fields[name].unit == "rad"
            low, high = map(math.degrees, ends) if is_angle else ends
            lines.append(f"for every {name} between {low:.10g} and {high:.10g} {'deg' if is_angle else '(SI)'}")
        if self.box:
            lines += [_HELD[name.partition(".")[2]].format(value) for name, value in self.held.items()]
        return "\n".join(lines)


def prove(
    scene: Scene | str | Path,
    *,
    stokes: float | str | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    relative_speed: float | str | None = None,
    within: Within | None = None,
) -> Proof:
    """Prove the outcome of a collision from its initial data on, by interval arithmetic.

    The proof is about the model's equations and the stored numbers. What is not proved says why.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name.
        stokes: Stokes number of the impact, in place of the scene's.
        speed: normal speed of the impact instead, m/s or a string with its unit.
        angle: impact angle, rad or a string with its unit.
        relative_speed: magnitude of the relative velocity, in place of the normal speed.
        within: prove the outcome for a whole box: a relative uncertainty of the impact as the scene gives it (Stokes
            number or speed, and angle), or by entry an uncertainty or both ends, as
            {"liquid.viscosity": ("1.9 Pa s", "2.1 Pa s")}. A volume is in m^3 where the scene gives it so.

    Raises:
        InputError: an entry, or a box that is empty, reversed or not admissible.

    Example:
        >>> from wetdoublet.solvers import prove
        >>> prove("granulation", stokes=0.02, angle="75 deg").outcome
        'stick-rotate-separate'
    """
    loaded = Scene.load(scene).with_impact(stokes, speed, angle, relative_speed)
    return prove_inputs(Inputs.of(loaded, within))


def prove_inputs(inputs: Inputs, digits: bool = True) -> Proof:
    """The proof for inputs that are checked; with `digits` the restitution is enclosed narrowly where that is quick."""
    start, x0 = perf_counter(), inputs.ranges["film_thickness"][0]
    enclosure: Enclosure | None = None
    try:
        engine = inputs.engine()
        for settings in (BOX,) if inputs.moving else (SHARP, OUTCOME) if digits else (OUTCOME,):
            enclosure = enclose(engine, inputs.ranges, inputs.moving, settings)
            if enclosure.outcome:
                break
        reason = REASONS.get(enclosure.why, "") if enclosure else ""
    except NotProvable as error:
        reason = str(error)
    proved = enclosure is not None and enclosure.outcome > 0
    return Proof(
        outcome=OUTCOMES[enclosure.outcome - 1] if enclosure and proved else None,
        restitution=enclosure.restitution if enclosure and proved else None,
        reason=reason,
        smallest_gap=math.nextafter(enclosure.smallest_gap * x0, 0.0) if enclosure and enclosure.outcome > 1 else None,
        steps=enclosure.steps if enclosure else 0,
        rebounds=enclosure.rebounds if enclosure else 0,
        ranges=inputs.ranges,
        box=inputs.box,
        scene=inputs.scene,
        seconds=perf_counter() - start,
    )
