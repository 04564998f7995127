"""Rules for the entries of a scene together: none unknown, duplicate or missing; lengths in order."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..errors import InputError, excerpt
from ..host import emitted
from . import user_model as custom
from .contact import AT_ANY_SPEED, ENTRIES, gap_at_any_speed, never_touching
from .quantities import Ways, initial_gap, partner_mass, partner_radius, quantities, sphere
from .schema import (
    ALTERNATIVES,
    FIELDS,
    FROM_COATING,
    LIQUIDS,
    MEETING,
    NEWTONIAN,
    ONE_OF_EACH,
    REQUIRED_TABLES,
    SPINS,
    TABLES,
    unknown_entry,
)
from .tables import Attraction, Bridge, Liquid, Particles, Partner, Pendulum, Table

if TYPE_CHECKING:
    from .groups import System
    from .user_model import Package


_LONGEST_NAME = 1000  # characters; the name is the title of figures and an attribute of files


def check_name(name: object) -> None:
    """Raise InputError unless the name is text that a file can hold."""
    if not isinstance(name, str):
        raise InputError("name", name, "text", "is not text")
    try:
        name.encode()
    except UnicodeEncodeError:
        raise InputError("name", name, "text", "cannot be written as UTF-8") from None
    if "\0" in name or len(name) > _LONGEST_NAME:
        raise InputError("name", name, f"text of at most {_LONGEST_NAME} characters", "is no name")


def check_pairs(pairs: object, label: str) -> None:
    """Raise InputError unless these are pairs of a dotted name and a value."""
    accepted = "pairs of a dotted name and a value, such as (('liquid.viscosity', '2 Pa s'), ...)"
    if not isinstance(pairs, (tuple, list)):
        raise InputError(label, pairs, accepted, "is no list of pairs")
    for pair in pairs:
        if not isinstance(pair, tuple) or len(pair) != 2 or not isinstance(pair[0], str):
            raise InputError(label, pair, accepted, "is no such pair")


def check_package(package: object) -> None:
    """Raise InputError unless this is an opened `Package` or None."""
    if package is not None and not isinstance(package, custom.Package):
        raise InputError("package", package, "a Package, or None: models are opened by Scene.load(..., model=DIR)")


def grouped(entries: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries grouped by table, otherwise in their order."""
    tables = dict.fromkeys(name.partition(".")[0] for name in entries)
    return {name: entries[name] for table in tables for name in entries if name.partition(".")[0] == table}


def check_entries(
    entries: Mapping[str, Any], package: Package | None = None, *, from_file: bool = False
) -> dict[str, float | str]:
    """Return the entries in SI; InputError for one that is unknown, wrong by itself, or an alternative to another."""
    emitted.check_laws()  # which say what entries may be
    fields = custom.fields(package)
    for name, raw in entries.items():
        if name not in fields:
            raise custom.unknown(name, raw, package) or unknown_entry(name, raw)
    read = {name: fields[name].read(raw, from_file=from_file) for name, raw in entries.items()}
    for ways in ALTERNATIVES:
        first, *others = [name for name in ways if name in entries] or [""]
        if others:
            problem = f"is given together with {first} = {excerpt(entries[first])}"
            raise InputError(others[0], entries[others[0]], "only one of " + ", ".join(ways), problem)
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


def check_complete(entries: Mapping[str, Any], tables: Mapping[str, Any] | None = None) -> None:
    """Raise InputError for an entry that is missing from a table that is present or required."""
    present = {name.partition(".")[0] for name in entries} | set(tables or ()) | set(REQUIRED_TABLES)
    for table in TABLES:
        if table not in present:
            continue
        missing = [name for name in TABLES[table] if FIELDS[name].required and name not in entries]
        choices = [ways for ways in ALTERNATIVES if ways[0].startswith(table) and table in ONE_OF_EACH]
        for ways in choices:
            if not any(name in entries for name in ways):
                either = " or ".join(f"{name} = {FIELDS[name].example}" for name in ways)
                raise InputError(ways[0], None, either, "missing")
        if missing:
            also = f" (and so {'is' if len(missing) == 2 else 'are'} {', '.join(missing[1:])})" if missing[1:] else ""
            raise InputError(missing[0], None, FIELDS[missing[0]].accepts, "missing" + also)
    pair = ("particles.youngs_modulus", "particles.poisson_ratio")
    for here, absent in (pair, pair[::-1]):
        if here in entries and absent not in entries:
            problem = f"missing while {here} = {excerpt(entries[here])} is given"
            raise InputError(absent, None, f"{FIELDS[absent].accepts}, or neither of the two", problem)


