"""The vocabulary: every quantity of the model once, with symbol, name, dimension, SI unit, meaning and source.

Names are the names that emitted code, scene files and documentation use. `PAPER` is Donahue, Davis, Kantak and
Hrenya, Phys. Rev. E 86, 021303 (2012).
"""

from __future__ import annotations

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


def _quantity(
    name: str, latex: str, dimension: Dimension, unit: str, meaning: str, source: str = PAPER, **assumptions: bool
) -> sp.Symbol:
    symbol = sp.Symbol(name, **(assumptions or {"positive": True}))
    if name in _ALL:
        raise ValueError(f"{name} stands twice in the vocabulary")
    _ALL[name] = Quantity(symbol, latex, dimension, unit, meaning, source)
    return symbol


Vector = tuple[sp.Symbol, sp.Symbol, sp.Symbol]
AXES = "xyz"


def _vector(name: str, latex: str, dimension: Dimension, unit: str, meaning: str) -> Vector:
    """The components of a vector in the laboratory's axes, as quantities `name_x`, `name_y`, `name_z`."""
    first, second, third = (
        _quantity(f"{name}_{axis}", rf"{latex}^{{{axis}}}", dimension, unit, f"{meaning}, {axis} component", SPACE,
                  real=True)
        for axis in AXES
    )  # fmt: skip
    return first, second, third


# Particles and liquid
a = _quantity("reduced_radius", "a", LENGTH, "m", "reduced radius, R/2 for equal spheres")
m = _quantity("reduced_mass", "m", MASS, "kg", "reduced mass, M/2 for equal spheres")
x_b = _quantity("roughness", "x_b", LENGTH, "m", "height of the surface roughness")
e_dry = _quantity("dry_restitution", "e_{dry}", ONE, "1", "restitution of the dry contact", nonnegative=True)
mu_f = _quantity("friction", r"\mu_f", ONE, "1", "Coulomb coefficient of the dry contact", WALTON, nonnegative=True)
beta_0 = _quantity(
    "contact_tangential_restitution",
    r"\beta_0",
    ONE,
    "1",
    "tangential restitution of a dry contact that sticks: slip after over slip before, reversed",
    WALTON,
    nonnegative=True,
)
E = _quantity("youngs_modulus", "E", PRESSURE, "Pa", "Young's modulus of the spheres", "Davis, Rager & Good 2002")
nu = _quantity(
    "poisson_ratio", r"\nu", ONE, "1", "Poisson's ratio of the spheres", "Davis, Rager & Good 2002", real=True
)
mu = _quantity("viscosity", r"\mu", PRESSURE * TIME, "Pa s", "viscosity of the liquid")
x0 = _quantity("film_thickness", "x_0", LENGTH, "m", "film thickness: the gap at initial contact")
p_gt = _quantity("glass_transition_pressure", "p_{gt}", PRESSURE, "Pa", "glass-transition pressure of the liquid")
rho = _quantity("density", r"\rho", MASS / LENGTH**3, "kg/m^3", "density of the liquid")
sigma = _quantity("surface_tension", r"\sigma", FORCE / LENGTH, "N/m", "surface tension of the liquid")
A_H = _quantity("hamaker", "A_H", FORCE * LENGTH, "J", "Hamaker constant of the spheres across the liquid", HAMAKER)
l_s = _quantity("string_length", "l", LENGTH, "m", "length of the pendulum strings")
g = _quantity("gravity", "g", LENGTH / TIME**2, "m/s^2", "gravitational acceleration")
v0 = _quantity("speed", "v_{n,0}", SPEED, "m/s", "normal approach speed at initial contact")
theta0 = _quantity("angle", r"\theta_0", ONE, "rad", "impact angle, 0 along the line of centres", nonnegative=True)

