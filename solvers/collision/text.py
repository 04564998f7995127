"""A collision as a short text table: ASCII except for the scene's name, at most 88 columns."""

import math
import re
from textwrap import wrap

from ...generated.automaton import BOUNCE, CRITERIA, KINDS, STICK, EventKind
from ..results import DEFINITIONS
from ..scene.scene import Scene
from ..scene.schema import Model
from ..scene.user_model_declared import OwnEvent
from .outcome import Event, Outcome

WIDTH = 88
CUT_OFFS = {
    KINDS[EventKind.HALF_TURN]: "half a turn, the strings cross",
    KINDS[EventKind.ROTATION_REVERSES]: "the strings turn the rotation back",
}
_PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"), (1e-12, "p"), (1e-15, "f"))
_POWER = re.compile(r"[A-Za-z]+\^")
_MANY = 40  # events; a longer list consists of repeated rebounds
_LABEL = 24  # width of the names on the left, characters
_FIRST, _LAST = 9, 3  # events shown of a longer list
_SCALE = 100.0  # above this ratio of the largest term to the initial energy, terms are not given in percent of it


def prefix(size: float) -> tuple[float, str]:
    """Return the SI prefix for a quantity of this size, as (factor, prefix): 2e-5 -> (1e-6, "u")."""
    size = abs(size)
    if size == 0 or not math.isfinite(size) or size < 1e-16:
        return _PREFIXES[0]
    # rounded to the digits shown, so that 999.96 us is 1 ms
    size = float(f"{size:.4g}")
    return next((entry for entry in _PREFIXES if size >= entry[0]), _PREFIXES[-1])


def quantity(value: float | None, unit: str) -> str:
    """Return a number with four digits and its prefixed unit; a dash for None."""
    if value is None:
        return "-"
    factor, name = (1.0, "") if _POWER.match(unit) else prefix(value)  # a prefix would be raised with its unit
    return f"{value / factor:.4g} {name}{unit}"


def plain(value: float | None, unit: str = "") -> str:
    """Return a number with four digits and its unit without a prefix; a dash for None."""
    if value is None:
        return "-"
    text = f"{value:.4g}"
    rounded = float(text)
    return f"{rounded:.0f} {unit}".rstrip() if 1e4 <= abs(rounded) < 1e7 else f"{text} {unit}".rstrip()


def degrees(value: float | None) -> str:
    """Return an angle given in rad in degrees; a dash for None."""
    return plain(None if value is None else math.degrees(value), "deg")


def with_unit(value: float, unit: str) -> str:
    """Return a number in SI with its unit as it is shown: prefixed, in degrees, or plain."""
    if unit == "rad":
        return degrees(value)
    return quantity(value, unit) if unit in ("s", "m") else plain(value, unit.removeprefix("1"))


def name_of(scene: Scene, longest: int = 32) -> str:
    """Return the scene's name on one line without control characters, shortened to `longest` characters."""
    return _cut(scene.name, longest) or "unnamed scene"


def against(scene: Scene) -> str:
    """Return the partner in words, for a title; empty for an equal sphere."""
    if scene.partner is None:
        return ""
    return " against a wall" if scene.wall else f" against a sphere of {plain(scene.radius_ratio)} times the radius"


def _cut(text: str, longest: int) -> str:
    """Return a text on one line without control characters, shortened to `longest` characters."""
    text = " ".join("".join(letter if letter.isprintable() else " " for letter in text).split())
    return text if len(text) <= longest else text[: longest - 3] + "..."


def reason(collision: Outcome) -> str:
    """Return the reason of the outcome, in words."""
    if collision.outcome == BOUNCE and collision.reversal is not None:
        own = collision.scene.package.criteria if collision.scene.package is not None else ()
        return next((criterion.sentence for criterion in own if criterion.word == collision.reversal), None) or (
            CRITERIA[collision.reversal].sentence
        )
    if collision.outcome != STICK:
        declared = _declared(collision)
        if declared is not None and declared.row.actions[-1] == "part":
            return f"separated by the event {declared.word}: {declared.meaning}"
        return "escaped by centrifugal force, no rebound criterion met"
    return _stuck(collision)


