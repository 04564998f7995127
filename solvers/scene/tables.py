"""The tables of a scene, in SI; immutable, and each validates its own entries."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from .schema import FIELDS


@dataclass(frozen=True)
class Table:
    """Base of the tables; every entry is read by its `Field` of the schema."""

    name: ClassVar[str]

    def __post_init__(self) -> None:
        """Read every entry by its `Field`; InputError names the first wrong one."""
        for key in (field.name for field in dataclasses.fields(self)):
            value = getattr(self, key)
            if value is not None:
                object.__setattr__(self, key, FIELDS[f"{self.name}.{key}"].read(value))

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Self:
        """Return the table of entries already read, without reading them again (a user's model may add laws)."""
        table = object.__new__(cls)
        for field in dataclasses.fields(cls):
            object.__setattr__(table, field.name, values.get(field.name, field.default))
        return table


@dataclass(frozen=True)
class Particles(Table):
    """The spheres: a (m), m (kg), x_b (m), e_dry, E (Pa) and nu (both None: no elastic rebound criterion), mu_f (None:
    no friction) and beta_0 of the dry contact.

    a = R/2 and m = M/2 of either sphere; with a `Partner`, of the first. `Scene.reduced_radius` is that of the pair.
    """

    name: ClassVar[str] = "particles"
    reduced_radius: float
    reduced_mass: float
    roughness: float
    dry_restitution: float
    friction: float | None = None
    contact_tangential_restitution: float | None = None
    youngs_modulus: float | None = None
    poisson_ratio: float | None = None


@dataclass(frozen=True)
class Liquid(Table):
    """The film: mu (Pa s), x0 (m), p_gt (Pa; None: no glass criterion), density (kg/m^3; for the Reynolds number)."""

    name: ClassVar[str] = "liquid"
    viscosity: float
    film_thickness: float
    glass_transition_pressure: float | None = None
    density: float | None = None


@dataclass(frozen=True)
class Bridge(Table):
    """The capillary bridge: sigma (N/m), V/R^3 with R = 2a, phi (rad), the force law and the rupture law."""

    name: ClassVar[str] = "bridge"
    surface_tension: float
    volume: float
    contact_angle: float = 0.0
    law: str = "mikami"
    rupture: str = "common"


@dataclass(frozen=True)
class Attraction(Table):
    """Van der Waals attraction: the Hamaker constant (J)."""

    name: ClassVar[str] = "attraction"
    hamaker: float


@dataclass(frozen=True)
class Partner(Table):
    """The collision partner: another sphere, R (m) and M (kg), or a wall (`wall` is "true")."""

    name: ClassVar[str] = "partner"
    radius: float | None = None
    mass: float | None = None
    wall: str | None = None


@dataclass(frozen=True)
class Pendulum(Table):
    """The pendulum strings: l (m), g (m/s^2), exact or for small angles."""

    name: ClassVar[str] = "pendulum"
    length: float
    gravity: float = 9.81
    law: str = "exact"


@dataclass(frozen=True)
class Model(Table):
    """The selected variants of the equations."""

    name: ClassVar[str] = "model"
    arm: str = "midgap"
    tangential: str = "immersed"
    glass: str = "literal"
    film: str = "finite"
    contact_friction: str = "solid"


@dataclass(frozen=True)
class Impact(Table):
    """Initial contact: Stokes number, normal or relative speed (m/s), angle (rad), which may be given later, and spins.

    Spins are in rad/s; a spin that is not given is None.
    """

    name: ClassVar[str] = "impact"
    stokes: float | None = None
    speed: float | None = None
    relative_speed: float | None = None
    angle: float | None = None
    spin: float | None = None
    partner_spin: float | None = None
