"""Two wet bodies in plain SI numbers, and the scalar laws of the gap between them, written from the documents.

Nothing here comes from the package but the entries of a scene.
"""

import math
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from wetdoublet.solvers import Scene

PI = math.pi
_NODES, _WEIGHTS = (each.tolist() for each in np.polynomial.legendre.leggauss(8))
_WILLETT = (  # coefficients of 1, phi, phi^2 for each power of ln V, as printed
    (
        (-0.44507, 0.050832, -1.1466),
        (-0.1119, -0.000411, -0.1490),
        (-0.012101, -0.0036456, -0.01255),
        (-0.0005, -0.0003505, -0.00029076),
    ),
    ((1.9222, -0.57473, -1.2918), (-0.0668, -0.1201, -0.22574), (-0.0013375, -0.0068988, -0.01137)),
    (
        (1.268, -0.01396, -0.23566),
        (0.198, 0.092, -0.06418),
        (0.02232, 0.02238, -0.009853),
        (0.0008585, 0.001318, -0.00053),
    ),
    ((-0.010703, 0.073776, -0.34742), (0.03345, 0.04543, -0.09056), (0.0018574, 0.004456, -0.006257)),
)


@dataclass(frozen=True)
class Bodies:
    """SI numbers of a collision; the second body is a wall if its radius is infinite.

    Arguments:
        law: of the bridge; empty without one.
        volume: of the bridge, m^3.
        own_rupture: the bridge ruptures where the authors of its law say.
        friction, beta_0: of the dry contact (None: no tangential impulse), and whether glass has it too.
    """

    radii: tuple[float, float]
    masses: tuple[float, float]
    viscosity: float
    film_thickness: float
    roughness: float
    dry_restitution: float
    glass: float = math.inf
    modulus: float = math.inf
    poisson: float = 0.0
    law: str = ""
    tension: float = 0.0
    volume: float = 0.0
    wetting: float = 0.0
    own_rupture: bool = False
    hamaker: float = 0.0
    film: str = "finite"
    tangential: str = "immersed"
    glass_law: str = "literal"
    arm: str = "midgap"
    friction: float | None = None
    beta_0: float | None = None
    friction_in_glass: bool = False

    @property
    def wall(self) -> bool:
        return math.isinf(self.radii[1])

    @property
    def a(self) -> float:
        one, other = self.radii
        return one if self.wall else one * other / (one + other)

    @property
    def m(self) -> float:
        one, other = self.masses
        return one if self.wall else one * other / (one + other)

    @property
    def inertias(self) -> tuple[float, float]:
        one, other = (0.4 * mass * radius**2 for mass, radius in zip(self.masses, self.radii, strict=True))
        return one, other

    @property
    def contact(self) -> float:
        """Distance of the centres at contact, R_1 + R_2."""
        return self.radii[0] + self.radii[1]

    @property
    def neck(self) -> float:
        """The R that the bridge's laws mean: 2a."""
        return 2 * self.a

    @property
    def relative_volume(self) -> float:
        """V = volume/R^3."""
        return self.volume / self.neck**3

    @cached_property
    def edge(self) -> float:
        """Gap beyond which nothing resists sliding."""
        return self.film_thickness if self.tangential == "film" else 2 * self.a

    @cached_property
    def rupture(self) -> float:
        """Gap at which the bodies separate."""
        if not self.law:
            return self.film_thickness
        v, phi = self.relative_volume, self.wetting
        reach = v ** (1 / 3) * (1 + phi / 2)
        if self.own_rupture and self.law.startswith("mikami"):
            reach = (0.62 * phi + 0.99) * v**0.34
        elif self.own_rupture and self.law.startswith("willett"):
            reach = (1 + phi / 2) * (v ** (1 / 3) + v ** (2 / 3) / 10)
        return self.neck * reach

    def elastic_gap(self, speed: float) -> float:
        """Gap at which the bodies' elasticity stops this approach; 0 for rigid ones."""
        theta = 2 * (1 - self.poisson**2) / (PI * self.modulus)
        return float((3 * PI * theta * self.viscosity * self.a**1.5 * speed / math.sqrt(2)) ** 0.4)

    # ---- forces

    def wets(self, inside: bool, opening: bool) -> bool:
        """Whether the film resists at all: `inside` it, or anywhere if it has a constant volume."""
        return self.film == "constant-volume" or (inside and not (opening and self.film == "cavitating"))

    def drag(self, x: float) -> float:
        """Normal lubrication force over the opening velocity, of a film that resists."""
        whole = 6 * PI * self.viscosity * self.a**2 / x
        if self.film == "constant-volume":
            return whole * (1 - x / math.sqrt(x * x + self.volume / (PI * self.a))) ** 2
        return whole if self.film == "infinite" else whole * (1 - x / self.film_thickness) ** 2

    @cached_property
    def friction_matrix(self) -> tuple[float, float, float]:
        """Torques over ln(edge/x) per rate of slip: of the first by its own, of either by the other's, of the second.

        Beside a wall: torque by spin, torque by sliding (or force by spin), force by sliding.
        """
        k, (one, other) = 0.4 * PI * self.viscosity * self.a, self.radii
        if self.wall:
            return 8 * k * one**2, 2 * k * one, 8 * k
        return 8 * k * one**2, 2 * k * one * other, 8 * k * other**2

    def pressure(self, x: float, u: float) -> float:
        """Pressure on the axis of the glass criterion."""
        rim = 1 / self.film_thickness**2 if self.glass_law == "film-corrected" else 0.0
        return -3 * self.viscosity * self.a * u * (1 / x**2 - rim)

    def pull(self, x: float) -> float:
        """All that attracts: bridge and van der Waals."""
        found = self.hamaker * self.a / (6 * x * x) if self.hamaker else 0.0
        return found + self._bridge(x) if self.law else found

    @cached_property
    def _mikami(self) -> tuple[float, float, float]:
        v, phi = self.relative_volume, self.wetting
        log = math.log10(v) if self.law == "mikami-log10" else math.log(v)
        if self.law == "soulie":
            return -1.1 * v**-0.53, (-0.148 * log - 0.96) * phi**2 - 0.0082 * log + 0.48, 0.0018 * log + 0.078
        return -1.1 * v**-0.53, (-0.34 * log - 0.96) * phi**2 - 0.019 * log + 0.48, 0.0042 * log + 0.078

    @cached_property
    def _willett(self) -> list[float]:
        log, phi = math.log(self.relative_volume), self.wetting
        return [sum((p + q * phi + r * phi**2) * log**k for k, (p, q, r) in enumerate(rows)) for rows in _WILLETT]

    def _bridge(self, x: float) -> float:
        h, v, phi = x / self.neck, self.relative_volume, self.wetting
        if self.law in ("mikami", "mikami-log10", "soulie"):
            a, b, c = self._mikami
            shape = math.exp(a * h + b) + c
        elif self.law == "willett-simple":
            s = h / math.sqrt(v)
            shape = 2 * math.cos(phi) / (1 + s * (1.05 + 2.5 * s))
        elif self.law == "willett":
            f1, f2, f3, f4 = self._willett
            log = math.log(h / (2 * math.sqrt(v)))
            shape = 2 * math.exp(f1 - f2 * math.exp(f3 * log + f4 * log**2))
        elif self.law == "constant":
            shape = 2 * math.cos(phi)
        elif self.law in ("lambert", "rabinovich"):
            s = math.sqrt(h * h + 2 * v / PI)
            shape = 2 * math.cos(phi) * (1 - h / s)
            if self.law == "rabinovich":
                filling = math.sqrt(2 * v / PI / (s + h))  # sqrt(s - h)
                shape += 2 * math.sin(filling) * math.sin(filling + phi)
        else:
            raise NotImplementedError(self.law)
        return PI * self.neck * self.tension * shape

    # ---- the energy it takes to part

    @cached_property
    def _potential(self) -> tuple[np.ndarray, np.ndarray]:
        """Gaps up to rupture, and the energy of the attraction there, 0 at rupture."""
        gaps = np.geomspace(1e-7 * self.film_thickness, self.rupture, 400)
        energy = [0.0]
        for low, high in zip(gaps[-2::-1], gaps[:0:-1], strict=True):
            energy.append(energy[-1] - self._work(float(low), float(high)))
        return gaps, np.array(energy[::-1])

    def _work(self, low: float, high: float) -> float:
        """Work against the attraction between two gaps not far apart, by Gauss' rule in the logarithm."""
        half, middle = math.log(high / low) / 2, math.sqrt(low * high)
        at = [middle * math.exp(half * node) for node in _NODES]
        return half * sum(weight * x * self.pull(x) for weight, x in zip(_WEIGHTS, at, strict=True))

    def potential(self, x: float) -> float:
        """Energy of the attraction at a gap; 0 at rupture."""
        gaps, energy = self._potential
        k = bisect_right(gaps, x)
        return 0.0 if k >= len(gaps) else float(energy[k]) - self._work(x, float(gaps[k]))

    def barrier(self, x: float, momentum: float) -> float:
        """The most energy that attraction and rigid rotation with this angular momentum have between x and rupture."""
        gaps, energy = self._potential
        k = min(bisect_right(gaps, x), len(gaps) - 1)
        if self.wall:
            return float(energy[k:].max())
        inertia = self.m * (self.contact + gaps[k:]) ** 2 + sum(self.inertias)
        return float((energy[k:] + momentum**2 / (2 * inertia)).max())

    @property
    def cohesive(self) -> bool:
        return bool(self.law and self.tension) or self.hamaker > 0.0