def check_liquid(entries: Mapping[str, Any], package: Package | None) -> None:
    """InputError for entries of another law of liquids, or a law that nothing is made for.

    With `newtonian`, given as such, those of the other laws stand idle.
    """
    law = entries.get("liquid.law", NEWTONIAN)
    of_laws = dict.fromkeys(f"liquid.{name}" for names in LIQUIDS.values() for name in names)
    own = [f"liquid.{name}" for name in LIQUIDS.get(law, ())]
    for name in (name for name in of_laws if name in entries and name not in own):
        if law == NEWTONIAN and "liquid.law" in entries:
            continue
        choices = ", ".join(own) or "no such entry, or liquid.law one of " + ", ".join(LIQUIDS)
        raise InputError(name, entries[name], choices, f"is no entry of liquid.law = {law}")
    if law not in LIQUIDS:
        return
    if package is not None and package.table != "liquid":
        accepted = f"{NEWTONIAN}: a law of one's own may have a viscosity of its own"
        raise InputError("liquid.law", law, accepted, f"is given together with the model {package.name}")
    for name in own:
        if name not in entries and FIELDS[name].default is None:
            raise InputError(name, None, FIELDS[name].accepts, f"missing while liquid.law = {law}")
    if (film := entries.get("model.film", "finite")) not in FILMS_OF_LIQUIDS:
        raise InputError("model.film", film, ", ".join(FILMS_OF_LIQUIDS), f"is not there for liquid.law = {law}")
    if law in THINNING and FIELDS["liquid.flow_index"].number(entries["liquid.flow_index"]) > 1:
        raise InputError(
            "liquid.flow_index",
            entries["liquid.flow_index"],
            "a number > 0 and at most 1",
            f"thickens, which {law} does not",
        )
    least, most = "liquid.infinite_shear_viscosity", "liquid.viscosity"
    ends = [FIELDS[name].number(entries[name]) for name in (least, most) if law in THINNING and name in entries]
    if len(ends) == 2 and ends[0] > ends[1]:
        accepted = f"at most {most} = {excerpt(entries[most])}"
        raise InputError(least, entries[least], accepted, f"thickens, which {law} does not")


FILMS_OF_LIQUIDS, THINNING = ("finite", "cavitating"), ("cross", "carreau")


def check_ways(entries: Mapping[str, Any], values: Mapping[str, Any]) -> None:
    """InputError for entries (as stored, and in SI) without others that they require."""
    for name in ("particles.contact_tangential_restitution", "model.contact_friction"):
        if name in entries and "particles.friction" not in entries:
            accepted = f"particles.friction = {FIELDS['particles.friction'].example} beside it, or no such entry"
            raise InputError(name, entries[name], accepted, "is given without particles.friction")
    coating, its, fraction = "liquid.coating_thickness", "partner.coating_thickness", "bridge.coating_fraction"
    if its in entries and coating not in entries:
        accepted = f"{coating} beside it: liquid.film_thickness is both coatings together"
        raise InputError(its, entries[its], accepted, f"is given without {coating}")
    if coating in entries and "partner.wall" in entries and its not in entries:
        raise InputError(
            its, None, f"{FIELDS[its].accepts}, or 0 um for a dry wall", f"missing while {coating} is given"
        )
    if coating in entries and not 0 < initial_gap(values) < math.inf:
        raise InputError(
            coating, entries[coating], "a coating on one of the two, and a film of some length", "makes no film"
        )
    volume = entries.get("bridge.volume")
    if volume == FROM_COATING and coating not in entries:
        accepted = f"{coating} beside it, a number V/R^3, or a volume with its unit"
        raise InputError("bridge.volume", volume, accepted, f"is given without {coating}")
    wetted = "partner.contact_angle"
    if wetted in entries and volume is None:
        raise InputError(wetted, entries[wetted], "no such entry, or a [bridge]", "is given without a bridge")
    if fraction in entries and volume != FROM_COATING:
        accepted = f'bridge.volume = "{FROM_COATING}" beside it, or no such entry'
        raise InputError(fraction, entries[fraction], accepted, f"is given with bridge.volume = {excerpt(volume)}")
    if fraction in entries and "partner.wall" in entries:
        raise InputError(fraction, entries[fraction], "no such entry beside a wall", "is no part of a wall's liquid")


