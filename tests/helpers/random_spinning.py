"""Random scenes of any two wet bodies that arrive with spins: a few models, and numbers for each that matter."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene

from .spinning import Impact

LAWS = ("mikami", "willett-simple", "constant", "lambert", "", "mikami", "willett", "soulie", "", "rabinovich")
PARTNERS = ("equal", "pair", "wall", "pair", "equal", "pair", "equal")
FASTEST = 5.0  # surface speed of a spin, over the approach speed


@dataclass(frozen=True)
class Model:
    """Structure and laws, which scenes share with what an engine compiles for them."""

    partner: str
    law: str
    film: str
    tangential: str
    glass: str
    rupture: str
    attracted: bool
    elastic: bool


def models(count: int, seed: int) -> list[Model]:
    """So many models: partners and bridge laws in turn, the rest at random."""
    draw = np.random.default_rng((seed, 1))
    found = []
    for k in range(count):
        law = LAWS[k % len(LAWS)]
        film = str(draw.choice(("finite", "finite", "infinite", "cavitating", *(("constant-volume",) if law else ()))))
        rim = film != "constant-volume"  # which has none at x0
        found.append(
            Model(
                partner=PARTNERS[k % len(PARTNERS)],
                law=law,
                film=film,
                tangential=str(draw.choice(("immersed", "film"), p=(0.6, 0.4))) if rim else "immersed",
                glass=str(draw.choice(("literal", "film-corrected"), p=(0.7, 0.3))) if rim else "literal",
                rupture=str(draw.choice(("common", "own"), p=(0.8, 0.2))) if law in ("mikami", "willett") else "common",
                attracted=bool(draw.random() < 0.3),
                elastic=bool(draw.random() < 0.5),
            )
        )
    return found


def numbers(model: Model, draw: np.random.Generator) -> dict[str, float]:
    """Entries with numbers, SI, by dotted name."""

    def log(low: float, high: float) -> float:
        return float(low * (high / low) ** draw.random())

    radius, density, viscosity = log(5e-6, 5e-3), log(300.0, 8000.0), log(1e-3, 10.0)
    mass = 4 / 3 * math.pi * radius**3 * density
    ratio, other = log(0.1, 10.0), log(0.3, 3.0)
    pair = model.partner == "pair"
    sizes = {"equal": (0.5, 0.5), "wall": (1.0, 1.0), "pair": (ratio / (1 + ratio), _reduced(other * ratio**3))}
    a, m = radius * sizes[model.partner][0], mass * sizes[model.partner][1]
    x0, stokes = a * log(1e-3, 0.2), log(0.01, 30.0)
    speed = stokes * 6 * math.pi * viscosity * a**2 / m
    pressure = 3 * viscosity * a * speed / x0**2
    found = {
        "particles.radius": radius,
        "particles.mass": mass,
        "particles.roughness": x0 * log(1e-4, 0.5),
        "particles.dry_restitution": 1.0 if not model.law and draw.random() < 0.2 else float(draw.uniform(0.2, 0.98)),
        "liquid.viscosity": viscosity,
        "liquid.film_thickness": x0,
        "liquid.glass_transition_pressure": pressure * log(0.5, 1e5),
        "impact.stokes": stokes,
        "impact.angle": 0.0 if draw.random() < 0.2 else math.radians(float(draw.uniform(0.0, 85.0))),
        "impact.spin": _spin(draw) * speed / radius,
    }
    if pair:
        found |= {"partner.radius": radius * ratio, "partner.mass": mass * other * ratio**3}
    if model.partner != "wall":
        opposite = -found["impact.spin"] if draw.random() < 0.1 else _spin(draw) * speed / radius
        same = draw.random() < 0.25
        found["impact.partner_spin"] = found["impact.spin"] if same else opposite / (ratio if pair else 1.0)
    if model.elastic:
        theta = (x0 * log(1e-4, 0.5)) ** 2.5 * math.sqrt(2) / (3 * math.pi * viscosity * a**1.5 * speed)
        poisson = float(draw.uniform(0.0, 0.5))
        found |= {
            "particles.youngs_modulus": 2 * (1 - poisson**2) / (math.pi * theta),
            "particles.poisson_ratio": poisson,
        }
    if model.law:
        least = 2.0 * (x0 / (2 * a)) ** 3
        found |= {
            "bridge.surface_tension": 3 * viscosity * a * speed / x0 / log(3.0, 1e5),
            "bridge.volume": log(max(1e-4, least), 0.5),
            "bridge.contact_angle": max(0.0, math.radians(float(draw.uniform(-20.0, 80.0)))),
        }
    if model.attracted:
        found["attraction.hamaker"] = 36 * math.pi * viscosity * a * speed * x0 * log(1e-6, 1e-2)
    return {name: float(f"{value:.9g}") for name, value in found.items()}


def _reduced(ratio: float) -> float:
    return ratio / (1 + ratio)


def _spin(draw: np.random.Generator) -> float:
    """Surface speed over the approach speed: at times none."""
    return 0.0 if draw.random() < 0.15 else float(draw.uniform(-FASTEST, FASTEST))


def tables(model: Model, entries: dict[str, float]) -> dict[str, Any]:
    """The tables of a scene, as `Scene.from_dict` takes them."""
    found: dict[str, Any] = {}
    choices: dict[str, Any] = {
        "model.film": model.film,
        "model.glass": model.glass,
        "model.tangential": model.tangential,
    }
    if model.law:
        choices |= {"bridge.law": model.law, "bridge.rupture": model.rupture}
    if model.partner == "wall":
        choices["partner.wall"] = True
    for name, value in (*entries.items(), *choices.items()):
        table, _, key = name.partition(".")
        found.setdefault(table, {})[key] = value
    return found


def scenes(count: int, seed: int, of: int = 24) -> Iterator[tuple[Model, dict[str, float]]]:
    """So many random scenes of `of` models, each model's one after another."""
    every = models(min(of, count), seed)
    for k, model in enumerate(every):
        draw = np.random.default_rng((seed, 2, k))
        for _ in range(count // len(every) + (k < count % len(every))):
            yield model, numbers(model, draw)


def impact_of(scene: Scene) -> Impact:
    """Speed, angle and spins of a scene; a partner's spin that is left out equals the first's."""
    speed, angle = scene.need_impact()
    spin = float(scene.entries.get("impact.spin", 0.0))
    return Impact(speed, angle, spin, float(scene.entries.get("impact.partner_spin", spin)))


def with_friction(described: dict[str, Any], draw: np.random.Generator) -> dict[str, Any]:
    """The tables of the same scene with a friction of its dry contact, at times on glass too."""
    coefficient, beta = 10 ** draw.uniform(-2.0, 0.3), draw.uniform(0.0, 1.0)
    entries = {"friction": float(f"{coefficient:.6g}"), "contact_tangential_restitution": float(f"{beta:.6g}")}
    model = {"contact_friction": "all"} if draw.random() < 0.4 else {}
    return described | {"particles": described["particles"] | entries, "model": described["model"] | model}