def bodies_of(scene: Scene) -> Bodies:
    """The numbers of a scene's entries."""
    particles, liquid, bridge, partner = scene.particles, scene.liquid, scene.bridge, scene.partner
    radius, mass = 2 * particles.reduced_radius, 2 * particles.reduced_mass
    other = (radius, mass)
    if partner is not None:
        other = (math.inf, math.inf) if scene.wall else (float(partner.radius or 0.0), float(partner.mass or 0.0))
    reduced = radius if scene.wall else radius * other[0] / (radius + other[0])
    more = {}
    if bridge is not None:
        more = {
            "law": str(bridge.law), "tension": bridge.surface_tension, "volume": bridge.volume * (2 * reduced) ** 3,
            "wetting": bridge.contact_angle, "own_rupture": bridge.rupture == "own",
        }  # fmt: skip
    if particles.youngs_modulus is not None and particles.poisson_ratio is not None:
        more |= {"modulus": particles.youngs_modulus, "poisson": particles.poisson_ratio}
    if liquid.glass_transition_pressure is not None:
        more["glass"] = liquid.glass_transition_pressure
    if particles.friction is not None:
        more |= {
            "friction": particles.friction,
            "beta_0": particles.contact_tangential_restitution,
            "friction_in_glass": scene.model.contact_friction == "all",
        }
    return Bodies(
        radii=(radius, other[0]),
        masses=(mass, other[1]),
        viscosity=liquid.viscosity,
        film_thickness=liquid.film_thickness,
        roughness=particles.roughness,
        dry_restitution=particles.dry_restitution,
        hamaker=scene.attraction.hamaker if scene.attraction else 0.0,
        film=scene.model.film,
        tangential=scene.model.tangential,
        glass_law=scene.model.glass,
        arm=scene.model.arm,
        **more,
    )