def _declared(collision: Outcome) -> OwnEvent | None:
    """The event of a user's model that happened last of all events, if it did."""
    package = collision.scene.package
    return next((event for event in package.events if event.word == _last(collision)), None) if package else None


def stopped(collision: Outcome) -> str:
    """Return why and when the integration of a stick stopped early; empty if it did not."""
    if not collision.until or _is_cut_off(collision):
        return ""
    if is_followed_on(collision):
        certain = f"{quantity(collision.decided, 's')} after initial contact" if collision.decided else "at contact"
        on = "" if ends_early(collision) else "on "
        return f"certain {certain}, followed {on}to {quantity(collision.until, 's')}"
    return f"integration stopped there, {quantity(collision.until, 's')} after initial contact"


def is_followed_on(collision: Outcome) -> bool:
    """Whether a stick was integrated to another time than that at which it was certain."""
    return collision.until is not None and collision.decided != collision.until


def ends_early(collision: Outcome) -> bool:
    """Whether the integration of a stick was to end before it was certain."""
    return collision.until is not None and collision.decided is not None and collision.until < collision.decided


def _is_cut_off(collision: Outcome) -> bool:
    """True if a cut-off of the experiment ended a stick, and no proof before it."""
    declared = _declared(collision)
    cut = _last(collision) in CUT_OFFS or (declared is not None and declared.row.actions[-1] == "cut off")
    return cut and not is_followed_on(collision)


def _end_of(collision: Outcome) -> str:
    """Words for the state at the end of the integration."""
    if collision.outcome != STICK:
        return "final"
    if is_followed_on(collision):
        return "at the end"
    if _is_cut_off(collision):
        return "at the cut-off"
    return "at the proof" if collision.certified else "when decided"


def _last(collision: Outcome) -> str:
    return collision.events[-1].kind if collision.events else ""


def _stuck(collision: Outcome) -> str:
    """Why a collision counts as a stick: a cut-off, a proof, or a decision without proof."""
    last, scene = _last(collision), collision.scene
    if ends_early(collision):
        return "it is certain later than the integration was to end"
    if _is_cut_off(collision):
        declared = _declared(collision)
        why = CUT_OFFS[last] if declared is None else declared.meaning
        why = why if declared is None or why.startswith(declared.word) else f"{declared.word}, {why}"
        return f"cut off after {quantity(collision.until, 's')}: {why}"
    when = "" if collision.decided else " at contact"
    before = [event.kind for event in collision.events if event.time <= (collision.decided or 0.0)]
    if not collision.certified and len(before) > _MANY and before[-1] == KINDS[EventKind.FELL_BACK]:
        return "decided, not proved: rebound after rebound, none higher than the one before"
    film_alone = scene.bridge is None and scene.pendulum is None and scene.attraction is None
    if not collision.certified:
        held = [kind for kind in before if kind in (KINDS[EventKind.RESTS], KINDS[EventKind.RELEASED])]
        if held and held[-1] == KINDS[EventKind.RESTS]:
            return f"decided{when}, not proved: it rests, and the forces hold it"
        why = "the film has stopped it" if film_alone else "energy below the barrier"
        return f"decided{when}, not proved: {why}"
    if film_alone:
        return f"proved{when}: the film stops it"
    if scene.pendulum is not None and collision.angle > 0:
        return f"proved{when}: the strings hold it for good (certificate)"
    return f"proved{when}: energy below the barrier (certificate)"


def table(collision: Outcome) -> str:
    """Return the short table that `wetdoublet collide` prints."""
    lines = [*_title(collision), "", *_outcome(collision), "", *_events(collision.events), ""]
    lines += [*_energy(collision), "", *_numerics(collision)]
    notes = [*collision.validity, *filter(None, [collision.long_contact])]
    remarks = [line for sentence in notes for line in wrap(f"note: {sentence}", WIDTH, break_on_hyphens=False)]
    return "\n".join([*lines, *_model(collision.scene), *assumed(collision.scene), *remarks])


