"""Emitted laws and groups against the expressions that they were printed from, in 30 digits; derivatives of structures.

Functions of structures are integrated beside the kernel, for any scene, by tests/harness/test_equations.py.
"""

import importlib
import math
import random
from collections.abc import Callable, Iterator
from functools import cache
from types import ModuleType
from typing import Any

import casadi
import mpmath
import numpy as np
import pytest
import sympy as sp
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics.law import Law, LawFunction
from wetdoublet.derive.physics.scaling import group_definitions
from wetdoublet.derive.vocabulary.quantities import VOCABULARY
from wetdoublet.generated import scaling
from wetdoublet.generated.assemble import Laws, casadi_functions

DIGITS = 30
RANGES = {
    "gap": (0.02, 0.98), "normal_velocity": (-1.5, 1.5), "orbital_momentum": (6.0, 18.0), "spin": (-0.5, 1.0),
    "rotation": (0.3, 3.0), "stokes": (0.02, 3.0), "aspect": (0.05, 0.3), "obliquity": (0.3, 3.0),
    "capillary": (0.5, 50.0), "volume": (0.01, 0.2), "contact_angle": (0.0, 1.0), "weight": (0.001, 0.5),
    "string_ratio": (30.0, 200.0), "glass_number": (1.0, 1e4), "elastic_gap": (1e-3, 0.1),
    "rough_gap": (1e-3, 0.1), "rupture_gap": (2.0, 30.0), "partner_spin": (-0.5, 1.0), "decay": (0.0, 3.0),
    "adhesion": (1e-4, 1.0), "radius_ratio": (0.2, 5.0), "mass_ratio": (0.2, 5.0), "dry_restitution": (0.5, 1.0),
    # arguments of laws
    "gap_over_radius": (1e-3, 0.5), "distance": (4.0, 6.0), "approach": (0.1, 2.0), "offset_squared": (0.01, 20.0),
    # SI
    "reduced_radius": (1e-5, 1e-2), "reduced_mass": (1e-9, 0.1), "viscosity": (0.01, 20.0),
    "film_thickness": (1e-6, 1e-3), "speed": (1e-3, 3.0), "angle": (0.1, 1.4), "surface_tension": (0.01, 0.1),
    "density": (500.0, 2000.0), "glass_transition_pressure": (1e6, 1e8), "gravity": (1.0, 20.0),
    "string_length": (0.1, 2.0), "hamaker": (1e-20, 1e-18), "youngs_modulus": (1e9, 3e11),
    "poisson_ratio": (0.1, 0.45), "roughness": (1e-8, 1e-5),
}  # fmt: skip


def emitted(name: str) -> ModuleType:
    return importlib.import_module(f"wetdoublet.generated.{name}")


@cache
def magnitude(node: sp.Basic) -> sp.Basic:
    """The expression with every term of every sum taken positive: the scale that cancellation is measured against."""
    if isinstance(node, sp.Add):
        return sp.Add(*map(magnitude, node.args))
    if isinstance(node, sp.Mul):
        return sp.Mul(*map(magnitude, node.args))
    if isinstance(node, sp.Pow) and node.exp.is_Number and node.exp.is_positive:
        return magnitude(node.base) ** node.exp
    return sp.Abs(node, evaluate=False)  # sympy would look for its sign, in an expression that grows with every level


Exact = Callable[..., list[mpmath.mpf]]


def exactly(arguments: list[sp.Symbol], expressions: list[sp.Expr]) -> Exact:
    """Values of the expressions, then of their magnitudes, in DIGITS digits; a root of zero is tiny, to divide by."""

    def root(value: Any) -> Any:
        return mpmath.sqrt(value) or mpmath.mpf(10) ** -200

    made = [*expressions, *map(magnitude, expressions)]
    return sp.lambdify(arguments, made, modules=[{"sqrt": root}, "mpmath"], cse=True)


