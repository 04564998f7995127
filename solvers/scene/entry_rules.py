"""Rules for the entries of a scene together: none unknown, duplicate or missing; lengths in order."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..errors import InputError, shown
from . import user_model as custom
from .quantities import partner_mass, sphere
from .schema import ALTERNATIVES, BRIDGE_LAWS, FIELDS, ONE_OF_EACH, REQUIRED_TABLES, TABLES, unknown_entry
from .tables import Attraction, Bridge, Partner, Pendulum, Table

if TYPE_CHECKING:
    from .system import System
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


def check_entries(entries: Mapping[str, Any], package: Package | None = None, *, from_file: bool = False) -> None:
    """Raise InputError for an entry that is unknown, wrong by itself, or an alternative to another given one."""
    known = custom.fields(package)
    for name, raw in entries.items():
        if name not in known:
            raise custom.unknown(name, raw, package) or unknown_entry(name, raw)
    for name, raw in entries.items():
        known[name].read(raw, from_file=from_file)
    for ways in ALTERNATIVES:
        first, *others = [name for name in ways if name in entries] or [""]
        if others:
            problem = f"is given together with {first} = {shown(entries[first])}"
            raise InputError(others[0], entries[others[0]], "only one of " + ", ".join(ways), problem)


def check_replaced(given: Mapping[str, Any], changes: Mapping[str, Any]) -> None:
    """Raise InputError, with the remedy, for a change to an alternative of an entry that the scene has."""
    for ways in ALTERNATIVES:
        for name in (way for way in ways if way in changes):
            for other in (way for way in ways if way in given and way not in changes):
                problem = f"is given together with {other} = {shown(given[other])}, which the scene has"
                instead = "--speed or --stokes" if name.startswith("impact.") else f"{other} here"
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
            problem = f"missing while {here} = {shown(entries[here])} is given"
            raise InputError(absent, None, f"{FIELDS[absent].accepts}, or neither of the two", problem)


def spheres(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of `Particles`: a = R/2 and m = M/2 from radius, mass or density."""
    of = {key: value for key, value in _of("particles", values).items() if key not in ("radius", "mass", "density")}
    return of | sphere(values)


def partner(values: Mapping[str, Any]) -> Partner | None:
    """Return the partner, its mass from mass or density; None if the spheres are equal."""
    of = _of("partner", values)
    if "density" in of:
        of["mass"] = partner_mass(values)
        del of["density"]
    return Partner(**of) if of else None


def _of(table: str, values: Mapping[str, Any]) -> dict[str, Any]:
    return {name.partition(".")[2]: value for name, value in values.items() if name.startswith(table + ".")}


def table(kind: type[Table], values: Mapping[str, Any]) -> Table | None:
    """Return the table with its entries; None for an absent table that is optional."""
    keys = [field.name for field in dataclasses.fields(kind)]
    own = {key: values[f"{kind.name}.{key}"] for key in keys if f"{kind.name}.{key}" in values}
    return None if not own and kind in (Attraction, Bridge, Pendulum) else kind.of(own)


def check_together(scene: System) -> None:
    """Raise InputError where entries are valid one by one but not together."""
    given = dict(scene.given)
    _check_partner(scene)
    _check_laws(scene)
    particles, film, ruptured = scene.particles, scene.liquid.film_thickness, scene.rupture_gap
    if particles.roughness >= film:
        problem = "is not below the film thickness"
        accepted = f"a roughness below liquid.film_thickness = {shown(given['liquid.film_thickness'])}"
        raise InputError("particles.roughness", given["particles.roughness"], accepted, problem)
    if scene.bridge is not None and not film < ruptured < math.inf:
        ratio = film / (2 * scene.reduced_radius * (1 + scene.bridge.contact_angle / 2))
        least = ratio * ratio * ratio  # ** would raise OverflowError; this becomes inf
        if math.isinf(least):
            name = next(each for each in ("particles.reduced_radius", "particles.radius") if each in given)
            accepted = (
                f"a radius that is not so small beside liquid.film_thickness = {shown(given['liquid.film_thickness'])}"
            )
            raise InputError(name, given[name], accepted, "is too small for a bridge across the film")
        problem = f"ruptures at x_f = {ruptured:.4g} m, not beyond the film thickness {film:.4g} m"
        accepted = f"a number V/R^3 above {least:.4g}" if scene.bridge.rupture == "common" else "a larger number V/R^3"
        raise InputError("bridge.volume", given["bridge.volume"], accepted, problem)
    if scene.pendulum is not None:
        # the strings are most inclined at beta = pi, where each pivot is d = (r + 4a)/2 from its sphere
        least = 4 * scene.reduced_radius + ruptured / 2
        if scene.pendulum.length <= least:
            problem = "is too short for two spheres to swing around each other"
            accepted = f"a string length above 4a + x_f/2 = {least:.6g} m"
            raise InputError("pendulum.length", given["pendulum.length"], accepted, problem)
    _check_speed(scene)


