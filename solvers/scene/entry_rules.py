"""Rules for the entries of a scene together: none unknown, duplicate or missing; lengths in order.

A rule yields what it refuses: the entry, what is accepted, and what is wrong. `refuse` raises the first of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from ..errors import InputError, excerpt
from ..host import emitted
from . import user_model as custom
from .groups import AT_ANY_SPEED, REMOVERS, System, gap_at_any_speed, never_touching
from .quantities import initial_gap
from .schema import (
    ALTERNATIVES,
    FIELDS,
    FROM_COATING,
    LIQUIDS,
    NEWTONIAN,
    ONE_OF_EACH,
    REQUIRED_TABLES,
    SPEEDS,
    SPINS,
    TABLES,
)

Refused = Iterator[tuple[str, str, str]]
FARTHEST = 1e4  # largest ratio of radii or masses; beyond it the equations lose digits (use the limit, a wall)
FILMS_OF_LIQUIDS, THINNING = ("finite", "cavitating"), ("cross", "carreau")
_LONGEST_NAME = 1000  # characters; the name is the title of figures and an attribute of files
_NEEDS = {
    "particles.contact_tangential_restitution": "particles.friction",
    "model.contact_friction": "particles.friction",
    "partner.coating_thickness": "liquid.coating_thickness",
}
"""Entry -> another that it is nothing without."""


def refuse(refused: Iterable[tuple[str, str, str]], entries: Mapping[str, Any] | Iterable[tuple[str, Any]]) -> None:
    """Raise InputError for the first refused entry, with its value; one that is not there is missing."""
    for name, accepted, problem in refused:
        raise InputError(name, dict(entries).get(name), accepted, problem)


def check_arguments(name: object, given: object, comments: object, package: object) -> None:
    """Raise InputError unless these are arguments of a scene: a name that a file can hold, pairs, an opened package."""
    if not isinstance(name, str):
        raise InputError("name", name, "text", "is not text")
    try:
        name.encode()
    except UnicodeEncodeError:
        raise InputError("name", name, "text", "cannot be written as UTF-8") from None
    if "\0" in name or len(name) > _LONGEST_NAME:
        raise InputError("name", name, f"text of at most {_LONGEST_NAME} characters", "is no name")
    accepted = "pairs of a dotted name and a value, such as (('liquid.viscosity', '2 Pa s'), ...)"
    for label, pairs in (("given", given), ("comments", comments)):
        if not isinstance(pairs, (tuple, list)):
            raise InputError(label, pairs, accepted, "is no list of pairs")
        for pair in pairs:
            if not isinstance(pair, tuple) or len(pair) != 2 or not isinstance(pair[0], str):
                raise InputError(label, pair, accepted, "is no such pair")
    if package is not None and not isinstance(package, custom.Package):
        raise InputError("package", package, "a Package, or None: models are opened by Scene.load(..., model=DIR)")


def check_entries(
    entries: Mapping[str, Any], package: custom.Package | None = None, *, from_file: bool = False
) -> dict[str, float | str]:
    """Return the entries in SI; InputError for one that is unknown, wrong by itself, or an alternative to another."""
    emitted.check_laws()  # which say what entries may be
    fields = custom.fields(package)
    for name, raw in entries.items():
        if name not in fields:
            raise custom.unknown(name, raw, package)
    read = {name: fields[name].read(raw, from_file=from_file) for name, raw in entries.items()}
    for ways in ALTERNATIVES:
        first, *others = [name for name in ways if name in entries] or [""]
        for name in others:
            problem = f"is given together with {first} = {excerpt(entries[first])}"
            raise InputError(name, entries[name], "only one of " + ", ".join(ways), problem)
    return read


def check_replaced(entries: Mapping[str, Any], changes: Mapping[str, Any]) -> None:
    """Raise InputError, with the remedy, for a change that sets one entry where the scene gives an equivalent one."""
    for ways in ALTERNATIVES:
        for name in (way for way in ways if way in changes):
            for other in (way for way in ways if way in entries and way not in changes):
                problem = f"is given together with {other} = {excerpt(entries[other])}, which the scene has"
                instead = "--speed or --stokes, or --relative-speed" if name.startswith("impact.") else f"{other} here"
                accepted = f"only one of {', '.join(ways)}: set {instead}, or edit the scene file"
                raise InputError(name, changes[name], accepted, problem)


def missing(entries: Mapping[str, Any], tables: Iterable[str] = ()) -> Refused:
    """Entries that are not in a table that is present or required."""
    present = {name.partition(".")[0] for name in entries} | {*tables, *REQUIRED_TABLES}
    for table in (table for table in TABLES if table in present):
        for ways in (ways for ways in ALTERNATIVES if ways[0].startswith(table) and table in ONE_OF_EACH):
            if not any(name in entries for name in ways):
                yield ways[0], " or ".join(f"{name} = {FIELDS[name].example}" for name in ways), "missing"
        absent = [name for name in TABLES[table] if FIELDS[name].required and name not in entries]
        if absent:
            also = f" (and so {'is' if len(absent) == 2 else 'are'} {', '.join(absent[1:])})" if absent[1:] else ""
            yield absent[0], FIELDS[absent[0]].accepts, "missing" + also
    pair = ("particles.youngs_modulus", "particles.poisson_ratio")
    for here, other in (pair, pair[::-1]):
        if here in entries and other not in entries:
            problem = f"missing while {here} = {excerpt(entries[here])} is given"
            yield other, f"{FIELDS[other].accepts}, or neither of the two", problem


def liquid_rules(entries: Mapping[str, Any], package: custom.Package | None) -> Refused:
    """Entries of another law of liquids, or a law that nothing is made for.

    With `newtonian`, given as such, those of the other laws stand idle.
    """
    law = entries.get("liquid.law", NEWTONIAN)
    of_laws = dict.fromkeys(f"liquid.{name}" for names in LIQUIDS.values() for name in names)
    own = [f"liquid.{name}" for name in LIQUIDS.get(law, ())]
    choices = ", ".join(own) or "no such entry, or liquid.law one of " + ", ".join(LIQUIDS)
    for name in of_laws if law != NEWTONIAN or "liquid.law" not in entries else ():
        if name in entries and name not in own:
            yield name, choices, f"is no entry of liquid.law = {law}"
    if law not in LIQUIDS:
        return
    if package is not None and package.table != "liquid":
        accepted = f"{NEWTONIAN}: a law of one's own may have a viscosity of its own"
        yield "liquid.law", accepted, f"is given together with the model {package.name}"
    for name in own:
        if name not in entries and FIELDS[name].default is None:
            yield name, FIELDS[name].accepts, f"missing while liquid.law = {law}"
    if entries.get("model.film", "finite") not in FILMS_OF_LIQUIDS:
        yield "model.film", ", ".join(FILMS_OF_LIQUIDS), f"is not there for liquid.law = {law}"
    if law not in THINNING:
        return
    thickens = f"thickens, which {law} does not"
    if FIELDS["liquid.flow_index"].number(entries["liquid.flow_index"]) > 1:
        yield "liquid.flow_index", "a number > 0 and at most 1", thickens
    least, most = "liquid.infinite_shear_viscosity", "liquid.viscosity"
    ends = [FIELDS[name].number(entries[name]) for name in (least, most) if name in entries]
    if len(ends) == 2 and ends[0] > ends[1]:
        yield least, f"at most {most} = {excerpt(entries[most])}", thickens


def way_rules(entries: Mapping[str, Any], values: Mapping[str, Any]) -> Refused:
    """Entries (as stored, and in SI) without others that they require."""
    coating, its, volume = "liquid.coating_thickness", "partner.coating_thickness", entries.get("bridge.volume")
    for name, other in _NEEDS.items():
        if name in entries and other not in entries:
            accepted = f"{other} = {FIELDS[other].example} beside it, or no such entry"
            if other == coating:
                accepted = f"{coating} beside it: liquid.film_thickness is both coatings together"
            yield name, accepted, f"is given without {other}"
    if coating in entries and "partner.wall" in entries and its not in entries:
        yield its, f"{FIELDS[its].accepts}, or 0 um for a dry wall", f"missing while {coating} is given"
    if coating in entries and not 0 < initial_gap(values) < math.inf:
        yield coating, "a coating on one of the two, and a film of some length", "makes no film"
    if volume == FROM_COATING and coating not in entries:
        accepted = f"{coating} beside it, a number V/R^3, or a volume with its unit"
        yield "bridge.volume", accepted, f"is given without {coating}"
    if "partner.contact_angle" in entries and volume is None:
        yield "partner.contact_angle", "no such entry, or a [bridge]", "is given without a bridge"
    fraction = "bridge.coating_fraction"
    if fraction in entries and volume != FROM_COATING:
        accepted = f'bridge.volume = "{FROM_COATING}" beside it, or no such entry'
        yield fraction, accepted, f"is given with bridge.volume = {excerpt(volume)}"
    if fraction in entries and "partner.wall" in entries:
        yield fraction, "no such entry beside a wall", "is no part of a wall's liquid"


def _lengths(scene: System) -> Refused:
    """The film between the gaps of contact and rupture, and strings that let the spheres swing around each other."""
    entries, x0, ruptured = dict(scene.given), scene.liquid.film_thickness, scene.rupture_gap
    film_text = f"the film of both coatings, {x0:.4g} m"
    if "liquid.film_thickness" in entries:
        film_text = f"liquid.film_thickness = {excerpt(entries['liquid.film_thickness'])}"
    for word in AT_ANY_SPEED:
        name = REMOVERS[word]
        if name in entries and gap_at_any_speed(word, scene.material) >= 1:
            yield name, f"{FIELDS[name].what} below {film_text}", "is not below the film thickness"
    if scene.bridge is not None and not x0 < ruptured < math.inf:
        radius = 2 * scene.reduced_radius
        ratio = x0 / (radius * (1 + scene.material["contact_angle"] / 2))
        least = ratio * ratio * ratio  # ** would raise OverflowError; this becomes inf
        if math.isinf(least):
            name = _given_alternative("particles.reduced_radius", entries)
            yield name, f"a radius that is not so small beside {film_text}", "is too small for a bridge across the film"
        problem = f"ruptures at x_f = {ruptured:.4g} m, not beyond the film thickness {x0:.4g} m"
        yield "bridge.volume", _larger(entries["bridge.volume"], scene.bridge.rupture, least, radius), problem
    if scene.pendulum is not None:
        # the strings are most inclined at beta = pi, where each pivot is d = (r + 4a)/2 from its sphere
        least = 4 * scene.reduced_radius + ruptured / 2
        if scene.pendulum.length <= least:
            accepted = f"a string length above 4a + x_f/2 = {least:.6g} m"
            yield "pendulum.length", accepted, "is too short for two spheres to swing around each other"


def _given_alternative(first: str, entries: Mapping[str, Any]) -> str:
    """The one of several equivalent entries that is given."""
    ways = next(ways for ways in ALTERNATIVES if ways[0] == first)
    return next(name for name in ways if name in entries)


def _larger(volume: object, rupture: str, least: float, radius: float) -> str:
    """The accepted volumes in words, for one that is too small."""
    if volume == FROM_COATING:
        return "a larger bridge.coating_fraction, a thinner coating, or a volume of its own"
    if rupture != "common":
        return "a larger volume" if isinstance(volume, str) else "a larger number V/R^3"
    if isinstance(volume, str):
        return f"a volume above {least * radius * radius * radius:.4g} m^3"
    return f"a number V/R^3 above {least:.4g}"


def _partner(scene: System) -> Refused:
    """Spins and partners: strings need equal spheres without spin, a wall has none, and ratios must be finite."""
    entries = dict(scene.given)
    for spin in (name for name in SPINS if name in entries and scene.pendulum is not None):
        accepted = "no such entry beside [pendulum]: there the collision ends where the rotation reverses"
        yield spin, accepted, "is given together with strings"
    if scene.wall and "impact.partner_spin" in entries:
        yield "impact.partner_spin", "impact.spin alone beside a wall", "is of a wall, which does not spin"
    if scene.partner is None:
        return
    if scene.pendulum is not None:
        entry = _given_alternative("partner.radius", entries)
        yield entry, "no [partner] beside [pendulum]", "is given together with strings"
    for name, ratio in (("partner.radius", scene.radius_ratio), ("partner.mass", scene.mass_ratio)):
        if ratio is not None and not FARTHEST**-1 <= ratio <= FARTHEST:
            accepted = f"a partner of {FARTHEST**-1:g} to {FARTHEST:g} times the sphere's, or wall = true"
            yield _given_alternative(name, entries), accepted, "is too far from the sphere's"


def _laws(scene: System) -> Refused:
    """Laws that contradict each other or the scene's tables."""
    bridge = scene.bridge
    if scene.law_has("film", "spread"):
        if bridge is None:
            others = ", ".join(scene.laws_with("film", "spread", False))
            yield "model.film", f"a [bridge], whose volume it is, or one of {others}", "needs a bridge"
        for entry, slot in (("model.glass", "glass"), ("model.tangential", "shear")):
            if scene.law_has(slot, "rim"):
                problem = "has its rim at x0, which a film of constant volume has not"
                yield entry, f"another {entry}, or another model.film", problem
    if bridge is not None and bridge.rupture == "own" and not scene.law_has("bridge", "rupture_distance"):
        accepted = f"common, or own with bridge.law one of {', '.join(scene.laws_with('bridge', 'rupture_distance'))}"
        yield "bridge.rupture", accepted, f"is not known for the law {bridge.law}"
    if never_touching(scene.material):
        positive = f"a positive {' or '.join(reversed(REMOVERS.values()))}"
        if scene.attraction is not None and scene.attraction.hamaker > 0:
            problem = "lets the gap close, where the van der Waals attraction is without bounds"
            yield "particles.roughness", positive, problem
        if scene.liquid.glass_transition_pressure is None:
            problem = "lets the gap close without end: no criterion reverses the spheres"
            yield "particles.roughness", f"{positive}, or liquid.glass_transition_pressure", problem


def speed_rules(scene: System) -> Refused:
    """A Stokes number or a speed that leaves the range of a double."""
    entries, a = dict(scene.given), scene.reduced_radius
    drag = 6 * math.pi * scene.liquid.viscosity * a * a
    if not 0 < drag < math.inf or not 0 < scene.stokes_per_speed < math.inf:
        given = _given_alternative("particles.reduced_mass", entries)
        yield given, "a mass that makes m/(6 pi mu a^2) a finite number", "is too far off"
    if scene.speed is None:
        return
    for name in (name for name in SPEEDS if name in entries):
        counterpart = scene.speed if name == "impact.stokes" else scene.stokes
        if not (counterpart and counterpart < math.inf):
            yield name, FIELDS[name].accepts, "is too far off for this scene"


TOGETHER = (_partner, _laws, _lengths, speed_rules)
"""Rules for a scene whose entries are valid one by one."""
