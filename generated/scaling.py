# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 ea907fe1a7ce886d3c7f8f028fc6d1a45b4cc553fa85c3cb5cf554447c03fcc9
"""Dimensionless groups, as ratios of the model's terms, and scales from SI quantities.

Each is a function of floats or CasADi expressions; ARGUMENTS has the names of its arguments, in order.
"""

from __future__ import annotations

from typing import Any

from casadi import fabs, fmax, pi, sqrt, tan


ARGUMENTS: dict[str, tuple[str, ...]] = {
    "stokes": ("reduced_radius", "reduced_mass", "viscosity", "speed"),
    "capillary": ("reduced_radius", "viscosity", "film_thickness", "surface_tension", "speed"),
    "centrifugal": ("reduced_radius", "reduced_mass", "surface_tension", "speed", "angle"),
    "adhesion": ("reduced_radius", "viscosity", "film_thickness", "hamaker", "speed"),
    "reynolds": ("viscosity", "film_thickness", "density", "speed"),
    "aspect": ("reduced_radius", "film_thickness"),
    "obliquity": ("reduced_radius", "speed", "angle", "impact_spin"),
    "glass_number": ("reduced_radius", "viscosity", "film_thickness", "glass_transition_pressure", "speed"),
    "weight": ("film_thickness", "gravity", "speed"),
    "string_ratio": ("reduced_radius", "string_length"),
    "elastic_gap": ("reduced_radius", "youngs_modulus", "poisson_ratio", "viscosity", "film_thickness", "speed"),
    "rough_gap": ("roughness", "film_thickness"),
    "rupture_gap": ("reduced_radius", "film_thickness", "volume", "contact_angle"),
    "initial_rate": ("reduced_radius", "speed", "angle"),
    "initial_rate_pair": ("reduced_radius", "speed", "angle", "radius_ratio"),
    "rate_scale": ("reduced_radius", "speed", "obliquity"),
    "rate_scale_pair": ("reduced_radius", "speed", "obliquity", "radius_ratio"),
    "rate_scale_wall": ("reduced_radius", "speed", "obliquity"),
    "centrifugal_pair": ("reduced_radius", "reduced_mass", "surface_tension", "speed", "angle", "radius_ratio"),
    "generalised_centrifugal": ("reduced_radius", "reduced_mass", "initial_rate", "attraction_force"),
    "obliquity_pair": ("reduced_radius", "speed", "angle", "impact_spin", "impact_partner_spin", "radius_ratio"),
    "obliquity_wall": ("reduced_radius", "speed", "angle", "impact_spin"),
    "obliquity_space": ("reduced_radius", "speed", "impact_turning_x", "impact_turning_y", "impact_turning_z", "impact_spin_x", "impact_spin_y", "impact_spin_z", "impact_partner_spin_x", "impact_partner_spin_y", "impact_partner_spin_z", "radius_ratio"),
    "initial_turning": ("angle", "obliquity"),
    "initial_spin": ("rate_scale", "impact_spin"),
    "initial_partner_spin": ("rate_scale", "impact_partner_spin"),
}


def stokes(reduced_radius: Any, reduced_mass: Any, viscosity: Any, speed: Any) -> Any:
    """Stokes number m v0/(6 pi mu a^2) [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - reduced_mass [kg]: reduced mass, M/2 for equal spheres
    - viscosity [Pa s]: viscosity of the liquid
    - speed [m/s]: normal approach speed at initial contact
    """
    return reduced_mass*speed/(6*pi*reduced_radius**2*viscosity)


def capillary(reduced_radius: Any, viscosity: Any, film_thickness: Any, surface_tension: Any, speed: Any) -> Any:
    """capillary number 3 mu a v0/(sigma x0) [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at initial contact
    - surface_tension [N/m]: surface tension of the liquid
    - speed [m/s]: normal approach speed at initial contact
    """
    return 3*reduced_radius*speed*viscosity/(film_thickness*surface_tension)


def centrifugal(reduced_radius: Any, reduced_mass: Any, surface_tension: Any, speed: Any, angle: Any) -> Any:
    """centrifugal number m omega0^2/sigma [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - reduced_mass [kg]: reduced mass, M/2 for equal spheres
    - surface_tension [N/m]: surface tension of the liquid
    - speed [m/s]: normal approach speed at initial contact
    - angle [rad]: impact angle, 0 along the line of centres
    """
    return reduced_mass*speed**2*tan(angle)**2/(16*reduced_radius**2*surface_tension)


def adhesion(reduced_radius: Any, viscosity: Any, film_thickness: Any, hamaker: Any, speed: Any) -> Any:
    """van der Waals force at initial contact over the film's, A/(36 pi mu v0 x0 a) [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at initial contact
    - hamaker [J]: Hamaker constant of the spheres across the liquid
    - speed [m/s]: normal approach speed at initial contact
    """
    return hamaker/(36*pi*film_thickness*reduced_radius*speed*viscosity)


