#!/usr/bin/env bash
# clang 22 (in ziglang 0.17.0): the macros of compilers that may reorder sums
#
# Guess: code that must not be reordered can refuse to compile: __FAST_MATH__ covers -ffast-math, __ASSOCIATIVE_MATH__
#   (gcc has it since version 10) the narrower options.
# What happens: with -ffast-math both compilers refuse. With -fassociative-math -fno-signed-zeros -fno-trapping-math,
#   and with -funsafe-math-optimizations, clang defines no macro at all, compiles, and removes the compensation: the
#   rounding error of 10^16 + 1, which is 1, comes out as 0. gcc defines __ASSOCIATIVE_MATH__ for both and refuses.
#   No warning.
# Why: clang has __FAST_MATH__ for the whole set and __FINITE_MATH_ONLY__, and none for the parts.
# Why it matters here: compensated sums (energy balances over many steps, Taylor terms) and the roundings of intervals
#   are meant literally. Test the value at start-up, as below, instead of the macro.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'ziglang==0.17.0'
cd "$work"
export ZIG_GLOBAL_CACHE_DIR="$work/cache" ZIG_LOCAL_CACHE_DIR="$work/cache"
cat >lost.c <<'C'
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
#error "sums may be reordered"
#endif
double lost(double a, double b) { /* what the sum a + b has lost by rounding */
    double sum = a + b, part = sum - a;
    return (a - (sum - part)) + (b - part);
}
C
"$work/venv/bin/python" - <<'PY'
import ctypes
import shutil
import subprocess
import sys

CLANG = [sys.executable, "-m", "ziglang", "cc"]
PARTS = "-fassociative-math -fno-signed-zeros -fno-trapping-math"


def lost(compiler, options):
    """What 10^16 + 1 has lost, or that the compiler refused."""
    library = f"./{compiler[-1]}{options.replace(' ', '')}.so"
    command = [*compiler, *options.split(), "-fPIC", "-shared", "-nostdlib", "lost.c", "-o", library]
    outcome = subprocess.run(command, capture_output=True, text=True)
    if outcome.returncode:
        assert "sums may be reordered" in outcome.stderr, outcome.stderr
        return "refused"
    function = ctypes.CDLL(library).lost
    function.argtypes, function.restype = (ctypes.c_double, ctypes.c_double), ctypes.c_double
    return f"{function(1e16, 1.0):g}"


print(subprocess.run([*CLANG, "--version"], capture_output=True, text=True).stdout.splitlines()[0])
changed = []
for options, expected in (
    ("-O2", "1"),
    (f"-O2 {PARTS}", "0"),
    ("-O2 -funsafe-math-optimizations", "0"),
    ("-O2 -ffast-math", "refused"),
):
    seen = lost(CLANG, options)
    print(f"clang {options:72s} lost: {seen}")
    if seen != expected:
        changed.append(options)
if shutil.which("gcc"):
    print(f"gcc   {'-O2 ' + PARTS:72s} lost: {lost(['gcc'], '-O2 ' + PARTS)}")
assert not changed, f"changed: {changed}"
PY