def compare(label: str, exact: Exact, found: list[float], arguments: list[float]) -> None:
    """Demand 1e-12 of the largest term: a few thousand roundings of that size, many times what is done.

    Where the exact value is not real (roots of a doublet that spins backwards), NaN.
    """
    with mpmath.workdps(DIGITS):
        values = exact(*map(mpmath.mpf, arguments))
    assert len(values) == 2 * len(found), label
    for index, number in enumerate(found):
        value, scale = values[index], values[index + len(found)]
        if mpmath.im(value):
            assert math.isnan(number), (label, index, number, value, arguments)
            continue
        assert abs(number - value) <= 1e-12 * scale, (label, index, number, value, scale, arguments)


def draw(generator: random.Random, names: list[str]) -> list[float]:
    return [generator.uniform(*RANGES.get(name, (0.1, 1.0))) for name in names]


# Laws and groups


def _law_functions() -> Iterator[tuple[Law, LawFunction]]:
    for laws in LAWS.values():
        for law in laws.values():
            for function in law.functions:
                yield law, function


@pytest.mark.parametrize(
    ("law", "function"), list(_law_functions()), ids=lambda each: getattr(each, "module", each.name)
)
def test_law(law: Law, function: LawFunction):
    """A law's emitted function, as CasADi evaluates it, is its expression."""
    names = [argument.name for argument in function.arguments]
    symbols = [casadi.SX.sym(name) for name in names]
    value = getattr(emitted(f"laws.{law.module}"), function.name)(*symbols)
    compiled = casadi.Function("law", symbols, [casadi.SX(value)])
    exact = exactly(list(function.arguments), [function(*function.arguments)])
    generator = random.Random(f"{law.module}.{function.name}")
    for _ in range(20):
        arguments = draw(generator, names)
        compare(law.module, exact, [float(compiled(*arguments))], arguments)


@pytest.mark.parametrize("group", group_definitions(), ids=lambda symbol: symbol.name)
def test_group(group: sp.Symbol):
    """A group's emitted function is its definition, of floats and of CasADi symbols alike."""
    names = list(scaling.ARGUMENTS[group.name])
    function = getattr(scaling, group.name)
    symbols = [casadi.SX.sym(name) for name in names]
    compiled = casadi.Function("group", symbols, [casadi.SX(function(*symbols))])
    exact = exactly([VOCABULARY[name].symbol for name in names], [group_definitions()[group]])
    generator = random.Random(group.name)
    for _ in range(10):
        arguments = draw(generator, names)
        compare(group.name, exact, [float(compiled(*arguments))], arguments)
        compare(group.name, exact, [float(function(*arguments))], arguments)


# Structures

CHOICE = {"film": "finite", "arm": "midgap", "shear": "immersed", "bridge": "mikami", "glass": "literal"}


@pytest.mark.parametrize(("film", "shear"), [(1, 1), (0, 1), (0, 0)])
def test_derivatives_beside_a_structure(film: int, shear: int):
    """The Jacobian of the rates and the rates of the events are differences of the functions that they are of."""
    module = emitted("oblique_bridge")
    laws = Laws(**{slot: emitted(f"laws.{LAWS[slot][CHOICE[slot]].module}") for slot in module.SLOTS})
    functions = casadi_functions(module, laws, film=film, shear=shear)
    state, groups = (np.array(draw(random.Random(7), [*names])) for names in (module.STATES, module.GROUPS))

    def slope(name: str, along: np.ndarray) -> np.ndarray:
        ahead, behind = (functions[name](state + step * along, groups).full().ravel() for step in (1e-5, -1e-5))
        return np.asarray(ahead - behind) / 2e-5

    jacobian = functions["jacobian"](state, groups).full()
    expected = np.stack([slope("right_hand_side", axis) for axis in np.eye(state.size)], axis=1)
    np.testing.assert_allclose(jacobian, expected, rtol=1e-6, atol=1e-7 * np.abs(jacobian).max())
    rates = functions["right_hand_side"](state, groups).full().ravel()
    found = functions["event_rates"](state, groups).full().ravel()
    size = np.abs(rates).max()
    expected = size * slope("events", rates / size)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-7 * np.abs(found).max())


def test_an_empty_slot_is_named():
    """A structure whose slot no law fills says which slot."""
    with pytest.raises(AttributeError, match="'bridge'"):
        _ = Laws(film=emitted("laws.film_finite")).bridge