def reynolds(viscosity: Any, film_thickness: Any, density: Any, speed: Any) -> Any:
    """film Reynolds number rho v0 x0/mu [1].

    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at initial contact
    - density [kg/m^3]: density of the liquid
    - speed [m/s]: normal approach speed at initial contact
    """
    return density*film_thickness*speed/viscosity


def aspect(reduced_radius: Any, film_thickness: Any) -> Any:
    """film thickness over reduced radius, x0/a [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - film_thickness [m]: film thickness: the gap at initial contact
    """
    return film_thickness/reduced_radius


def obliquity(reduced_radius: Any, speed: Any, angle: Any, impact_spin: Any) -> Any:
    """largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0 [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - angle [rad]: impact angle, 0 along the line of centres
    - impact_spin [rad/s]: spin at initial contact
    """
    return fmax(2*reduced_radius*fabs(impact_spin)/speed, tan(angle))


def glass_number(reduced_radius: Any, viscosity: Any, film_thickness: Any, glass_transition_pressure: Any, speed: Any) -> Any:
    """glass-transition pressure over 3 mu a v0/x0^2 [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at initial contact
    - glass_transition_pressure [Pa]: glass-transition pressure of the liquid
    - speed [m/s]: normal approach speed at initial contact
    """
    return film_thickness**2*glass_transition_pressure/(3*reduced_radius*speed*viscosity)


def weight(film_thickness: Any, gravity: Any, speed: Any) -> Any:
    """gravity over impact deceleration, g x0/v0^2 [1].

    - film_thickness [m]: film thickness: the gap at initial contact
    - gravity [m/s^2]: gravitational acceleration
    - speed [m/s]: normal approach speed at initial contact
    """
    return film_thickness*gravity/speed**2


def string_ratio(reduced_radius: Any, string_length: Any) -> Any:
    """string length over reduced radius [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - string_length [m]: length of the pendulum strings
    """
    return string_length/reduced_radius


def elastic_gap(reduced_radius: Any, youngs_modulus: Any, poisson_ratio: Any, viscosity: Any, film_thickness: Any, speed: Any) -> Any:
    """elastic length over film thickness [x0].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - youngs_modulus [Pa]: Young's modulus of the spheres
    - poisson_ratio [1]: Poisson's ratio of the spheres
    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at initial contact
    - speed [m/s]: normal approach speed at initial contact
    """
    return 2**0.2*3**0.4*reduced_radius**0.6*speed**0.4*viscosity**0.4*(1 - poisson_ratio**2)**0.4/(film_thickness*youngs_modulus**0.4)


def rough_gap(roughness: Any, film_thickness: Any) -> Any:
    """roughness over film thickness [x0].

    - roughness [m]: height of the surface roughness
    - film_thickness [m]: film thickness: the gap at initial contact
    """
    return roughness/film_thickness


def rupture_gap(reduced_radius: Any, film_thickness: Any, volume: Any, contact_angle: Any) -> Any:
    """rupture distance over film thickness [x0].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - film_thickness [m]: film thickness: the gap at initial contact
    - volume [1]: bridge volume over R^3 (constant)
    - contact_angle [rad]: contact angle of the liquid on the sphere
    """
    return 2*reduced_radius*volume**(1/3)*(contact_angle/2 + 1)/film_thickness


def initial_rate(reduced_radius: Any, speed: Any, angle: Any) -> Any:
    """initial angular velocity, v0 tan(theta0)/(4a) [rad/s].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - angle [rad]: impact angle, 0 along the line of centres
    """
    return speed*tan(angle)/(4*reduced_radius)


def initial_rate_pair(reduced_radius: Any, speed: Any, angle: Any, radius_ratio: Any) -> Any:
    """initial angular velocity of a pair, v0 tan(theta0)/(R1 + R2) [rad/s].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - angle [rad]: impact angle, 0 along the line of centres
    - radius_ratio [1]: radius of the partner over that of the sphere
    """
    return radius_ratio*speed*tan(angle)/(reduced_radius*(radius_ratio + 1)**2)


def rate_scale(reduced_radius: Any, speed: Any, obliquity: Any) -> Any:
    """scale of angular velocities, omega0 unless the spheres spin at first [rad/s].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
    """
    return obliquity*speed/(4*reduced_radius)


def rate_scale_pair(reduced_radius: Any, speed: Any, obliquity: Any, radius_ratio: Any) -> Any:
    """scale of angular velocities of an unequal pair [rad/s].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
    - radius_ratio [1]: radius of the partner over that of the sphere
    """
    return obliquity*radius_ratio*speed/(reduced_radius*(radius_ratio + 1)**2)


def rate_scale_wall(reduced_radius: Any, speed: Any, obliquity: Any) -> Any:
    """scale of the spin beside a wall [rad/s].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
    """
    return obliquity*speed/reduced_radius


def centrifugal_pair(reduced_radius: Any, reduced_mass: Any, surface_tension: Any, speed: Any, angle: Any, radius_ratio: Any) -> Any:
    """centrifugal number of an unequal pair [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - reduced_mass [kg]: reduced mass, M/2 for equal spheres
    - surface_tension [N/m]: surface tension of the liquid
    - speed [m/s]: normal approach speed at initial contact
    - angle [rad]: impact angle, 0 along the line of centres
    - radius_ratio [1]: radius of the partner over that of the sphere
    """
    return radius_ratio**2*reduced_mass*speed**2*tan(angle)**2/(reduced_radius**2*surface_tension*(radius_ratio + 1)**4)


