"""The vocabulary: every quantity of the model once, with symbol, name, dimension, SI unit, meaning and source.

Names are the names that emitted code, scene files and documentation use. `PAPER` is Donahue, Davis, Kantak and
Hrenya, Phys. Rev. E 86, 021303 (2012).
"""

from dataclasses import dataclass

import sympy as sp

from .dimensions import FORCE, LENGTH, MASS, ONE, PRESSURE, RATE, SPEED, TIME, Dimension

PAPER = "Donahue et al. 2012"
HAMAKER = "Hamaker 1937"
WALTON = "Walton & Braun 1986"
PAIR = "two unequal spheres, or a wall"
SPIN = "spins at initial contact"
SPACE = "two spheres in space"


@dataclass(frozen=True)
class Quantity:
    """A physical quantity or dimensionless group.

    `symbol.name` is its name in emitted code; `latex` how the literature writes it.
    """

    symbol: sp.Symbol
    latex: str
    dimension: Dimension
    unit: str
    meaning: str
    source: str = PAPER

    @property
    def name(self) -> str:
        return self.symbol.name


_ALL: dict[str, Quantity] = {}


_UNITS = {LENGTH: "m", MASS: "kg", ONE: "1", PRESSURE: "Pa", TIME: "s", SPEED: "m/s", RATE: "rad/s", FORCE: "N"}


def _quantity(
    name: str, latex: str, dimension: Dimension, meaning: str, source: str = PAPER, *, unit: str = "", **signs: bool
) -> sp.Symbol:
    """The symbol of a quantity, positive unless `signs` says otherwise; its unit by default that of its dimension."""
    symbol = sp.Symbol(name, **(signs or {"positive": True}))
    if name in _ALL:
        raise ValueError(f"{name} stands twice in the vocabulary")
    _ALL[name] = Quantity(symbol, latex, dimension, unit or _UNITS[dimension], meaning, source)
    return symbol


def _group(name: str, latex: str, meaning: str, source: str = PAPER, *, unit: str = "1", **signs: bool) -> sp.Symbol:
    """The symbol of a pure number; `unit` is what it is counted in."""
    return _quantity(name, latex, ONE, meaning, source, unit=unit, **signs)


Vector = tuple[sp.Symbol, sp.Symbol, sp.Symbol]
AXES = "xyz"


def _vector(name: str, latex: str, dimension: Dimension, meaning: str, unit: str = "") -> Vector:
    """The components of a vector in the laboratory's axes, as quantities `name_x`, `name_y`, `name_z`."""

    def component(axis: str) -> sp.Symbol:
        whole = f"{meaning}, {axis} component"
        return _quantity(f"{name}_{axis}", rf"{latex}^{{{axis}}}", dimension, whole, SPACE, unit=unit, real=True)

    return component("x"), component("y"), component("z")


# Particles and liquid
a = _quantity("reduced_radius", "a", LENGTH, "reduced radius, R/2 for equal spheres")
m = _quantity("reduced_mass", "m", MASS, "reduced mass, M/2 for equal spheres")
x_b = _quantity("roughness", "x_b", LENGTH, "height of the surface roughness")
e_dry = _group("dry_restitution", "e_{dry}", "restitution of the dry contact", nonnegative=True)
mu_f = _group("friction", r"\mu_f", "Coulomb coefficient of the dry contact", WALTON, nonnegative=True)
beta_0 = _group(
    "contact_tangential_restitution",
    r"\beta_0",
    "tangential restitution of a dry contact that sticks: slip after over slip before, reversed",
    WALTON,
    nonnegative=True,
)
E = _quantity("youngs_modulus", "E", PRESSURE, "Young's modulus of the spheres", "Davis, Rager & Good 2002")
nu = _group("poisson_ratio", r"\nu", "Poisson's ratio of the spheres", "Davis, Rager & Good 2002", real=True)
mu = _quantity("viscosity", r"\mu", PRESSURE * TIME, "viscosity of the liquid", unit="Pa s")
x0 = _quantity("film_thickness", "x_0", LENGTH, "film thickness: the gap at initial contact")
p_gt = _quantity("glass_transition_pressure", "p_{gt}", PRESSURE, "glass-transition pressure of the liquid")
rho = _quantity("density", r"\rho", MASS / LENGTH**3, "density of the liquid", unit="kg/m^3")
sigma = _quantity("surface_tension", r"\sigma", FORCE / LENGTH, "surface tension of the liquid", unit="N/m")
A_H = _quantity(
    "hamaker", "A_H", FORCE * LENGTH, "Hamaker constant of the spheres across the liquid", HAMAKER, unit="J"
)
l_s = _quantity("string_length", "l", LENGTH, "length of the pendulum strings")
g = _quantity("gravity", "g", LENGTH / TIME**2, "gravitational acceleration", unit="m/s^2")
v0 = _quantity("speed", "v_{n,0}", SPEED, "normal approach speed at initial contact")
theta0 = _group("angle", r"\theta_0", "impact angle, 0 along the line of centres", unit="rad", nonnegative=True)