def _check_partner(scene: System) -> None:
    """Raise InputError for an invalid partner: strings need equal spheres, and ratios must be finite."""
    if scene.partner is None:
        return
    given = dict(scene.given)
    entry = "partner.radius" if "partner.radius" in given else "partner.wall"
    if scene.pendulum is not None:
        raise InputError(entry, given[entry], "no [partner] beside [pendulum]", "is given together with strings")
    for name, ratio in (("partner.radius", scene.radius_ratio), ("partner.mass", scene.mass_ratio)):
        if ratio is not None and not FARTHEST**-1 <= ratio <= FARTHEST:
            known = name if name in given else "partner.density"
            accepted = f"a partner of {FARTHEST**-1:g} to {FARTHEST:g} times the sphere's, or wall = true"
            raise InputError(known, given[known], accepted, "is too far from the sphere's")


FARTHEST = 1e4  # largest ratio of radii or masses; beyond it the equations lose digits (use the limit, a wall)


def _check_laws(scene: System) -> None:
    """Raise InputError for laws that contradict each other or the scene's tables."""
    model, bridge, given = scene.model, scene.bridge, dict(scene.given)
    if model.film == "constant-volume":
        if bridge is None:
            accepted = "a [bridge], whose volume it is, or one of finite, infinite, cavitating"
            raise InputError("model.film", model.film, accepted, "needs a bridge")
        for entry, value, fixed in (
            ("model.glass", model.glass, "film-corrected"),
            ("model.tangential", model.tangential, "film"),
        ):
            if value == fixed:
                accepted = f"another {entry}, or another model.film"
                raise InputError(entry, value, accepted, "has its rim at x0, which a film of constant volume has not")
    if bridge is not None and bridge.rupture == "own" and bridge.law not in OWN_RUPTURE:
        accepted = f"common, or own with bridge.law one of {', '.join(OWN_RUPTURE)}"
        problem = f"is not known for the law {bridge.law}"
        raise InputError("bridge.rupture", bridge.rupture, accepted, problem)
    no_contact = scene.particles.roughness == 0 and scene.particles.youngs_modulus is None
    if scene.attraction is not None and scene.attraction.hamaker > 0 and no_contact:
        accepted = "a roughness above 0, or particles.youngs_modulus and poisson_ratio"
        problem = "lets the gap close, where the van der Waals attraction is without bounds"
        raise InputError("particles.roughness", given["particles.roughness"], accepted, problem)


OWN_RUPTURE = tuple(law for law in BRIDGE_LAWS if law not in ("rabinovich", "lambert", "constant"))
"""Bridge laws whose authors give a rupture distance with them."""


def _check_speed(scene: System) -> None:
    """Raise InputError if the Stokes number or the speed leaves the range of a double."""
    given, a = dict(scene.given), scene.reduced_radius
    drag = 6 * math.pi * scene.liquid.viscosity * a * a
    if not 0 < drag < math.inf or not 0 < scene.stokes_per_speed < math.inf:
        accepted = "a mass that makes m/(6 pi mu a^2) a finite number"
        raise InputError("particles.reduced_mass", scene.reduced_mass, accepted, "is too far off")
    for name, counterpart in (("impact.speed", scene.stokes), ("impact.stokes", scene.speed)):
        if name in given and not (counterpart and counterpart < math.inf):
            raise InputError(name, given[name], FIELDS[name].accepts, "is too far off for this scene")
