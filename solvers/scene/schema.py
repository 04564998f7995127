"""All entries of a scene, one declaration each: type, what is accepted, unit, range, default, and what it means.

The tables are immutable and in SI; what they are called is their class in small letters. The page of scene files, the
messages and the quantities (`quantities`) follow from these declarations.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

from ..host.emitted import LAWS
from .fields import ANY, FRACTION, IMPACT_ANGLE, NOT_NEGATIVE, PART, POISSON, POSITIVE, WETTING_ANGLE, Field, Range

NEWTONIAN = "newtonian"
LIQUIDS: dict[str, tuple[str, ...]] = {
    "power-law": ("flow_index", "reference_rate", "plateau_rate"),
    "cross": ("flow_index", "relaxation_time", "infinite_shear_viscosity"),
    "carreau": ("flow_index", "relaxation_time", "infinite_shear_viscosity"),
    "herschel-bulkley": ("yield_stress", "flow_index", "reference_rate", "plateau_rate"),
}
"""Laws of liquids -> their entries beside the viscosity."""
SHEAR_RATE = "a shear rate"
"""What an entry in 1/s is; its unit has the dimension of an angular velocity."""
FROM_COATING = "from coating"
"""Value of `bridge.volume` for a bridge whose liquid flows out of the coatings."""
LEAST_ANGLE = 1e-200  # rad; an impact at a smaller one is head-on: its rotation rate may underflow

FIELDS: dict[str, Field] = {}
"""Dotted name -> what it is, in the order of the documentation."""

TABLES: dict[str, tuple[str, ...]] = {}
"""Table -> dotted names of its entries."""

KINDS: dict[str, type[Table]] = {}
"""Table -> its class."""


class Table:
    """Base of the tables, made by keywords.

    An entry whose type allows None has that value where it is not given, not its default; one that has neither must be
    given.
    """

    name: ClassVar[str]
    keys: ClassVar[Mapping[str, str]]  # by dotted name

    def __init_subclass__(cls) -> None:
        """Give every declaration its name, and the attribute its default."""
        cls.name = cls.__name__.lower()
        cls.keys = {f"{cls.name}.{key}": key for key in cls.__annotations__}
        for name, key in cls.keys.items():
            declared = vars(cls)[key]
            field = FIELDS[name] = Field(name, **declared.metadata)
            optional = cls.__annotations__[key].endswith("None")
            declared.default = None if optional else dataclasses.MISSING if field.default is None else field.default
            declared.kw_only = True  # what must be given may stand behind what need not
        KINDS[cls.name], TABLES[cls.name] = cls, tuple(cls.keys)

    def __post_init__(self) -> None:
        """Read every entry by its `Field`; InputError names the first wrong one."""
        for name, key in self.keys.items():
            if (value := getattr(self, key)) is not None:
                object.__setattr__(self, key, FIELDS[name].read(value))

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Self:
        """Return the table of entries already read, by dotted name (a user's model may add laws)."""
        table = object.__new__(cls)
        table.__dict__.update((key, values.get(name, getattr(cls, key, None))) for name, key in cls.keys.items())
        return table


def entry(what: str, example: str, accepted: Range = POSITIVE, **more: Any) -> Any:
    """Declare an entry of a table by the arguments of `Field`; the text below it says what it means."""
    return dataclasses.field(metadata={"what": what, "example": example, "range": accepted, **more})


def choice(meanings: Mapping[str, str], slot: str = "") -> Any:
    """Declare an entry with choices and what they mean, the default first; those of a slot are its laws."""
    choices = {name: meanings.get(name, "") for name in LAWS[slot]} if slot else meanings
    default = next(iter(meanings))
    return entry("", default, choices=choices, default=default, slot=slot)


@dataclass(frozen=True)
class Particles(Table):
    """Two equal spheres, or the first of a pair. Required."""

    reduced_radius: float = entry("a reduced radius a = R/2", '"50 um"', unit="m")
    """Reduced radius $a = R/2$ of either sphere."""
    radius: float | None = entry("a radius R", '"100 um"', unit="m", gives="reduced_radius", factor=0.5)
    """Radius $R$ of one sphere."""
    diameter: float | None = entry("a diameter 2R", '"200 um"', unit="m", gives="reduced_radius", factor=0.25)
    """Diameter $2R$ of one sphere."""
    reduced_mass: float = entry("a reduced mass m = M/2", '"5.2e-6 g"', unit="kg")
    """Reduced mass $m = M/2$ of either sphere."""
    mass: float | None = entry("the mass M of one sphere", '"1.04e-5 g"', unit="kg", gives="reduced_mass", factor=0.5)
    """Mass $M$ of one sphere."""
    density: float | None = entry("the density of the spheres", '"2500 kg/m^3"', unit="kg/m^3", gives="")
    """Density of the spheres; the mass follows from it."""
    roughness: float = entry("a roughness", '"0.2 um"', NOT_NEGATIVE, unit="m", required=True)
    """$x_b$, the gap at which the asperities of the surfaces touch."""
    dry_restitution: float = entry("a number", "0.99", FRACTION, required=True)
    """$e_{dry}$, normal restitution of the dry spheres."""
    friction: float | None = entry("a Coulomb coefficient", "0.2", NOT_NEGATIVE)
    r"""$\mu_f$, Coulomb coefficient of the dry contact; without it the contact has no friction."""
    contact_tangential_restitution: float | None = entry("a number", "0.35", FRACTION)
    r"""$\beta_0$ of a dry contact that sticks: the slip is reversed, $v_s' = -\beta_0 v_s$ (Walton & Braun 1986, *J.
    Rheol.* 30, 949); goes with `friction`, 0 without it."""
    youngs_modulus: float | None = entry("a Young's modulus", '"70 GPa"', unit="Pa")
    """$E$ of the spheres; without it there is no elastic criterion."""
    poisson_ratio: float | None = entry("a number", "0.2", POISSON)
    r"""$\nu$ of the spheres; goes with `youngs_modulus`."""


@dataclass(frozen=True)
class Partner(Table):
    """Another sphere, or a wall, in place of an equal sphere. The sphere of `[particles]` is then the first of the
    pair, with its own radius and mass. Roughness, restitution, elastic constants and film are those of the contact.
    """

    radius: float | None = entry("the radius R of the partner", '"200 um"', unit="m", gives="")
    """Radius of the partner; 1e-4 to 1e4 of the sphere's."""
    diameter: float | None = entry("the diameter 2R of the partner", '"400 um"', unit="m", gives="", factor=0.5)
    """Diameter $2R$ of the partner."""
    coating_thickness: float | None = entry("the coating on the partner", '"4 um"', NOT_NEGATIVE, unit="m", gives="")
    """Coating on the partner; another sphere is coated as the first if nothing is said; beside a wall it must be said
    (`"0 um"`: dry)."""
    mass: float | None = entry("the mass M of the partner", '"8.3e-5 g"', unit="kg", gives="")
    """Mass of the partner; 1e-4 to 1e4 of the sphere's."""
    density: float | None = entry("the density of the partner", '"2500 kg/m^3"', unit="kg/m^3", gives="")
    """Density of the partner; its mass follows from it."""
    contact_angle: float | None = entry("an angle", '"30 deg"', WETTING_ANGLE, unit="rad", gives="")
    """Contact angle on the partner, if another; the bridge has the angle of the mean cosine (Orr, Scriven & Rivas
    1975, *J. Fluid Mech.* 67, 723), exact for small bridges."""
    wall: str | None = entry("a wall", "true", flag=True)
    """The partner is a flat wall at rest."""


@dataclass(frozen=True)
class Liquid(Table):
    """The film on the spheres. Required."""

    viscosity: float = entry("a viscosity", '"2 Pa s"', unit="Pa s", required=True, by_name=True)
    r"""Viscosity $\mu$; or a liquid by name, mass fraction in water and temperature, `"glycerol 85 %, 25 degC"`, with
    the extra `liquids`; of a `law` its viscosity at low rates (`cross`, `carreau`), or at `reference_rate`, beside the
    yield stress."""
    law: str | None = choice(
        {
            NEWTONIAN: r"$\mu$ at any rate",
            "power-law": r"$\mu (\dot\gamma/\dot\gamma_r)^{n-1}$, above `plateau_rate`",
            "cross": r"$\mu_\infty + (\mu - \mu_\infty)/(1 + (\lambda \dot\gamma)^{1-n})$",
            "carreau": r"$\mu_\infty + (\mu - \mu_\infty)(1 + (\lambda \dot\gamma)^2)^{(n-1)/2}$",
            "herschel-bulkley": r"stress $\tau_y + \mu \dot\gamma_r^{1-n} \dot\gamma^n$, above `plateau_rate`; "
            "$n = 1$ is Bingham's",
        }
    )
    """How the viscosity depends on the shear rate."""
    flow_index: float | None = entry("a number", "0.5", Range("> 0 and at most 2", 0.0, 2.0, high_open=False))
    """$n$, slope of the stress over the rate where it thins; of `cross` and `carreau` at most 1."""
    relaxation_time: float | None = entry("a time", '"1 ms"', unit="s")
    r"""$\lambda$ of `cross` and `carreau`: over $1/\lambda$ the liquid thins."""
    infinite_shear_viscosity: float | None = entry("a viscosity", '"0.01 Pa s"', NOT_NEGATIVE, unit="Pa s", default=0.0)
    r"""$\mu_\infty$, what is left of the viscosity at high rates."""
    yield_stress: float | None = entry("a stress", '"20 Pa"', unit="Pa")
    r"""$\tau_y$ of `herschel-bulkley`."""
    reference_rate: float | None = entry(SHEAR_RATE, '"1 1/s"', unit="rad/s", default=1.0)
    """Rate at which `viscosity` is that of the power law; with 1/s it is the consistency $K$."""
    plateau_rate: float | None = entry(SHEAR_RATE, '"0.1 1/s"', unit="rad/s", default=1.0)
    """Rate below which the viscosity of a power law or yield stress stays what it is there: the regularisation; ten
    times below the slowest rate that matters it changes the force by 2 parts in 1000."""
    measured_to: float | None = entry(SHEAR_RATE, '"1000 1/s"', unit="rad/s")
    """Highest rate at which the viscosity was measured; a collision that is faster says so."""
    film_thickness: float = entry("a film thickness, the gap at initial contact,", '"8 um"', unit="m")
    """$x_0$, the gap at initial contact: the sum of both coatings."""
    coating_thickness: float | None = entry("the coating on a sphere", '"4 um"', NOT_NEGATIVE, unit="m", gives="")
    """Coating on each sphere; $x_0$ is twice that, or the sum with the partner's."""
    glass_transition_pressure: float | None = entry("a pressure", '"20 MPa"', unit="Pa")
    """$p_{gt}$, film pressure at which the liquid turns solid and the spheres rebound; without it there is no such
    criterion, and a roughness or elastic constants must stop the approach."""
    density: float | None = entry("a density", '"1000 kg/m^3"', unit="kg/m^3")
    """Density of the liquid; only reports the Reynolds number of the film."""


@dataclass(frozen=True)
class Bridge(Table):
    """The liquid bridge. Without this table there is no capillary force: the pair separates where the films part, and
    $Ce$ and $Ca$ do not exist.
    """

    surface_tension: float = entry("a surface tension", '"0.025 N/m"', unit="N/m", required=True)
    r"""Surface tension $\sigma$."""
    volume: float = entry("a number V/R^3", "0.1", required=True, or_unit="m^3", words=(FROM_COATING,))
    """Volume of the bridge over $R^3$, $2/R = 1/R_1 + 1/R_2$; or with its unit, `"5e-5 mm^3"`; or `"from coating"`."""
    coating_fraction: float | None = entry("the part of the coating", "0.067", PART, gives="")
    """With `"from coating"`: the part of either coating that flows into the bridge."""
    contact_angle: float = entry("an angle", '"0 deg"', WETTING_ANGLE, unit="rad", default=0.0)
    r"""Contact angle $\phi$."""
    law: str = choice(
        {
            "mikami": "regression of solutions of the Young-Laplace equation, natural logarithms; the paper's",
            "mikami-log10": "the same with decimal logarithms in two coefficients",
            "willett": "fit to solutions of the Young-Laplace equation, full form",
            "willett-simple": "its closed form for small bridges",
            "rabinovich": "`lambert` and the surface tension along the contact line",
            "lambert": "cylindrical bridge of constant volume, from its energy",
            "soulie": "Mikami's form refitted for polydisperse spheres",
            "constant": r"$2 \pi R \sigma \cos \phi$ at any gap: an upper bound",
        },
        slot="bridge",
    )
    """Fit of the capillary force."""
    rupture: str = choice(
        {
            "common": r"$x_f = 2a V^{1/3} (1 + \phi/2)$ with every law",
            "own": "the distance that the authors of the law give; an error where they give none",
        }
    )
    """Where the bridge ruptures."""


@dataclass(frozen=True)
class Attraction(Table):
    """Van der Waals attraction, with or without a bridge. It is neither retarded nor cut off at atomic distances, so
    the solids must keep the gap open: a roughness above 0, or elastic constants.
    """

    hamaker: float = entry("a Hamaker constant", '"1e-19 J"', NOT_NEGATIVE, unit="J", required=True)
    """Hamaker constant $A$ of the two spheres across the liquid."""


@dataclass(frozen=True)
class Pendulum(Table):
    """The spheres hang on strings from pivots one diameter apart. Such a collision ends, as a stick, when the doublet
    has made half a turn or the strings turn its rotation back.
    """

    length: float = entry("a string length", '"0.5 m"', unit="m", required=True, gives="string_length")
    """Length $l$ of the strings."""
    gravity: float = entry("an acceleration", '"9.81 m/s^2"', unit="m/s^2", default=9.81)
    """Acceleration of gravity $g$."""
    law: str = choice({"exact": "strings of length $l$", "small-angle": "forces linear in the swing"}, slot="strings")
    """Geometry of the strings."""


@dataclass(frozen=True)
class Model(Table):
    """Variants of the equations that the paper leaves open. The first choice of each is the default."""

    arm: str = choice({"midgap": "$r/2$, halfway between the surfaces: conserves angular momentum"}, slot="arm")
    """Lever arm of the tangential force about each centre."""
    tangential: str = choice(
        {"immersed": r"$\ln(2a/x)$, until $x = 2a$", "film": r"$\ln(x_0/x)$, inside the film only"}, slot="shear"
    )
    """Outer cut-off of the tangential logarithm."""
    glass: str = choice(
        {
            "literal": r"$3 \mu a |u|/x^2$ as published; it can be met at initial contact",
            "film-corrected": "with the pressure at the rim of the film, $1/x^2 - 1/x_0^2$: zero at initial contact",
        },
        slot="glass",
    )
    """Pressure that the glass criterion looks at."""
    contact_friction: str = choice(
        {"solid": "those by solid contact (elastic, rough)", "all": "those on the liquid in its glassy state as well"}
    )
    """Rebounds that have friction, where there is `particles.friction`."""
    film: str = choice(
        {
            "finite": "film of thickness $x_0$, the same on approach and rebound; the paper's",
            "infinite": "no film correction; the force ends with a jump at $x_0$",
            "cavitating": "`finite` on approach; on rebound the liquid cavitates and does not resist",
            "constant-volume": "the rim holds the volume of the bridge, at any gap up to rupture; needs a bridge",
        },
        slot="film",
    )
    """Normal lubrication force."""


@dataclass(frozen=True)
class Impact(Table):
    """Initial contact of the films. It may be left to the command line."""

    stokes: float | None = entry("a Stokes number", "0.03", gives="")
    r"""Normal Stokes number $St = m v_0/(6 \pi \mu a^2)$."""
    speed: float | None = entry("a normal approach speed", '"0.54 m/s"', unit="m/s")
    """$v_0$, the *normal* component of the approach velocity."""
    relative_speed: float | None = entry("the magnitude of the relative velocity", '"1.08 m/s"', unit="m/s", gives="")
    r"""Magnitude of the relative velocity, $v_0/\cos\theta_0$."""
    angle: float | None = entry("an impact angle", '"60 deg"', IMPACT_ANGLE, unit="rad")
    r"""$\theta_0$ between the relative velocity and the line of centres; 0 is along it."""
    spin: float | None = entry("a spin", '"200 rad/s"', ANY, unit="rad/s", gives="impact_spin", default=0.0)
    r"""Spin of the spheres, or of the first one, before the collision: positive in the sense in which $\theta_0 > 0$
    turns the line of centres, beside a wall in the sense of rolling along the tangential velocity."""
    partner_spin: float | None = entry(
        "a spin of the partner", '"-50 rad/s"', ANY, unit="rad/s", gives="impact_partner_spin"
    )
    """Spin of the partner, or of the second of two equal spheres; left out, it equals the spin."""


REQUIRED_TABLES = ("particles", "liquid")
ONE_OF_EACH = (*REQUIRED_TABLES, "partner")
"""Tables, where they are there, that need one of each of their alternatives."""

SPEEDS = ("impact.stokes", "impact.speed", "impact.relative_speed")
"""Entries that give the speed of an impact: one variable, at an angle."""

MEETING = (*SPEEDS, "impact.angle")
"""Entries that may differ from collision to collision; all others are common to a batch, spins included."""

SPINS = ("impact.spin", "impact.partner_spin")

ALTERNATIVES: tuple[tuple[str, ...], ...] = (
    ("particles.reduced_radius", "particles.radius", "particles.diameter"),
    ("particles.reduced_mass", "particles.mass", "particles.density"),
    ("liquid.film_thickness", "liquid.coating_thickness"),
    SPEEDS,
    ("partner.radius", "partner.diameter", "partner.wall"),
    ("partner.mass", "partner.density", "partner.wall"),
)
"""Entries of which one at most may be given."""

DEFAULTS: dict[str, float] = {name: field.default for name, field in FIELDS.items() if isinstance(field.default, float)}
"""Dotted name -> number, SI, of what need not be given where its table is."""


def acting_defaults(entries: Iterable[str]) -> dict[str, float]:
    """The numbers of `DEFAULTS` that act beside these entries: of tables that are there, and of a law of liquids."""
    names = {*entries}
    tables = {name.partition(".")[0] for name in names} - ({"liquid"} if "liquid.flow_index" not in names else set())
    return {name: value for name, value in DEFAULTS.items() if name.partition(".")[0] in tables}