# Motion
t = _quantity("time", "t", TIME, "time since initial contact", real=True)
x = _quantity("separation", "x", LENGTH, "gap between the surfaces")
u = _quantity("separation_rate", "u", SPEED, "normal velocity dx/dt, negative on approach", real=True)
omega = _quantity("rotation_rate", r"\omega", RATE, "angular velocity of the line of centres", real=True)
xi = _quantity("spin_rate", r"\xi", RATE, "angular velocity of each sphere about its own centre", real=True)
partner_spin_rate = _quantity(
    "partner_spin_rate", r"\xi_2", RATE, "angular velocity of the partner about its own centre", PAIR, real=True
)
slide_rate = _quantity("slide_rate", "v", SPEED, "velocity of the sphere's centre along a wall", PAIR, real=True)
beta = _group("rotation", r"\beta", "angle turned by the line of centres", unit="rad", real=True)
omega0 = _quantity("initial_rate", r"\omega_0", RATE, "initial angular velocity, v0 tan(theta0)/(4a)")
rate_scale = _quantity(
    "rate_scale", r"\Omega", RATE, "scale of angular velocities, omega0 unless the spheres spin at first", SPIN
)

pair_rate = _quantity(
    "initial_rate_pair", r"\omega_{0,p}", RATE, "initial angular velocity of a pair, v0 tan(theta0)/(R1 + R2)", PAIR
)
rate_scale_pair = _quantity(
    "rate_scale_pair", r"\Omega_p", RATE, "scale of angular velocities of an unequal pair", PAIR
)
rate_scale_wall = _quantity("rate_scale_wall", r"\Omega_w", RATE, "scale of the spin beside a wall", PAIR)
impact_spin = _quantity("impact_spin", r"\xi_0", RATE, "spin at initial contact", SPIN, real=True)
impact_partner_spin = _quantity(
    "impact_partner_spin", r"\xi_{2,0}", RATE, "spin of the partner at initial contact", SPIN, real=True
)
attraction = _quantity("attraction_force", "F", FORCE, "all that attracts, at a gap: bridge and van der Waals")

# Dimensionless states: gap by x0, velocities by v0, angular velocities by omega0, time by x0/v0
gap = _group("gap", "s", "gap over film thickness", unit="x0")
normal_velocity = _group(
    "normal_velocity", "w", "normal velocity over impact speed, negative on approach", unit="v0", real=True
)
angle_turned = _group("angle_turned", r"\beta", "angle turned, as a declared event watches it", unit="rad", real=True)
time_passed = _group(
    "time_passed", r"\hat t", "time since initial contact, as a declared event watches it", unit="x0/v0", real=True
)
orbital_momentum = _group(
    "orbital_momentum", "J", "orbital angular momentum r^2 omega over a^2 Omega", unit="a^2 Omega", real=True
)
spin = _group("spin", r"\hat\xi", "spin of each sphere over its scale Omega", unit="Omega", real=True)
partner_spin = _group("partner_spin", r"\hat\xi_2", "spin of the partner over Omega", PAIR, unit="Omega", real=True)
slide = _group(
    "slide", r"\hat v", "tangential velocity of the centre along a wall over v0 T", PAIR, unit="v0 T", real=True
)
decay = _group(
    "decay", r"\Lambda", "e-foldings of the slower mode of sliding and rolling beside a wall", PAIR, real=True
)
last_slide = _group(
    "last_slide", r"\hat v_r", "slide beside a wall just after the last rebound", PAIR, unit="v0 T", real=True
)
last_roll = _group(
    "last_roll", r"\hat\xi_r", "roll beside a wall just after the last rebound", PAIR, unit="v0 T/a", real=True
)
roll = _group("roll", r"\hat\xi_w", "spin beside a wall", PAIR, unit="v0 T/a", real=True)

