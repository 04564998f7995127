"""Pendulum strings: forces from the potential of two equal spheres hung from pivots one diameter apart."""

from functools import cache

import sympy as sp

from ...vocabulary.quantities import a, beta, g, l_s, m, string_ratio
from ..mechanics import without_sines
from .base import Law, LawFunction
from .references import DOUBLETS

r = sp.Symbol("r", positive=True)  # distance between the centres
offset_squared = sp.Symbol("offset_squared", nonnegative=True)  # (d/a)^2, with d the horizontal swing of either sphere


def half_angles(expression: sp.Expr) -> sp.Expr:
    """The expression in terms of sin(beta/2) and cos(beta/2)."""
    half = beta / 2
    return expression.subs({sp.sin(beta): 2 * sp.sin(half) * sp.cos(half), sp.cos(beta): 1 - 2 * sp.sin(half) ** 2})


@cache
def swing_squared() -> sp.Expr:
    """d^2, with d the horizontal displacement of either sphere: half the change of the separation vector.

    Written in r - 4a and sin(beta/2), because r^2 + 16 a^2 - 8 a r cos(beta) cancels at small swings.
    """
    now = sp.Matrix([r * sp.cos(beta), r * sp.sin(beta)])
    rest = sp.Matrix([4 * a, 0])
    half = (now - rest) / 2
    sound = (r - 4 * a) ** 2 / 4 + 4 * a * r * sp.sin(beta / 2) ** 2
    half_angle = sp.cos(beta), 1 - 2 * sp.sin(beta / 2) ** 2
    if sp.expand(without_sines(half.dot(half), beta).subs(*half_angle) - sound) != 0:
        raise ArithmeticError("the swing is not what its cancellation-free form says")
    return sound


@cache
def height(small_angle: bool) -> sp.Expr:
    """Height over a gained by a pendulum of length l/a = string_ratio displaced horizontally by d."""
    exact = string_ratio - sp.sqrt(string_ratio**2 - offset_squared)
    return exact.series(offset_squared, 0, 2).removeO() if small_angle else exact


@cache
def rise(small_angle: bool) -> sp.Expr:
    """`height` rationalised, without cancellation at small swings."""
    if small_angle:
        return height(True)
    conjugate = string_ratio + sp.sqrt(string_ratio**2 - offset_squared)
    return sp.expand(height(False) * conjugate) / conjugate


@cache
def potential(small_angle: bool) -> sp.Expr:
    """U_s(r, beta) in SI: two spheres, each of mass 2m, lifted by `rise`."""
    swung = {offset_squared: swing_squared() / a**2, string_ratio: l_s / a}
    return 4 * m * g * a * height(small_angle).subs(swung, simultaneous=True)


def _law(name: str, small_angle: bool, meaning: str) -> Law:
    stiffness = sp.simplify(2 * height(small_angle).diff(offset_squared))
    arguments, doc = (
        (string_ratio, offset_squared),
        "Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2).",
    )
    functions = (
        LawFunction("rise", arguments, rise(small_angle), "Height gained by each sphere over a."),
        LawFunction("stiffness", arguments, stiffness, doc),
    )
    source = f"{DOUBLETS.short}: vertical tension balances the weight"
    return Law("strings", name, meaning, source, functions, references=(DOUBLETS,))


STRINGS = (
    _law("exact", False, "strings of length l, exact geometry"),
    _law("small-angle", True, "linearised in the swing: sqrt(l^2 - d^2) -> l"),
)