def _line(name: str, value: str, note: str = "") -> str:
    text = f"{name:<{_LABEL}}{value}"
    return f"{text:<{_LABEL + 14}} {note}" if note else text


def _title(collision: Outcome) -> list[str]:
    groups = [f"St {plain(collision.stokes)}", f"angle {degrees(collision.angle)}"]
    if collision.scene.bridge is not None:
        groups += [f"Ce {plain(collision.centrifugal)}", f"Ca {plain(collision.capillary)}"]
    if collision.scene.attraction is not None and collision.generalised_centrifugal is not None:
        groups.append(f"Ce_F {plain(collision.generalised_centrifugal)}")
    if collision.reynolds is not None:
        groups.append(f"Re {plain(collision.reynolds)}")
    numbers = ", ".join(groups)
    return [f"{name_of(collision.scene, max(16, WIDTH - len(numbers) - 2))}: {numbers}"]


def _outcome(collision: Outcome) -> list[str]:
    """The lines on outcome, restitution and final state; of a stick those alone that are defined."""
    restitution = collision.restitution
    gained = "> 1: rotation has given it energy" if restitution > 1 else ""
    lines = [_line("outcome", collision.outcome), _line("", reason(collision))]
    if collision.outcome == "stick" and collision.reversal:
        lines.append(_line("", f"the {collision.reversal} criterion had made it rebound on the way"))
    if collision.outcome == "stick" and stopped(collision):
        lines.append(_line("", stopped(collision)))
    if collision.scene.partner is not None:
        lines.append(_line("partner", _partner(collision.scene)))
    speed = (plain if collision.speed >= 0.01 else quantity)(collision.speed, "m/s")
    lines += [
        _line("approach speed", speed, _speed_note(collision)),
        *_first_spins(collision.scene),
        _line("restitution e_n", plain(restitution), gained),
    ]
    if collision.outcome == "stick":  # the other quantities are undefined
        return lines
    wall, rotation = collision.scene.wall, collision.rotation
    turns = f"{rotation / math.tau:.2f} turns" if rotation is not None and abs(rotation) > math.tau else ""
    rate = plain(collision.final_rotation_rate, "rad/s")
    e_t = plain(collision.tangential_restitution)
    lines += [_line("tangential e_t", e_t, "of the velocity along the wall" * wall), *_slip(collision)]
    lines += [] if wall else [_line("rotation", degrees(rotation), turns)]  # a wall has no rotating line of centres
    lines.append(_line("contact time", quantity(collision.contact_time, "s")))
    lines.append(_line("smallest gap", quantity(collision.smallest_gap, "m")))
    lines += [] if wall else [_line("final rotation rate", rate, "omega, of the line of centres")]
    return [*lines, *_spins(collision.scene, "final spin", collision.final_spin, collision.final_spin_partner)]


def _speed_note(collision: Outcome) -> str:
    """The note that says which speed is shown."""
    relative = collision.scene.impact.relative_speed
    whole = "" if relative is None else f" of the relative speed {plain(relative, 'm/s')}"
    return f"normal component{whole}"


def _slip(collision: Outcome) -> list[str]:
    """The restitution of the slip, of spheres that arrive spinning; without spins e_t says as much."""
    if not _arrives_spinning(collision.scene):
        return []
    return [_line("slip restitution", plain(collision.slip_restitution), "of the surfaces' relative velocity")]


def _partner(scene: Scene) -> str:
    if scene.wall:
        return "a wall"
    radius, mass = scene.radius_ratio, scene.mass_ratio
    return f"a sphere of {plain(radius)} times the radius and {plain(mass)} times the mass"


def _spins(scene: Scene, name: str, spin: float | None, partner: float | None) -> list[str]:
    """The spins before or after the collision, rad/s."""
    if not (scene.pair or scene.wall):
        return [_line(name, plain(spin, "rad/s"), "xi, of each sphere")]
    lines = [_line(name, plain(spin, "rad/s"), "xi, of the sphere")]
    if not scene.wall:
        lines.append(_line("", plain(partner, "rad/s"), "xi, of its partner"))
    return lines


