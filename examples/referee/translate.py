"""From a scene to the parameters of a host's force law, in SI units, and what has no counterpart, in words.

Sources of the meanings: YADE's class reference (`LubricationPhys`, `Law2_ScGeom_ImplicitLubricationPhys`,
`ViscElCapMat`, `ViscElMat`) with pkg/dem/Lubrication.cpp and pkg/dem/ViscoelasticCapillarPM.cpp; LAMMPS's pages
`pair_style granular` and `pair_style lubricate` with src/COLLOID/pair_lubricate.cpp; LIGGGHTS's page `gran cohesion
easo/capillary/viscous` with its source.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from wetdoublet import Scene

GLASS = {"youngs_modulus": 70e9, "poisson_ratio": 0.2}  # where a scene has none: said in the report
YADE_BRIDGES = {  # laws of a scene -> YADE's names of the same formulas
    "willett": "Willett_numeric",
    "willett-simple": "Willett_analytic",
    "lambert": "Lambert",
    "rabinovich": "Rabinovich",
    "soulie": "Soulie",
}
Changes = dict[str, Any]  # entries of a scene by dotted name; None removes an entry or a table


@dataclass(frozen=True)
class Translation:
    """A scene in the words of a host.

    Arguments:
        parameters: what the script that runs in the host reads, SI.
        end: gap beyond which the host's law exerts no force, m.
        step: working time step as the host's manual advises, s.
        gap: changes that give our model the host's regularised gap; None where the law has none.
        physics: changes that take from our model, one after the other, what the host's law lacks: (name, changes).
        rest: what then still differs.
        at_distance: whether the law acts before the solids touch; if not, an oblique pair may pass without contact.
        missing: what has no counterpart, or is assumed, in words.
    """

    parameters: dict[str, Any]
    end: float
    step: float
    gap: Changes | None
    physics: list[tuple[str, Changes]]
    rest: str
    missing: list[str] = field(default_factory=list)
    at_distance: bool = True


def check(scene: Scene) -> None:
    """Refuse what the referee does not compare."""
    for table in ("partner", "pendulum", "attraction"):
        if getattr(scene, table) is not None:
            raise SystemExit(f"[{table}] of the scene has no counterpart in the hosts' laws: leave it out")
    if scene.impact.spin or scene.impact.partner_spin:
        raise SystemExit("spin before the collision: not translated")
    if scene.package is not None:
        raise SystemExit("a scene with laws of its own cannot be translated")


def yade_lubrication(scene: Scene, gap: float | None, _speed: float) -> Translation:
    """`Law2_ScGeom_ImplicitLubricationPhys`: lubrication in series with linear elastic spheres.

    Normal force 3/2 pi eta R^2 u'/u of the gap u between the deformed surfaces; contact at u = 2 eps R, eps 0.001 by
    default; normal stiffness k_n = E R for equal spheres.
    """
    common, missing = _solid(scene)
    radius = common["radius"]
    regular = 2 * 0.001 * radius if gap is None else gap
    film = _film(scene, regular)
    step = 0.1 * math.sqrt(scene.reduced_mass / (common["youngs_modulus"] * radius))
    common |= {"viscosity": scene.liquid.viscosity, "eps": regular / (2 * radius), "cutoff": film}
    missing += [
        (
            f"eps = {common['eps']:.3g} (contact at a gap of {regular:.3g} m; roughness of the scene "
            f"{scene.particles.roughness:.3g} m)"
        ),
        f"MaxDist = {film / radius:.3g} radii (2 by default, for immersed suspensions): the film's edge",
        "dry_restitution: the contact is elastic; all dissipation is the liquid's",
        "the film's edge (1 - x/x0)^2: the host's force is that of an infinite film and ends with a jump at MaxDist",
    ]
    return Translation(
        common,
        film,
        step,
        {"particles.roughness": regular},
        _dry_film(scene, 1.0),
        "elastic surfaces beneath the film, and the host's tangential force",
        missing + _no_bridge(scene) + _no_glass(scene),
    )


def yade_capillary(scene: Scene, gap: float | None, _speed: float) -> Translation:
    """`Law2_ScGeom_ViscElCapPhys_Basic`: linear damped contact, and a bridge from the first dry contact to rupture."""
    _needs_bridge(scene, gap)
    assert scene.bridge is not None
    common, missing = _solid(scene)
    radius, volume = common["radius"], scene.bridge.volume
    law = YADE_BRIDGES.get(scene.bridge.law, "Soulie" if scene.bridge.law.startswith("mikami") else "Willett_analytic")
    # the duration of a contact of stiffness E R, and a thirtieth of it as time step
    duration = math.pi * math.sqrt(scene.reduced_mass / (common["youngs_modulus"] * radius))
    angle = scene.bridge.contact_angle
    rupture = radius * (1 + angle / 2) * (volume ** (1 / 3) + 0.1 * volume ** (2 / 3))  # critDist() of the host
    common |= {
        "contact_time": duration,
        "restitution": uncut_restitution(_positive(scene)),
        "volume": volume * radius**3,
        "surface_tension": scene.bridge.surface_tension,
        "contact_angle_deg": math.degrees(angle),
        "bridge": law,
        "cutoff": max(rupture, scene.liquid.film_thickness),
    }
    if scene.bridge.law not in YADE_BRIDGES:
        missing.append(f"bridge law {scene.bridge.law}: the host has {law}")
    missing += [
        (
            f"tc = {duration:.3g} s, of a contact of stiffness E R; en = {common['restitution']:.5g}, which acts as "
            f"the scene's {scene.particles.dry_restitution:g}: the host cuts the contact's tension off"
        ),
        "the film: the bridge forms when the solids touch and not when the films do",
        "viscosity: the law has none (dcap, a constant damping of the bridge, is 0 by default)",
    ]
    end: float = common["cutoff"]
    return Translation(
        common,
        end,
        duration / 30,
        None,
        [("viscosity", {"liquid.viscosity": scene.liquid.viscosity * 1e-6, **_without_glass(scene)})],
        "bridge formed at dry contact, its law and rupture, duration of the contact",
        missing + _no_glass(scene),
        at_distance=False,
    )


def lammps_lubricate(scene: Scene, gap: float | None, speed: float) -> Translation:
    """`pair_style hybrid/overlay granular lubricate`: lubrication of rigid spheres, and a dry Hertzian contact.

    Normal resistance 6 pi mu R (1/(4 h) + 9/40 ln 1/h), tangential 6 pi mu R (1/6) ln 1/h, h = x/R, both constant below
    the gap that `cutinner` says: 0.01 R in the manual's example (`lubricate 1.5 1 1 2.01 2.5`).
    """
    common, missing = _solid(scene)
    radius = common["radius"]
    regular = 0.01 * radius if gap is None else gap
    film = _film(scene, regular)
    # an explicit scheme: a fifth of the time that the film takes to stop the spheres at the least gap
    rate = 1.5 * math.pi * scene.liquid.viscosity * radius**2 / (regular * scene.reduced_mass)
    step = min(_hertz_time(scene, common, speed) / 50, 0.2 / rate)
    common |= {"viscosity": scene.liquid.viscosity, "inner": regular, "cutoff": film, "restitution": _positive(scene)}
    missing += [
        (
            f"cutinner = {2 + regular / radius:.5g} R (least gap {regular:.3g} m; roughness of the scene "
            f"{scene.particles.roughness:.3g} m): the spheres touch at gap 0"
        ),
        f"cutoff = {2 + film / radius:.5g} R: the film's edge; FLD terms off, no volume fraction",
        "the film's edge (1 - x/x0)^2: the host's force is that of an infinite film and ends with a jump at the cutoff",
    ]
    return Translation(
        common,
        film,
        step,
        {"particles.roughness": regular},
        _dry_film(scene, scene.particles.dry_restitution),
        "the layer below the least gap, the host's second term 9/40 ln 1/h, its surface lever arm",
        missing + _no_friction(scene) + _no_bridge(scene) + _no_glass(scene),
    )


def lammps_cohesive(model: str) -> Callable[[Scene, float | None, float], Translation]:
    """`pair_style granular` with `jkr` or `dmt`, damping viscoelastic."""

    def translated(scene: Scene, gap: float | None, speed: float) -> Translation:
        _needs_bridge(scene, gap)
        assert scene.bridge is not None
        common, missing = _solid(scene)
        pull_off = 2 * math.pi * common["radius"] * scene.bridge.surface_tension * math.cos(scene.bridge.contact_angle)
        energy = pull_off / ({"jkr": 3, "dmt": 4}[model] * math.pi * scene.reduced_radius)
        damping = viscoelastic_damping(scene, common, speed)
        common |= {"normal": model, "damping": damping, "surface_energy": energy}
        missing += [
            f"gamma = {energy:.4g} J/m^2: pull-off force equal to the bridge's at contact, 2 pi R sigma cos(phi)",
            (
                f"eta_n0 = {damping:.4g} 1/(m s): restitution {scene.particles.dry_restitution:g} of dry spheres at "
                f"{speed:.3g} m/s; restitution itself cannot be given (tsuji, coeff_restitution) beside cohesion"
            ),
            "film, viscosity, volume of the bridge: cohesion begins and ends with the solids' contact",
        ]
        return Translation(
            common,
            scene.liquid.film_thickness,
            _hertz_time(scene, common, speed) / 50,
            None,
            [
                ("viscosity", {"liquid.viscosity": scene.liquid.viscosity * 1e-6, **_without_glass(scene)}),
                ("bridge", {"bridge": None}),
            ],
            "cohesion of the solids, damping that depends on speed",
            missing + _no_friction(scene) + _no_glass(scene),
            at_distance=False,
        )

    return translated


def liggghts_easo(scene: Scene, gap: float | None, speed: float) -> Translation:
    """`cohesion easo/capillary/viscous` with `model hertz`: a bridge from the first dry contact, and its viscosity.

    Normal force 6 pi mu a u/max(minSeparationDistanceRatio, x/a), with a = R/2. The manual recommends 1.01 for that
    ratio: a least gap of 1.01 a.
    """
    _needs_bridge(scene, None)
    assert scene.bridge is not None
    common, missing = _solid(scene)
    radius, a, angle = common["radius"], scene.reduced_radius, scene.bridge.contact_angle
    regular = 1.01 * a if gap is None else gap
    rupture = (1 + angle / 2) * scene.bridge.volume ** (1 / 3) * radius
    share = (1 - math.sqrt(0.75)) * 4 / 3 * math.pi  # of both spheres' liquid that flows into the bridge, over R^3
    common |= {
        "restitution": _positive(scene),
        "min_separation": regular / a,
        "max_separation": max(1.1, 1 + 1.01 * rupture / (2 * radius)),
        "liquid_content": scene.bridge.volume / share,
        "surface_tension": scene.bridge.surface_tension,
        "viscosity": scene.liquid.viscosity,
        # read in degrees; the law has half the product of both angles in rad, and so this one
        "contact_angle": math.degrees(math.sqrt(2 * angle)),
    }
    below = regular < scene.liquid.film_thickness
    missing += [
        (
            f"contactAngle = {common['contact_angle']:.4g} deg: half the product of both is the scene's "
            f"{math.degrees(angle):.3g} deg, in rad"
        ),
        (
            f"minSeparationDistanceRatio = {regular / a:.4g}: a least gap of {regular:.3g} m (roughness of the scene "
            f"{scene.particles.roughness:.3g} m, film {scene.liquid.film_thickness:.3g} m)"
        ),
        "the film before contact: the bridge, and with it the viscous force, begins when the solids touch",
        f"bridge law {scene.bridge.law}: the host has soulie" if scene.bridge.law != "soulie" else "",
    ]
    viscosity = {"liquid.viscosity": scene.liquid.viscosity * 1e-6, **_without_glass(scene)}
    return Translation(
        common,
        max(rupture, scene.liquid.film_thickness),
        _hertz_time(scene, common, speed) / 50,
        {"particles.roughness": regular} if below else None,
        [("viscosity", viscosity)],
        "the host's viscosity (from contact on, constant below the least gap) and bridge",
        [words for words in missing if words] + _no_friction(scene) + _no_glass(scene),
        at_distance=False,
    )


LAWS: dict[tuple[str, str], Callable[[Scene, float | None, float], Translation]] = {
    ("yade", "lubrication"): yade_lubrication,
    ("yade", "capillary"): yade_capillary,
    ("lammps", "lubricate"): lammps_lubricate,
    ("lammps", "jkr"): lammps_cohesive("jkr"),
    ("lammps", "dmt"): lammps_cohesive("dmt"),
    ("liggghts", "easo"): liggghts_easo,
}


def changed(scene: Scene, changes: Changes) -> Scene:
    """The scene with entries replaced, and those that are None left out."""
    tables = scene.with_entries({name: value for name, value in changes.items() if value is not None}).to_dict()
    for name, value in changes.items():
        table, _, key = name.partition(".")
        if value is None:
            (tables[table] if key else tables).pop(key or table, None)
    return Scene.from_dict(tables)


def uncut_restitution(restitution: float) -> float:
    """The `en` of YADE whose linear damped contact rebounds with this restitution.

    Damping follows from en = exp(-pi z), z = damping over frequency, as if the contact ended at zero overlap. It ends
    where its force vanishes, as tension is cut off, and rebounds with exp(-2 z arctan(1/z)), which is above exp(-2).
    """
    if restitution < 0.1354:
        raise SystemExit(f"dry_restitution = {restitution:g}: this law has 0.1354 or more, whatever its en")
    if restitution == 1:
        return 1.0
    z = brentq(lambda z: 2 * z * math.atan2(1, z) + math.log(restitution), 0.0, 1e3, xtol=1e-15)
    return math.exp(-math.pi * z)


def viscoelastic_damping(scene: Scene, common: dict[str, Any], speed: float) -> float:
    """eta_n0 at which a dry Hertzian contact, F = eta_n0 m sqrt(a d) d', has the scene's restitution at this speed."""
    target = _positive(scene)
    if target == 1:
        return 0.0
    stiffness = 2 / 3 * _modulus(common) * math.sqrt(scene.reduced_radius)  # 4/3 E*, E* half the plane-strain modulus
    depth = (scene.reduced_mass * speed**2 / stiffness) ** 0.4

    def restitution(strength: float) -> float:
        def motion(_: float, y: Any) -> list[float]:
            return [y[1], -(max(y[0], 0.0) ** 1.5) - strength * math.sqrt(max(y[0], 0.0)) * y[1]]

        def apart(t: float, y: Any) -> float:
            return float(y[0]) if t > 0.1 else 1.0

        apart.terminal = True  # type: ignore[attr-defined]  # as scipy asks
        solution = solve_ivp(motion, (0, 200), [0.0, 1.0], events=apart, rtol=1e-9, atol=1e-12)
        return float(-solution.y[1, -1])

    strength: float = brentq(lambda s: restitution(s) - target, 0.0, 30.0, xtol=1e-10)
    return strength * speed / float(depth * math.sqrt(scene.reduced_radius * depth))


def _solid(scene: Scene) -> tuple[dict[str, Any], list[str]]:
    """Spheres and their elasticity, and what had to be assumed."""
    check(scene)
    radius, mass = 2 * scene.reduced_radius, 2 * scene.reduced_mass
    sphere: dict[str, Any] = {
        "radius": radius,
        "density": mass / (4 / 3 * math.pi * radius**3),
        "friction": math.atan(scene.particles.friction or 0.0),
        "youngs_modulus": scene.particles.youngs_modulus,
        "poisson_ratio": scene.particles.poisson_ratio,
    }
    if scene.particles.youngs_modulus is not None:
        return sphere, []
    return sphere | GLASS, ["no elastic constants in the scene: 70 GPa and 0.2 of glass"]


def _modulus(common: dict[str, Any]) -> float:
    return float(common["youngs_modulus"] / (1 - common["poisson_ratio"] ** 2))


def _hertz_time(scene: Scene, common: dict[str, Any], speed: float) -> float:
    """The duration of a dry Hertzian contact, 2.94 d/v with the greatest depth d."""
    stiffness = 2 / 3 * _modulus(common) * math.sqrt(scene.reduced_radius)
    depth = float((1.25 * scene.reduced_mass * speed**2 / stiffness) ** 0.4)
    return 2.94 * depth / speed


def _film(scene: Scene, regular: float) -> float:
    film = scene.liquid.film_thickness
    if not regular < film:
        raise SystemExit(
            f"the host's least gap, {regular:.3g} m, is not below the film's thickness, {film:.3g} m: --gap"
        )
    return film


def _positive(scene: Scene) -> float:
    if not scene.particles.dry_restitution > 0:
        raise SystemExit("dry_restitution = 0 has no counterpart in the hosts: they take its logarithm")
    return scene.particles.dry_restitution


def _needs_bridge(scene: Scene, gap: float | None) -> None:
    if scene.bridge is None:
        raise SystemExit("this law is one of cohesion, and the scene has no [bridge]")
    if gap is not None:
        raise SystemExit("this law has no gap that --gap could set")


def _without_glass(scene: Scene) -> Changes:
    has = scene.liquid.glass_transition_pressure is not None
    return {"liquid.glass_transition_pressure": None} if has else {}


def _no_glass(scene: Scene) -> list[str]:
    return ["glass_transition_pressure: no law of the host has it"] if _without_glass(scene) else []


def _no_friction(scene: Scene) -> list[str]:
    return ["friction: switched off in this host"] if scene.particles.friction else []


def _no_bridge(scene: Scene) -> list[str]:
    return ["[bridge]: cannot be combined with this law of the host"] if scene.bridge is not None else []


def _dry_film(scene: Scene, restitution: float) -> list[tuple[str, Changes]]:
    """What a law of lubrication lacks: the edge of the film, the bridge, the glass and elastic criteria."""
    steps: list[tuple[str, Changes]] = [("film edge", {"model.film": "infinite"})]
    if scene.bridge is not None:
        steps.append(("bridge", {"bridge": None}))
    elastic = {"particles.youngs_modulus": None, "particles.poisson_ratio": None}
    rules = _without_glass(scene) | (elastic if scene.particles.youngs_modulus is not None else {})
    if scene.particles.dry_restitution != restitution:
        rules["particles.dry_restitution"] = restitution
    if rules:
        steps.append(("rebound rule", rules))
    return steps
