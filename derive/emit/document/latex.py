"""A strict sympy-to-LaTeX printer in the vocabulary's symbols: a whitelist of nodes, anything else is an error.

Only LaTeX that matplotlib's mathtext supports is written, so the same text can be drawn and printed. Factors are in the
order of the literature (6 pi mu a^2 u), sums follow fractions, and negative terms are last.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import sympy as sp

from ...physics.mechanics import F_c, F_n, F_t, F_w, M_beta, M_spin, M_x, Q_beta, Q_spin, Q_x, S_n, S_t
from ...vocabulary.quantities import A_H, VOCABULARY, a, beta, e_dry, g, m, mu, r, sigma, v0
from ..casadi.printer import EmissionError, signed_sum

NAMES: dict[str, str] = {
    **{name: quantity.latex for name, quantity in VOCABULARY.items()},
    # symbols outside the vocabulary: the paper's forces, and intermediates of laws
    Q_x.name: "Q_x", Q_beta.name: r"Q_\beta", Q_spin.name: r"Q_\xi",
    M_x.name: "M_x", M_beta.name: r"M_\beta", M_spin.name: r"M_\xi",
    F_n.name: "F_{L,n}", F_t.name: "F_{L,t}", F_c.name: "F_c", F_w.name: "F_w", S_n.name: "F_{S,n}",
    S_t.name: "F_{S,t}",
    "swing": "d", "rim": "H", "v_s": "v_s", "m_t": "m_t", "Q": "Q", "compliance": r"\theta_e", "decay": "A",
    "offset": "B", "tail": "C", "log_volume": r"\Lambda", "log_scaled_gap": r"\lambda", "scaled_gap": "S",
    "cylinder_reach": "s", "half_filling_angle": r"\alpha", **{f"f{k}": f"f_{k}" for k in range(1, 5)},
}  # fmt: skip
# order of the factors; the rest as in the vocabulary
_FIRST = ["decay", *(f"f{k}" for k in range(1, 5)), *(s.name for s in (m, mu, A_H, g, a, sigma, e_dry, v0))]
_ORDER = {name: place for place, name in enumerate(dict.fromkeys([*_FIRST, *NAMES]))}
_FUNCTIONS: dict[type, str] = {
    sp.log: r"\ln", sp.sin: r"\sin", sp.cos: r"\cos", sp.tan: r"\tan", sp.exp: r"\exp", sp.asin: r"\arcsin",
    sp.acos: r"\arccos", sp.atan: r"\arctan", sp.sinh: r"\sinh", sp.cosh: r"\cosh", sp.tanh: r"\tanh",
}  # fmt: skip
_OPERATORS = tuple(_FUNCTIONS.values())


@contextmanager
def naming(names: Mapping[str, str]) -> Iterator[None]:
    """Context manager: print symbols of a user's model as the model declares."""
    order = {name: len(_ORDER) + place for place, name in enumerate(names) if name not in NAMES}
    added = {name: text for name, text in names.items() if name not in NAMES}
    NAMES.update(added)
    _ORDER.update(order)
    try:
        yield
    finally:
        for name in added:
            del NAMES[name], _ORDER[name]


def latex(expression: sp.Expr) -> str:
    """An expression in LaTeX; EmissionError names a node or symbol that has none."""
    return _print(sp.sympify(expression))


def _print(node: sp.Basic) -> str:
    if isinstance(node, sp.Symbol):
        if node.name not in NAMES:
            raise EmissionError(f"symbol {node.name!r} has no LaTeX name")
        return NAMES[node.name]
    if node is sp.pi:
        return r"\pi"
    if isinstance(node, sp.Integer):
        return str(int(node))
    if isinstance(node, sp.Float):
        return f"{float(node):g}" if node == sp.Float(f"{float(node):g}") else repr(float(node))
    if isinstance(node, sp.Add):
        return _sum(node)
    if isinstance(node, (sp.Mul, sp.Rational)) or (isinstance(node, sp.Pow) and node.exp.could_extract_minus_sign()):
        return _product(node)
    if isinstance(node, sp.Pow):
        return _power(node)
    if type(node) in _FUNCTIONS:
        return f"{_FUNCTIONS[type(node)]} {_argument(node)}"
    if isinstance(node, sp.Abs):
        return rf"\left| {_print(node.args[0])} \right|"
    if isinstance(node, (sp.Min, sp.Max)):
        inside = ", ".join(_print(argument) for argument in sorted(node.args, key=sp.default_sort_key))
        return rf"\{'min' if isinstance(node, sp.Min) else 'max'} \left( {inside} \right)"
    if isinstance(node, sp.Piecewise):
        rows = r" \\ ".join(rf"{_print(value)} & {_condition(when)}" for value, when in node.args)
        return rf"\begin{{cases}} {rows} \end{{cases}}"
    raise EmissionError(f"no LaTeX for {type(node).__name__}: {node}")