def _first_spins(scene: Scene) -> list[str]:
    """The spins before the collision, where the scene gives any."""
    if not _arrives_spinning(scene):
        return []
    material = scene.material
    return _spins(scene, "initial spin", material["impact_spin"], material.get("impact_partner_spin"))


def _arrives_spinning(scene: Scene) -> bool:
    return scene.impact.spin is not None or scene.impact.partner_spin is not None


def _events(events: tuple[Event, ...]) -> list[str]:
    if not events:
        return [_line("events", "none")]
    lines = [_line("  " + event.kind, quantity(event.time, "s")) for event in events]
    hidden = len(lines) - _FIRST - _LAST
    if hidden > 1:
        lines[_FIRST:-_LAST] = [_line("  ...", f"{hidden} more")]
    return [_line("events", "at"), *lines]


def _energy(collision: Outcome) -> list[str]:
    if collision.energy is None:
        return [_line("energy", "-", "not integrated along")]
    initial, values = collision.energy.initial, collision.terms
    names = {term: DEFINITIONS[f"energy.{term}"].short for term in values} | {"final": f"kinetic, {_end_of(collision)}"}
    last = {term: 1 if term == "residual" else 3 for term in values}  # digits behind the point
    lines = [f"  {names[term]:<{_LABEL - 2}}{_exponent(value, last[term]):>11}" for term, value in values.items()]
    if max(abs(value) for term, value in values.items() if term != "residual") > _SCALE * initial:
        return [f"{'energy':<{_LABEL}}{'J':>11}", *lines]
    shares = [f"{100 * value / initial:.3f}" for term, value in values.items() if term != "residual"]
    shares.append(_exponent(100 * values["residual"] / initial, 1))
    return [f"{'energy':<{_LABEL}}{'J':>11}{'% of initial':>16}", *map("{}{:>16}".format, lines, shares)]


def _exponent(value: float, digits: int) -> str:
    return f"{value:.{digits}e}" if value else "0"


def _model(scene: Scene) -> list[str]:
    """Lines that name the laws used, wrapped to the width of the table."""
    used = {"arm": scene.model.arm, "tangential": scene.model.tangential}
    used |= {"glass": scene.model.glass} if scene.liquid.glass_transition_pressure is not None else {}
    used |= {"film": scene.model.film} if scene.model.film != Model.film else {}
    if scene.bridge is not None:
        used["bridge"] = scene.bridge.law
        used |= {"rupture": scene.bridge.rupture} if scene.bridge.rupture != "common" else {}
    if scene.pendulum is not None:
        used["strings"] = scene.pendulum.law
    used |= {"liquid": str(law)} if (law := scene.entries.get("liquid.law")) is not None else {}
    if scene.package is not None:  # laws that the user's model chooses, not an entry of the scene
        used |= {slot: scene.package.laws(slot)[0] for slot in scene.package.unnamed}
        used |= {name.replace("_", " "): str(value) for name, value in scene.custom.items()}
    lines = wrap(", ".join(f"{slot} {law}" for slot, law in used.items()), WIDTH - _LABEL, break_on_hyphens=False)
    return [_line("model" if line == lines[0] else "", line) for line in lines]


def assumed(scene: Scene) -> list[str]:
    """Lines that name the scene's assumed values, and what was held when its entries changed."""
    sentences = (_cut(line, len(line)) for line in (*scene.assumed, scene.held) if line)
    return [line for sentence in sentences for line in wrap(sentence, WIDTH, break_on_hyphens=False)]


def _numerics(collision: Outcome) -> list[str]:
    drift = collision.angular_momentum_drift
    lines = []
    if drift is not None:
        lines = [_line("angular momentum", _exponent(drift, 1), "relative drift")]
    elif collision.scene.wall and collision.energy is not None:
        lines = [_line("angular momentum", "-", "not conserved: the wall takes from it")]
    elif collision.scene.pendulum is not None:
        lines = [_line("angular momentum", "-", "not conserved: the strings take from it")]
    lines.append(_line("engine", f"{collision.engine}, {collision.steps} steps"))
    return lines