# Motion
t = _quantity("time", "t", TIME, "s", "time since initial contact", real=True)
x = _quantity("separation", "x", LENGTH, "m", "gap between the surfaces")
u = _quantity("separation_rate", "u", SPEED, "m/s", "normal velocity dx/dt, negative on approach", real=True)
omega = _quantity("rotation_rate", r"\omega", RATE, "rad/s", "angular velocity of the line of centres", real=True)
xi = _quantity("spin_rate", r"\xi", RATE, "rad/s", "angular velocity of each sphere about its own centre", real=True)
partner_spin_rate = _quantity(
    "partner_spin_rate",
    r"\xi_2",
    RATE,
    "rad/s",
    "angular velocity of the partner about its own centre",
    PAIR,
    real=True,
)
slide_rate = _quantity("slide_rate", "v", SPEED, "m/s", "velocity of the sphere's centre along a wall", PAIR, real=True)
beta = _quantity("rotation", r"\beta", ONE, "rad", "angle turned by the line of centres", real=True)
omega0 = _quantity("initial_rate", r"\omega_0", RATE, "rad/s", "initial angular velocity, v0 tan(theta0)/(4a)")
rate_scale = _quantity(
    "rate_scale", r"\Omega", RATE, "rad/s", "scale of angular velocities, omega0 unless the spheres spin at first", SPIN
)

pair_rate = _quantity(
    "initial_rate_pair",
    r"\omega_{0,p}",
    RATE,
    "rad/s",
    "initial angular velocity of a pair, v0 tan(theta0)/(R1 + R2)",
    PAIR,
)
rate_scale_pair = _quantity(
    "rate_scale_pair", r"\Omega_p", RATE, "rad/s", "scale of angular velocities of an unequal pair", PAIR
)
rate_scale_wall = _quantity("rate_scale_wall", r"\Omega_w", RATE, "rad/s", "scale of the spin beside a wall", PAIR)
impact_spin = _quantity("impact_spin", r"\xi_0", RATE, "rad/s", "spin at initial contact", SPIN, real=True)
impact_partner_spin = _quantity(
    "impact_partner_spin", r"\xi_{2,0}", RATE, "rad/s", "spin of the partner at initial contact", SPIN, real=True
)
attraction = _quantity("attraction_force", "F", FORCE, "N", "all that attracts, at a gap: bridge and van der Waals")

# Dimensionless states: gap by x0, velocities by v0, angular velocities by omega0, time by x0/v0
gap = _quantity("gap", "s", ONE, "x0", "gap over film thickness")
normal_velocity = _quantity(
    "normal_velocity", "w", ONE, "v0", "normal velocity over impact speed, negative on approach", real=True
)
orbital_momentum = _quantity(
    "orbital_momentum", "J", ONE, "a^2 Omega", "orbital angular momentum r^2 omega over a^2 Omega", real=True
)
spin = _quantity("spin", r"\hat\xi", ONE, "Omega", "spin of each sphere over its scale Omega", real=True)
partner_spin = _quantity("partner_spin", r"\hat\xi_2", ONE, "Omega", "spin of the partner over Omega", PAIR, real=True)
slide = _quantity(
    "slide", r"\hat v", ONE, "v0 T", "tangential velocity of the centre along a wall over v0 T", PAIR, real=True
)
decay = _quantity(
    "decay", r"\Lambda", ONE, "1", "e-foldings of the slower mode of sliding and rolling beside a wall", PAIR, real=True
)
last_slide = _quantity(
    "last_slide", r"\hat v_r", ONE, "v0 T", "slide beside a wall just after the last rebound", PAIR, real=True
)
last_roll = _quantity(
    "last_roll", r"\hat\xi_r", ONE, "v0 T/a", "roll beside a wall just after the last rebound", PAIR, real=True
)
roll = _quantity("roll", r"\hat\xi_w", ONE, "v0 T/a", "spin beside a wall", PAIR, real=True)

# Vectors in the laboratory's axes
normal = _vector("normal", r"\hat{n}", ONE, "1", "unit vector along the line of centres")
orbital_momenta = _vector("orbital_momentum", "J", ONE, "a^2 Omega", "orbital angular momentum r^2 n x dn/dt")
spins = _vector("spin", r"\hat\xi", ONE, "Omega", "angular velocity of the first sphere")
partner_spins = _vector("partner_spin", r"\hat\xi_2", ONE, "Omega", "angular velocity of the partner")
initial_normals = _vector("initial_normal", r"\hat{n}_0", ONE, "1", "line of centres at initial contact")
initial_turnings = _vector(
    "initial_turning", r"\hat\omega_0", ONE, "Omega", "angular velocity of the line of centres at initial contact"
)
initial_spins = _vector("initial_spin", r"\hat\xi_0", ONE, "Omega", "spin of the first sphere at initial contact")
initial_partner_spins = _vector(
    "initial_partner_spin", r"\hat\xi_{2,0}", ONE, "Omega", "spin of the partner at initial contact"
)
impact_turnings = _vector(
    "impact_turning", r"\omega_0", RATE, "rad/s", "angular velocity of the line of centres at initial contact"
)
impact_spins = _vector("impact_spin", r"\xi_0", RATE, "rad/s", "spin of the first sphere at initial contact")
impact_partner_spins = _vector(
    "impact_partner_spin", r"\xi_{2,0}", RATE, "rad/s", "spin of the partner at initial contact"
)