def _condition(node: sp.Basic) -> str:
    if node == sp.true:
        return r"\text{else}"
    sign = {"<": "<", "<=": r"\leq", ">": ">", ">=": r"\geq"}[node.rel_op]
    return f"{_print(node.lhs)} {sign} {_print(node.rhs)}"


def _sum(node: sp.Add) -> str:
    return signed_sum(sorted(node.args, key=_place_in_sum), _print)


def _place_in_sum(term: sp.Expr) -> tuple[bool, int, tuple[int, ...]]:
    """Sort key of a term in a sum: positive terms first, then numbers, then by the leading symbol."""
    places = sorted(_ORDER.get(symbol.name, len(_ORDER)) for symbol in term.free_symbols)
    return (bool(term.could_extract_minus_sign()), bool(term.atoms(sp.Function)), tuple(places))


def _product(node: sp.Expr) -> str:
    if node.could_extract_minus_sign():
        body = -node
        return f"-{_wrapped(body)}" if isinstance(body, sp.Add) else f"-{_print(body)}"
    over: list[sp.Expr] = []
    under: list[sp.Expr] = []
    for factor in sp.Mul.make_args(node):
        if isinstance(factor, sp.Rational):
            over += [sp.Integer(factor.p)] if factor.p != 1 else []
            under += [sp.Integer(factor.q)] if factor.q != 1 else []
        elif isinstance(factor, sp.Pow) and factor.exp.could_extract_minus_sign():
            under.append(factor.base**-factor.exp)
        else:
            over.append(factor)
    over, under = sorted(over, key=_place), sorted(under, key=_place)
    if not under:
        return _factors(over) or "1"
    if all(factor.is_number for factor in under):  # 16/5 m a^2, but x/2
        inside = [factor for factor in over if factor.is_number] or over
    else:
        bases = [(factor, factor.base if isinstance(factor, sp.Pow) else factor) for factor in over]
        inside = [factor for factor, base in bases if not isinstance(base, (sp.Add, sp.Function))] or over
    rest = [factor for factor in over if factor not in inside]
    # a denominator consisting of one sum needs no brackets
    below = _print(under[0]) if len(under) == 1 else _factors(under)
    above = _print(inside[0]) if len(inside) == 1 else _factors(inside) or "1"
    behind = _factors(rest)
    between = r" \, " if behind.startswith(_OPERATORS) else " "
    return between.join(filter(None, [rf"\frac{{{above}}}{{{below}}}", behind]))


def _place(factor: sp.Expr) -> tuple[int, int]:
    """Sort key of a factor: numbers, pi, roots of numbers, symbols in their order, distances, sums, functions."""
    if isinstance(factor, (sp.Integer, sp.Float)):
        return 0, 0
    if factor.is_number:
        return 1, 0
    base = factor.base if isinstance(factor, sp.Pow) else factor
    if isinstance(base, sp.Symbol):
        return (2, _ORDER.get(base.name, len(_ORDER))) if base.name != "rotation_rate" else (6, 0)
    if base == r:
        return 3, 0
    return (5 if isinstance(base, sp.Function) else 4), 0


def _factors(factors: list[sp.Expr]) -> str:
    printed = [_wrapped(factor) if isinstance(factor, sp.Add) else _print(factor) for factor in factors]
    spaced = [rf"\, {text}" if text.startswith(_OPERATORS) else text for text in printed]
    return " ".join(spaced).removeprefix(r"\, ")


def _wrapped(node: sp.Basic) -> str:
    return rf"\left( {_print(node)} \right)"


def _power(node: sp.Pow) -> str:
    base, power = node.args
    if power == sp.Rational(1, 2):
        return rf"\sqrt{{{_print(base)}}}"
    exponent = f"{power.p}/{power.q}" if isinstance(power, sp.Rational) and power.q != 1 else _print(power)
    if type(base) in _FUNCTIONS:
        return rf"{_FUNCTIONS[type(base)]}^{{{exponent}}} {_argument(base)}"
    body = _print(base) if isinstance(base, (sp.Symbol, sp.Integer)) or base is sp.pi else _wrapped(base)
    return f"{body}^{{{exponent}}}"


def _argument(node: sp.Function) -> str:
    """The argument of a function, without brackets if it is a single symbol."""
    argument = node.args[0]
    if isinstance(argument, sp.Symbol) or argument == beta / 2:
        return _print(argument)
    if type(node) is sp.exp:
        return rf"\left[ {_print(argument)} \right]"
    return _wrapped(argument)