def generalised_centrifugal(reduced_radius: Any, reduced_mass: Any, initial_rate: Any, attraction_force: Any) -> Any:
    """generalised centrifugal number m omega0^2 a/F [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - reduced_mass [kg]: reduced mass, M/2 for equal spheres
    - initial_rate [rad/s]: initial angular velocity, v0 tan(theta0)/(4a)
    - attraction_force [N]: all that attracts, at a gap: bridge and van der Waals
    """
    return initial_rate**2*reduced_mass*reduced_radius/attraction_force


def obliquity_pair(reduced_radius: Any, speed: Any, angle: Any, impact_spin: Any, impact_partner_spin: Any, radius_ratio: Any) -> Any:
    """T of an unequal pair [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - angle [rad]: impact angle, 0 along the line of centres
    - impact_spin [rad/s]: spin at initial contact
    - impact_partner_spin [rad/s]: spin of the partner at initial contact
    - radius_ratio [1]: radius of the partner over that of the sphere
    """
    return fmax(fmax(reduced_radius*(radius_ratio + 1)*fabs(impact_partner_spin)/speed, reduced_radius*(radius_ratio + 1)*fabs(impact_spin)/(radius_ratio*speed)), tan(angle))


def obliquity_wall(reduced_radius: Any, speed: Any, angle: Any, impact_spin: Any) -> Any:
    """T beside a wall [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - angle [rad]: impact angle, 0 along the line of centres
    - impact_spin [rad/s]: spin at initial contact
    """
    return fmax(reduced_radius*fabs(impact_spin)/speed, tan(angle))


def obliquity_space(reduced_radius: Any, speed: Any, impact_turning_x: Any, impact_turning_y: Any, impact_turning_z: Any, impact_spin_x: Any, impact_spin_y: Any, impact_spin_z: Any, impact_partner_spin_x: Any, impact_partner_spin_y: Any, impact_partner_spin_z: Any, radius_ratio: Any) -> Any:
    """T in space: a length of its three vectors together [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at initial contact
    - impact_turning_x [rad/s]: angular velocity of the line of centres at initial contact, x component
    - impact_turning_y [rad/s]: angular velocity of the line of centres at initial contact, y component
    - impact_turning_z [rad/s]: angular velocity of the line of centres at initial contact, z component
    - impact_spin_x [rad/s]: spin of the first sphere at initial contact, x component
    - impact_spin_y [rad/s]: spin of the first sphere at initial contact, y component
    - impact_spin_z [rad/s]: spin of the first sphere at initial contact, z component
    - impact_partner_spin_x [rad/s]: spin of the partner at initial contact, x component
    - impact_partner_spin_y [rad/s]: spin of the partner at initial contact, y component
    - impact_partner_spin_z [rad/s]: spin of the partner at initial contact, z component
    - radius_ratio [1]: radius of the partner over that of the sphere
    """
    return sqrt(impact_partner_spin_x**2*reduced_radius**2*(radius_ratio + 1)**2 + impact_partner_spin_y**2*reduced_radius**2*(radius_ratio + 1)**2 + impact_partner_spin_z**2*reduced_radius**2*(radius_ratio + 1)**2 + impact_spin_x**2*reduced_radius**2*(radius_ratio + 1)**2/radius_ratio**2 + impact_spin_y**2*reduced_radius**2*(radius_ratio + 1)**2/radius_ratio**2 + impact_spin_z**2*reduced_radius**2*(radius_ratio + 1)**2/radius_ratio**2 + impact_turning_x**2*reduced_radius**2*(radius_ratio + 1)**4/radius_ratio**2 + impact_turning_y**2*reduced_radius**2*(radius_ratio + 1)**4/radius_ratio**2 + impact_turning_z**2*reduced_radius**2*(radius_ratio + 1)**4/radius_ratio**2)/speed


def initial_turning(angle: Any, obliquity: Any) -> Any:
    """tan(theta0)/T, 1 without spins [1].

    - angle [rad]: impact angle, 0 along the line of centres
    - obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
    """
    return tan(angle)/obliquity


def initial_spin(rate_scale: Any, impact_spin: Any) -> Any:
    """spin at initial contact over Omega [Omega].

    - rate_scale [rad/s]: scale of angular velocities, omega0 unless the spheres spin at first
    - impact_spin [rad/s]: spin at initial contact
    """
    return impact_spin/rate_scale


def initial_partner_spin(rate_scale: Any, impact_partner_spin: Any) -> Any:
    """spin of the partner at initial contact over Omega [Omega].

    - rate_scale [rad/s]: scale of angular velocities, omega0 unless the spheres spin at first
    - impact_partner_spin [rad/s]: spin of the partner at initial contact
    """
    return impact_partner_spin/rate_scale