# Vectors in the laboratory's axes
normal = _vector("normal", r"\hat{n}", ONE, "unit vector along the line of centres")
orbital_momenta = _vector("orbital_momentum", "J", ONE, "orbital angular momentum r^2 n x dn/dt", unit="a^2 Omega")
spins = _vector("spin", r"\hat\xi", ONE, "angular velocity of the first sphere", unit="Omega")
partner_spins = _vector("partner_spin", r"\hat\xi_2", ONE, "angular velocity of the partner", unit="Omega")
initial_normals = _vector("initial_normal", r"\hat{n}_0", ONE, "line of centres at initial contact")
initial_turnings = _vector(
    "initial_turning", r"\hat\omega_0", ONE, "angular velocity of the line of centres at initial contact", unit="Omega"
)
initial_spins = _vector("initial_spin", r"\hat\xi_0", ONE, "spin of the first sphere at initial contact", unit="Omega")
initial_partner_spins = _vector(
    "initial_partner_spin", r"\hat\xi_{2,0}", ONE, "spin of the partner at initial contact", unit="Omega"
)
impact_turnings = _vector(
    "impact_turning", r"\omega_0", RATE, "angular velocity of the line of centres at initial contact"
)
impact_spins = _vector("impact_spin", r"\xi_0", RATE, "spin of the first sphere at initial contact")
impact_partner_spins = _vector("impact_partner_spin", r"\xi_{2,0}", RATE, "spin of the partner at initial contact")

obliquity_space = _group(
    "obliquity_space", "T_s", "T in space: a length of its three vectors together", SPACE, nonnegative=True
)

# Dimensionless groups
stokes = _group("stokes", "St", "Stokes number m v0/(6 pi mu a^2)")
capillary = _group("capillary", "Ca", "capillary number 3 mu a v0/(sigma x0)")
centrifugal = _group("centrifugal", "Ce", "centrifugal number m omega0^2/sigma", nonnegative=True)
reynolds = _group("reynolds", "Re", "film Reynolds number rho v0 x0/mu")
aspect = _group("aspect", r"\varepsilon", "film thickness over reduced radius, x0/a")
obliquity = _group(
    "obliquity",
    "T",
    "largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0",
    SPIN,
    nonnegative=True,
)
obliquity_pair = _group("obliquity_pair", "T_p", "T of an unequal pair", SPIN, nonnegative=True)
obliquity_wall = _group("obliquity_wall", "T_w", "T beside a wall", SPIN, nonnegative=True)
initial_turning = _group("initial_turning", r"\hat\omega_0", "tan(theta0)/T, 1 without spins", SPIN, nonnegative=True)
initial_spin = _group("initial_spin", r"\hat\xi_0", "spin at initial contact over Omega", SPIN, unit="Omega", real=True)
initial_partner_spin = _group(
    "initial_partner_spin",
    r"\hat\xi_{2,0}",
    "spin of the partner at initial contact over Omega",
    SPIN,
    unit="Omega",
    real=True,
)
glass_number = _group("glass_number", r"\Pi_{gt}", "glass-transition pressure over 3 mu a v0/x0^2")
radius_ratio = _group("radius_ratio", r"\lambda", "radius of the partner over that of the sphere", PAIR)
mass_ratio = _group("mass_ratio", r"\kappa", "mass of the partner over that of the sphere", PAIR)
volume = _group("volume", "V", "bridge volume over R^3 (constant)")
contact_angle = _group(
    "contact_angle", r"\phi", "contact angle of the liquid on the sphere", unit="rad", nonnegative=True
)
pair_centrifugal = _group("centrifugal_pair", "Ce_p", "centrifugal number of an unequal pair", PAIR, nonnegative=True)
cohesive_centrifugal = _group(
    "generalised_centrifugal", "Ce_F", "generalised centrifugal number m omega0^2 a/F", nonnegative=True
)
adhesion = _group(
    "adhesion",
    "Ad",
    "van der Waals force at initial contact over the film's, A/(36 pi mu v0 x0 a)",
    HAMAKER,
    nonnegative=True,
)
weight = _group("weight", r"g x_0/v_0^2", "gravity over impact deceleration, g x0/v0^2")
string_ratio = _group("string_ratio", "l/a", "string length over reduced radius")
elastic_gap = _group("elastic_gap", "x_r/x_0", "elastic length over film thickness", unit="x0", nonnegative=True)
rough_gap = _group("rough_gap", "x_b/x_0", "roughness over film thickness", unit="x0", nonnegative=True)
rupture_gap = _group("rupture_gap", "x_f/x_0", "rupture distance over film thickness", unit="x0")

VOCABULARY: dict[str, Quantity] = dict(_ALL)
DIMENSIONS: dict[sp.Basic, Dimension] = {quantity.symbol: quantity.dimension for quantity in VOCABULARY.values()}

R = 2 * a  # radius of one of two equal spheres
r = 4 * a + x  # distance between the centres
