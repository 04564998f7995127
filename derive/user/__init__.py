"""A user's laws, terms, events and quantities; a model file begins with `from wetdoublet.derive.user import *`."""

# ruff: noqa: F401 -- the names of people's model files
import sympy as sp
from sympy import Abs, Max, Min, Piecewise, Rational, acos, asin, atan, cos, cosh, exp, log, sin, sinh, sqrt, tan, tanh

from ..physics.pendulum import offset_squared
from ..physics.references import Reference
from ..physics.slots import approach, distance, h
from ..vocabulary.quantities import (
    A_H,
    E,
    R,
    a,
    aspect,
    beta,
    e_dry,
    g,
    gap,
    glass_number,
    l_s,
    m,
    mu,
    normal_velocity,
    nu,
    omega,
    omega0,
    p_gt,
    r,
    rho,
    sigma,
    string_ratio,
    t,
    u,
    v0,
    x,
    x0,
    x_b,
    xi,
)
from ..vocabulary.quantities import contact_angle as phi
from ..vocabulary.quantities import normal_velocity as opening  # its name in older model files
from ..vocabulary.quantities import volume as V
from .declarations import Formula, let, positive, quantity
from .laws import law
from .motion import criterion, energy, event, force_on

pi = sp.pi