obliquity_space = _quantity(
    "obliquity_space", "T_s", ONE, "1", "T in space: a length of its three vectors together", SPACE, nonnegative=True
)

# Dimensionless groups
stokes = _quantity("stokes", "St", ONE, "1", "Stokes number m v0/(6 pi mu a^2)")
capillary = _quantity("capillary", "Ca", ONE, "1", "capillary number 3 mu a v0/(sigma x0)")
centrifugal = _quantity("centrifugal", "Ce", ONE, "1", "centrifugal number m omega0^2/sigma", nonnegative=True)
reynolds = _quantity("reynolds", "Re", ONE, "1", "film Reynolds number rho v0 x0/mu")
aspect = _quantity("aspect", r"\varepsilon", ONE, "1", "film thickness over reduced radius, x0/a")
obliquity = _quantity(
    "obliquity", "T", ONE, "1", "largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0",
    SPIN, nonnegative=True,
)  # fmt: skip
obliquity_pair = _quantity("obliquity_pair", "T_p", ONE, "1", "T of an unequal pair", SPIN, nonnegative=True)
obliquity_wall = _quantity("obliquity_wall", "T_w", ONE, "1", "T beside a wall", SPIN, nonnegative=True)
initial_turning = _quantity(
    "initial_turning", r"\hat\omega_0", ONE, "1", "tan(theta0)/T, 1 without spins", SPIN, nonnegative=True
)
initial_spin = _quantity(
    "initial_spin", r"\hat\xi_0", ONE, "Omega", "spin at initial contact over Omega", SPIN, real=True
)
initial_partner_spin = _quantity(
    "initial_partner_spin", r"\hat\xi_{2,0}", ONE, "Omega", "spin of the partner at initial contact over Omega", SPIN,
    real=True,
)  # fmt: skip
glass_number = _quantity("glass_number", r"\Pi_{gt}", ONE, "1", "glass-transition pressure over 3 mu a v0/x0^2")
radius_ratio = _quantity("radius_ratio", r"\lambda", ONE, "1", "radius of the partner over that of the sphere", PAIR)
mass_ratio = _quantity("mass_ratio", r"\kappa", ONE, "1", "mass of the partner over that of the sphere", PAIR)
volume = _quantity("volume", "V", ONE, "1", "bridge volume over R^3 (constant)")
contact_angle = _quantity(
    "contact_angle", r"\phi", ONE, "rad", "contact angle of the liquid on the sphere", nonnegative=True
)
pair_centrifugal = _quantity(
    "centrifugal_pair", "Ce_p", ONE, "1", "centrifugal number of an unequal pair", PAIR, nonnegative=True
)
cohesive_centrifugal = _quantity(
    "generalised_centrifugal", "Ce_F", ONE, "1", "generalised centrifugal number m omega0^2 a/F", nonnegative=True
)
adhesion = _quantity(
    "adhesion", "Ad", ONE, "1", "van der Waals force at initial contact over the film's, A/(36 pi mu v0 x0 a)", HAMAKER,
    nonnegative=True,
)  # fmt: skip
weight = _quantity("weight", r"g x_0/v_0^2", ONE, "1", "gravity over impact deceleration, g x0/v0^2")
string_ratio = _quantity("string_ratio", "l/a", ONE, "1", "string length over reduced radius")
elastic_gap = _quantity("elastic_gap", "x_r/x_0", ONE, "x0", "elastic length over film thickness", nonnegative=True)
rough_gap = _quantity("rough_gap", "x_b/x_0", ONE, "x0", "roughness over film thickness", nonnegative=True)
rupture_gap = _quantity("rupture_gap", "x_f/x_0", ONE, "x0", "rupture distance over film thickness")

VOCABULARY: dict[str, Quantity] = dict(_ALL)
DIMENSIONS: dict[sp.Basic, Dimension] = {quantity.symbol: quantity.dimension for quantity in VOCABULARY.values()}

R = 2 * a  # radius of one of two equal spheres
r = 4 * a + x  # distance between the centres