def spheres(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of `Particles`: a = R/2 and m = M/2 from radius, mass or density."""
    return table_of(Particles, values) | sphere(values)


def partner(values: Mapping[str, Any]) -> Partner | None:
    """Return the partner, its mass from mass or density; None if the spheres are equal."""
    of = {"radius": partner_radius(values), "mass": partner_mass(values), "wall": values.get("partner.wall")}
    return None if of["radius"] is None and of["wall"] is None else Partner(**of)


def table_of(kind: type[Table], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of a table under their own names."""
    keys = [field.name for field in dataclasses.fields(kind)]
    return {key: values[f"{kind.name}.{key}"] for key in keys if f"{kind.name}.{key}" in values}


def table(kind: type[Table], values: Mapping[str, Any], ways: Ways) -> Table | None:
    """Return the table with its entries; None for an absent table that is optional."""
    entries = table_of(kind, values)
    if kind is Liquid:
        entries["film_thickness"] = initial_gap(values)
    if kind is Bridge and entries and ways.volume != "relative":
        entries["volume"] = _relative_volume(values, ways)
    return None if not entries and kind in (Attraction, Bridge, Pendulum) else kind.of(entries)


def _relative_volume(values: Mapping[str, Any], ways: Ways) -> float:
    """V/R^3 of a volume that is given in m^3 or by coatings."""
    try:
        volume = float(quantities({k: v for k, v in values.items() if k not in MEETING}, ways)["volume"])
    except (OverflowError, ZeroDivisionError):
        volume = math.inf
    if not 0 < volume < math.inf:
        raise InputError("bridge.volume", values["bridge.volume"], FIELDS["bridge.volume"].accepts, "is too far off")
    return volume


def check_together(scene: System) -> None:
    """Raise InputError where entries are valid one by one but not together."""
    entries = dict(scene.given)
    _check_partner(scene)
    _check_laws(scene)
    x0 = scene.liquid.film_thickness
    film_text = _film_in_words(entries, x0)
    ruptured = scene.rupture_gap
    for word in AT_ANY_SPEED:
        name = ENTRIES[word]
        if name in entries and gap_at_any_speed(word, scene.material) >= 1:
            accepted = f"{FIELDS[name].what} below {film_text}"
            raise InputError(name, entries[name], accepted, "is not below the film thickness")
    if scene.bridge is not None and not x0 < ruptured < math.inf:
        radius = 2 * scene.reduced_radius
        ratio = x0 / (radius * (1 + scene.material["contact_angle"] / 2))
        least = ratio * ratio * ratio  # ** would raise OverflowError; this becomes inf
        if math.isinf(least):
            name = _given_alternative("particles.reduced_radius", entries)
            accepted = f"a radius that is not so small beside {film_text}"
            raise InputError(name, entries[name], accepted, "is too small for a bridge across the film")
        problem = f"ruptures at x_f = {ruptured:.4g} m, not beyond the film thickness {x0:.4g} m"
        raise InputError("bridge.volume", entries["bridge.volume"], _larger(scene, least, radius), problem)
    if scene.pendulum is not None:
        # the strings are most inclined at beta = pi, where each pivot is d = (r + 4a)/2 from its sphere
        least = 4 * scene.reduced_radius + ruptured / 2
        if scene.pendulum.length <= least:
            problem = "is too short for two spheres to swing around each other"
            accepted = f"a string length above 4a + x_f/2 = {least:.6g} m"
            raise InputError("pendulum.length", entries["pendulum.length"], accepted, problem)
    check_speed(scene)


def _film_in_words(entries: Mapping[str, Any], x0: float) -> str:
    """The film thickness in words, as the scene gives it."""
    if "liquid.film_thickness" in entries:
        return f"liquid.film_thickness = {excerpt(entries['liquid.film_thickness'])}"
    return f"the film of both coatings, {x0:.4g} m"


def _given_alternative(first: str, entries: Mapping[str, Any]) -> str:
    """The one of several equivalent entries that is given."""
    ways = next(ways for ways in ALTERNATIVES if ways[0] == first)
    return next(name for name in ways if name in entries)


def _larger(scene: System, least: float, radius: float) -> str:
    """The accepted volumes in words, for one that is too small."""
    volume, common = dict(scene.given)["bridge.volume"], scene.bridge is not None and scene.bridge.rupture == "common"
    if volume == FROM_COATING:
        return "a larger bridge.coating_fraction, a thinner coating, or a volume of its own"
    if isinstance(volume, str):
        return f"a volume above {least * radius * radius * radius:.4g} m^3" if common else "a larger volume"
    return f"a number V/R^3 above {least:.4g}" if common else "a larger number V/R^3"


def _check_partner(scene: System) -> None:
    """Raise InputError for an invalid partner: strings need equal spheres, and ratios must be finite."""
    entries = dict(scene.given)
    for spin in (name for name in SPINS if name in entries):
        if scene.pendulum is not None:
            accepted = "no such entry beside [pendulum]: there the collision ends where the rotation reverses"
            raise InputError(spin, entries[spin], accepted, "is given together with strings")
    if scene.wall and "impact.partner_spin" in entries:
        name = "impact.partner_spin"
        raise InputError(name, entries[name], "impact.spin alone beside a wall", "is of a wall, which does not spin")
    if scene.partner is None:
        return
    entry = _given_alternative("partner.radius", entries)
    if scene.pendulum is not None:
        raise InputError(entry, entries[entry], "no [partner] beside [pendulum]", "is given together with strings")
    for name, ratio in (("partner.radius", scene.radius_ratio), ("partner.mass", scene.mass_ratio)):
        if ratio is not None and not FARTHEST**-1 <= ratio <= FARTHEST:
            given = _given_alternative(name, entries)
            accepted = f"a partner of {FARTHEST**-1:g} to {FARTHEST:g} times the sphere's, or wall = true"
            raise InputError(given, entries[given], accepted, "is too far from the sphere's")


FARTHEST = 1e4  # largest ratio of radii or masses; beyond it the equations lose digits (use the limit, a wall)


def _check_laws(scene: System) -> None:
    """Raise InputError for laws that contradict each other or the scene's tables."""
    model, bridge, entries = scene.model, scene.bridge, dict(scene.given)
    if scene.law_has("film", "spread"):
        if bridge is None:
            accepted = (
                f"a [bridge], whose volume it is, or one of {', '.join(scene.laws_with('film', 'spread', False))}"
            )
            raise InputError("model.film", model.film, accepted, "needs a bridge")
        for entry, slot in (("model.glass", "glass"), ("model.tangential", "shear")):
            if scene.law_has(slot, "rim"):
                accepted = f"another {entry}, or another model.film"
                raise InputError(
                    entry, scene.law_of(slot), accepted, "has its rim at x0, which a film of constant volume has not"
                )
    if bridge is not None and bridge.rupture == "own" and not scene.law_has("bridge", "rupture_distance"):
        accepted = f"common, or own with bridge.law one of {', '.join(scene.laws_with('bridge', 'rupture_distance'))}"
        problem = f"is not known for the law {bridge.law}"
        raise InputError("bridge.rupture", bridge.rupture, accepted, problem)
    no_contact = never_touching(scene.material)
    if scene.attraction is not None and scene.attraction.hamaker > 0 and no_contact:
        accepted = f"a positive {' or '.join(reversed(ENTRIES.values()))}"
        problem = "lets the gap close, where the van der Waals attraction is without bounds"
        raise InputError("particles.roughness", entries["particles.roughness"], accepted, problem)
    if scene.liquid.glass_transition_pressure is None and no_contact:
        accepted = f"a positive {' or '.join(reversed(ENTRIES.values()))}, or liquid.glass_transition_pressure"
        problem = "lets the gap close without end: no criterion reverses the spheres"
        raise InputError("particles.roughness", entries["particles.roughness"], accepted, problem)


def check_speed(scene: System) -> None:
    """Raise InputError if the Stokes number or the speed leaves the range of a double."""
    entries, a = dict(scene.given), scene.reduced_radius
    drag = 6 * math.pi * scene.liquid.viscosity * a * a
    if not 0 < drag < math.inf or not 0 < scene.stokes_per_speed < math.inf:
        accepted = "a mass that makes m/(6 pi mu a^2) a finite number"
        raise InputError("particles.reduced_mass", scene.reduced_mass, accepted, "is too far off")
    if scene.speed is None:
        return
    for name, counterpart in (
        ("impact.speed", scene.stokes),
        ("impact.relative_speed", scene.stokes),
        ("impact.stokes", scene.speed),
    ):
        if name in entries and not (counterpart and counterpart < math.inf):
            raise InputError(name, entries[name], FIELDS[name].accepts, "is too far off for this scene")
