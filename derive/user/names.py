"""Names in model files: those that a declaration may not bear, and those that are there to be used."""

import ast
import keyword
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import sympy as sp
from sympy.printing.c import known_functions_C99, reserved_words, reserved_words_c99
from sympy.printing.cxx import reserved

from ..vocabulary import quantities
from ..vocabulary.dimensions import LENGTH, Dimension, DimensionError, dimension_of
from ..vocabulary.quantities import VOCABULARY

EMITTED = "a name in emitted functions"
_GENERATED = Path(__file__).resolve().parents[2] / "generated"  # as text: it is not imported here
_MACROS = {"asm", "errno", "far", "linux", "near", "typeof", "unix"}  # of compilers and C's headers
_ARGUMENTS = {"after", "c", "guard", "of", "s", "splat", "v", "vec", "y"}  # of C functions in which own names stand
_GUARDS = {f"{word}_{k}" for word in ("base", "kink", "part", "side") for k in range(1, 100)} | {"squared_width"}
"""Parts of laws that have kinks."""


@cache
def taken() -> dict[str, str]:
    """Every such name, and what it is."""
    c_words = {word.strip(",") for word in (*reserved_words, *reserved_words_c99, *reserved["C++17"])}
    functions = {name for name in known_functions_C99.values() if isinstance(name, str)}
    result = dict.fromkeys(_names("*.py") | _ARGUMENTS | _GUARDS, EMITTED)
    result |= dict.fromkeys(_names("laws/*.py"), "an argument of laws")
    result |= dict.fromkeys(
        functions | {"abs", "fabs", "if_else", "max", "min", "pi", "result"}, "a name that laws are emitted with"
    )
    result |= dict.fromkeys(c_words | _MACROS, "a word of C")
    result |= dict.fromkeys([*keyword.kwlist, *keyword.softkwlist], "a word of Python")
    return result | dict.fromkeys(VOCABULARY, "a quantity of the library")


def _names(files: str) -> set[str]:
    """Arguments of the library's emitted functions, and in its structures what these import and assign as well."""
    names = set()
    for path in _GENERATED.glob(files):
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.arg):
                names.add(node.arg)
            elif path.stem.startswith(("oblique", "head_on")) and isinstance(node, ast.alias):
                names.add(node.name)
            elif path.stem.startswith(("oblique", "head_on")) and isinstance(node, ast.Name):
                names.add(node.id)
    return names


_MORE = {
    "R": ("m", "radius of one of two equal spheres, 2 a"),
    "r": ("m", "distance between the centres, 4 a + x"),
    "h": ("1", "gap over the radius of a sphere, x/R: argument of a bridge's law"),
    "distance": ("1", "distance between the centres over the reduced radius, r/a: argument of an arm's law"),
    "approach": ("1", "speed of approach, -u/v0: argument of a glass law"),
    "offset_squared": ("1", "squared offset of the pendulum over a^2: argument of a law of the strings"),
}
NO_GROUP = (quantities.rho, quantities.E, quantities.nu, quantities.x_b)
"""Quantities of a scene that no term of the equations has; a model that needs one declares its own."""


_LETTERS = {value.name: key for key, value in reversed(vars(quantities).items()) if isinstance(value, sp.Symbol)}
_LETTERS |= {"volume": "V", "contact_angle": "phi"}
"""Vocabulary name -> name in model files."""


def as_written(expression: sp.Expr) -> sp.Expr:
    """An expression in the names of model files, for messages: x for the separation, R for 2 a where shorter."""
    letters = {
        symbol: sp.Symbol(_LETTERS[symbol.name], **symbol.assumptions0)
        for symbol in expression.free_symbols
        if symbol.name in _LETTERS
    }
    by_radius = letters | {quantities.a: sp.Symbol("R", positive=True) / 2}
    return min((expression.xreplace(names) for names in (letters, by_radius)), key=lambda text: len(str(text)))


def dimension_as_written(expression: sp.Expr, of: Mapping[sp.Basic, Dimension]) -> Dimension | None:
    """`dimension_of`, whose errors have the names of model files."""
    try:
        return dimension_of(expression, of)
    except DimensionError:
        letters = {as_written(symbol): of[symbol] for symbol in expression.free_symbols & of.keys()}
        dimension_of(as_written(expression), {**of, **letters, sp.Symbol("R", positive=True): LENGTH})
        raise


def listed(names: Mapping[str, object]) -> str:
    """A table of the symbols among the names of a model file: name, unit, meaning."""
    of = {quantity.symbol: (quantity.unit, quantity.meaning) for quantity in VOCABULARY.values()}
    symbols = {name: value for name, value in names.items() if isinstance(value, sp.Expr) and value not in NO_GROUP}
    rows = {name: _MORE.get(name) or of.get(value) for name, value in symbols.items()}
    return "\n".join(f"{name:<16}{row[0]:<8}{row[1]}" for name, row in sorted(rows.items()) if row)
