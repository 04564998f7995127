#!/usr/bin/env bash
# sympy 1.14.0: `ccode` of a remainder
#
# Guess: `Mod(x, y)` has the sign of y in sympy, and so in whatever is generated from it: an angle that is wrapped by
#   Mod(angle + pi, 2 pi) - pi lies between -pi and pi.
# What happens: in C and C++ it is printed as `fmod`, whose sign is that of x. An angle of -4 stays -4, where sympy,
#   `lambdify` and the text for Fortran 95 (`modulo`), JavaScript and Julia give 2.283. A symbol that is declared as
#   an *integer* gets ((x % y) + y) % y in C and is right. No warning.
# Why: two definitions of a remainder under one name; the C printer translates the name, and corrects the sign for
#   integers alone.
# Why it matters here: the angle of the line of centres, or of a roll, runs through several turns in both senses. A test
#   with positive angles, or of `lambdify`, shows nothing: C is wrong for negative ones. Write x - y floor(x / y).
# C's value is taken from the printed text, with Python's `math.fmod`, which is that of the C library.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'sympy==1.14.0' 'mpmath==1.3.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math

import sympy

C = {"fmod": math.fmod, "floor": math.floor, "M_PI": math.pi}
angle = sympy.Symbol("angle", real=True)
turn = sympy.Symbol("turn", integer=True)
wrapped = sympy.Mod(angle + sympy.pi, 2 * sympy.pi) - sympy.pi
by_floor = wrapped.replace(sympy.Mod, lambda x, y: x - y * sympy.floor(x / y))
print("sympy", sympy.__version__)
print("C         ", sympy.ccode(wrapped))
print("C++       ", sympy.cxxcode(wrapped))
print("Fortran   ", sympy.fcode(wrapped, standard=95, source_format="free").splitlines()[-1])
print("JavaScript", sympy.jscode(wrapped))
print("integer, C", sympy.ccode(sympy.Mod(turn, 3)))

python = sympy.lambdify(angle, wrapped, "math")
print("angle      sympy    lambdify     C, Mod   C, floor")
for value in (1.0, 4.0, 7.0, -1.0, -4.0, -7.0, -10.0):
    true = float(wrapped.subs(angle, value))
    in_c, floor_in_c = (eval(sympy.ccode(text), {**C, "angle": value}) for text in (wrapped, by_floor))
    print(f"{value:5.1f} {true:10.4f} {python(value):11.4f} {in_c:10.4f} {floor_in_c:10.4f}")
    assert math.isclose(python(value), true, abs_tol=1e-12), "lambdify"
    assert math.isclose(floor_in_c, true, abs_tol=1e-12), "C with floor"
    off = 0 if value > -math.pi else -2 * math.pi
    assert math.isclose(in_c - true, off, abs_tol=1e-12), "changed: C with Mod"
assert sympy.ccode(wrapped) == "fmod(angle + M_PI, 2*M_PI) - M_PI", "changed: the text for C"
assert sympy.cxxcode(wrapped) == "std::fmod(angle + M_PI, 2*M_PI) - M_PI", "changed: the text for C++"
assert sympy.ccode(sympy.Mod(turn, 3)) == "((turn % 3) + 3) % 3", "changed: integers"
PY
