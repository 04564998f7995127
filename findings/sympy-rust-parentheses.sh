#!/usr/bin/env bash
# sympy 1.14.0: `rust_code` of a product of sums
#
# Guess: the printers for C, Fortran and Rust write the same expression, each in its own grammar.
# What happens: the Rust printer drops the parentheses around a sum that is a factor: v (e + 1) becomes `v*e + 1.0`,
#   (x + 1) (y + 1) becomes `x + 1.0*y + 1.0`, and coth(x) alone is wrong in the same way. The text is valid Rust, and
#   nothing warns. Powers of a sum keep them, and so does its reciprocal as the *last* factor, so that x / (e + 1)
#   is right. C and Fortran are right.
# Why: a product is the text of its factors in a row; this printer puts brackets around the base of a power, and none
#   around a sum.
# How it is shown without a Rust compiler: operators bind alike in Rust and Python and the methods have names of
#   their own, so that the printed text is evaluated by Python with a number that has these methods.
# Why it matters here: momentum exchanged at an impact is m v (1 + e), damping c (1 - e^2): each law has such a
#   product. Multiply them out first (`sympy.expand`), or generate C.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'sympy==1.14.0' 'mpmath==1.3.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
import re

import sympy


class F64(float):
    """A number with the methods of Rust's f64 that are printed here."""

    def exp(self):
        return F64(math.exp(self))

    def sqrt(self):
        return F64(math.sqrt(self))

    def recip(self):
        return F64(1 / self)

    def powi(self, power):
        return F64(float(self) ** power)

    def __neg__(self):
        return F64(-float(self))


for name in ("add", "sub", "mul", "radd", "rsub", "rmul"):
    plain = getattr(float, f"__{name}__")
    setattr(F64, f"__{name}__", lambda one, two, plain=plain: F64(plain(float(one), float(two))))

e, k, v, x, y = sympy.symbols("e k v x y", positive=True)
POINT = {e: 0.5, k: 9.0, v: 2.0, x: 0.7, y: 3.0}
names = {str(symbol): F64(value) for symbol, value in POINT.items()}
print("sympy", sympy.__version__)
print("expression                Rust                                              Rust's value     true")
ratio = {}
for expression in (
    v * (e + 1), v * (1 - e**2), (x + 1) * (y + 1), sympy.sqrt(k) * x * (e + 1), sympy.coth(x),
    x / (e + 1), v * (e + 1) ** 2, sympy.exp(-x) * (2 * k),
):  # fmt: skip
    rust, true = sympy.rust_code(expression), float(expression.subs(POINT))
    value = float(eval(re.sub(r"_f64", "", rust), dict(names)))
    ratio[expression] = value / true
    print(f"{str(expression):25s} {rust:48s} {value:12.6f} {true:12.6f}")
    plain_c = sympy.ccode(expression)
    in_c = eval(plain_c, {**{n: float(f) for n, f in names.items()}, "exp": math.exp, "sqrt": math.sqrt, "pow": pow})
    assert math.isclose(in_c, true, rel_tol=1e-12), f"C: {plain_c}"
wrong = [expression for expression in ratio if not math.isclose(ratio[expression], 1, rel_tol=1e-9)]
assert wrong == list(ratio)[:5], f"changed: wrong are {wrong}"
assert sympy.rust_code(v * (e + 1)) == "v*e + 1.0", "changed: the text"
PY
