# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 9f8f3e863d23bc450ee5011432afc0ee2e84fd7e613815134e4e5bd5146ab6b7
"""Dimensionless groups, as ratios of the model's terms, and scales from SI quantities.

A function each, of floats or CasADi expressions; ARGUMENTS names what each takes, in order.
"""

from __future__ import annotations

from typing import Any

from casadi import pi, tan


ARGUMENTS: dict[str, tuple[str, ...]] = {
    "stokes": ("reduced_radius", "reduced_mass", "viscosity", "speed"),
    "capillary": ("reduced_radius", "viscosity", "film_thickness", "surface_tension", "speed"),
    "centrifugal": ("reduced_radius", "reduced_mass", "surface_tension", "speed", "angle"),
    "reynolds": ("viscosity", "film_thickness", "density", "speed"),
    "aspect": ("reduced_radius", "film_thickness"),
    "obliquity": ("angle",),
    "glass_number": ("reduced_radius", "viscosity", "film_thickness", "glass_transition_pressure", "speed"),
    "weight": ("film_thickness", "gravity", "speed"),
    "string_ratio": ("reduced_radius", "string_length"),
    "elastic_gap": ("reduced_radius", "youngs_modulus", "poisson_ratio", "viscosity", "film_thickness", "speed"),
    "rough_gap": ("roughness", "film_thickness"),
    "rupture_gap": ("reduced_radius", "film_thickness", "volume", "contact_angle"),
    "initial_rate": ("reduced_radius", "speed", "angle"),
}


def stokes(reduced_radius: Any, reduced_mass: Any, viscosity: Any, speed: Any) -> Any:
    """Stokes number m v0/(6 pi mu a^2) [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - reduced_mass [kg]: reduced mass, M/2 for equal spheres
    - viscosity [Pa s]: viscosity of the liquid
    - speed [m/s]: normal approach speed at first touch
    """
    return reduced_mass*speed/(6*pi*reduced_radius**2*viscosity)


def capillary(reduced_radius: Any, viscosity: Any, film_thickness: Any, surface_tension: Any, speed: Any) -> Any:
    """capillary number 3 mu a v0/(sigma x0) [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at first touch
    - surface_tension [N/m]: surface tension of the liquid
    - speed [m/s]: normal approach speed at first touch
    """
    return 3*reduced_radius*speed*viscosity/(film_thickness*surface_tension)


def centrifugal(reduced_radius: Any, reduced_mass: Any, surface_tension: Any, speed: Any, angle: Any) -> Any:
    """centrifugal number m omega0^2/sigma [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - reduced_mass [kg]: reduced mass, M/2 for equal spheres
    - surface_tension [N/m]: surface tension of the liquid
    - speed [m/s]: normal approach speed at first touch
    - angle [rad]: impact angle, 0 head-on
    """
    return reduced_mass*speed**2*tan(angle)**2/(16*reduced_radius**2*surface_tension)


def reynolds(viscosity: Any, film_thickness: Any, density: Any, speed: Any) -> Any:
    """film Reynolds number rho v0 x0/mu [1].

    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at first touch
    - density [kg/m^3]: density of the liquid
    - speed [m/s]: normal approach speed at first touch
    """
    return density*film_thickness*speed/viscosity


def aspect(reduced_radius: Any, film_thickness: Any) -> Any:
    """film thickness over reduced radius, x0/a [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - film_thickness [m]: film thickness: the gap at first touch
    """
    return film_thickness/reduced_radius


def obliquity(angle: Any) -> Any:
    """tangent of the impact angle [1].

    - angle [rad]: impact angle, 0 head-on
    """
    return tan(angle)


def glass_number(reduced_radius: Any, viscosity: Any, film_thickness: Any, glass_transition_pressure: Any, speed: Any) -> Any:
    """glass-transition pressure over 3 mu a v0/x0^2 [1].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - viscosity [Pa s]: viscosity of the liquid
    - film_thickness [m]: film thickness: the gap at first touch
    - glass_transition_pressure [Pa]: glass-transition pressure of the liquid
    - speed [m/s]: normal approach speed at first touch
    """
    return film_thickness**2*glass_transition_pressure/(3*reduced_radius*speed*viscosity)


def weight(film_thickness: Any, gravity: Any, speed: Any) -> Any:
    """gravity over impact deceleration, g x0/v0^2 [1].

    - film_thickness [m]: film thickness: the gap at first touch
    - gravity [m/s^2]: gravitational acceleration
    - speed [m/s]: normal approach speed at first touch
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
    - film_thickness [m]: film thickness: the gap at first touch
    - speed [m/s]: normal approach speed at first touch
    """
    return 2**0.2*3**0.4*reduced_radius**0.6*speed**0.4*viscosity**0.4*(1 - poisson_ratio**2)**0.4/(film_thickness*youngs_modulus**0.4)


def rough_gap(roughness: Any, film_thickness: Any) -> Any:
    """roughness over film thickness [x0].

    - roughness [m]: height of the surface roughness
    - film_thickness [m]: film thickness: the gap at first touch
    """
    return roughness/film_thickness


def rupture_gap(reduced_radius: Any, film_thickness: Any, volume: Any, contact_angle: Any) -> Any:
    """rupture distance over film thickness [x0].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - film_thickness [m]: film thickness: the gap at first touch
    - volume [1]: bridge volume over R^3 (constant)
    - contact_angle [rad]: contact angle of the liquid on the sphere
    """
    return 2*reduced_radius*volume**(1/3)*(contact_angle/2 + 1)/film_thickness


def initial_rate(reduced_radius: Any, speed: Any, angle: Any) -> Any:
    """initial angular velocity, v0 tan(theta0)/(4a) [rad/s].

    - reduced_radius [m]: reduced radius, R/2 for equal spheres
    - speed [m/s]: normal approach speed at first touch
    - angle [rad]: impact angle, 0 head-on
    """
    return speed*tan(angle)/(4*reduced_radius)
