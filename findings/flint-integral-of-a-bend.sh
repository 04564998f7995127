#!/usr/bin/env bash
# python-flint 0.9.0: rigorous integrals of laws with a bend
#
# Guess: `acb.integral` returns an enclosure, or a ball so wide that one sees it: the integral of |x| from -1 to 1
#   contains 1.
# What happens: 1.15470053837925 +/- 2e-15, and 0.5774 +/- 5e-16 for max(x, 0), whose integral is 0.5. The error
#   bounds are those of a proof, the values 15 % off. `abs` and `real` are functions of the package's own type, and
#   `.sqrt()` of x * x does the same.
# Why: the quadrature's bound holds for holomorphic integrands only, and the integrand has to say where it is not:
#   its second argument, `analytic`, asks for a ball that is not finite there. |x|, max(x, 0) and the real part are
#   holomorphic nowhere near the bend; functions that know the argument (`sqrt(analytic=...)`) give the right ball.
# Why it matters here: work and impulse of a contact are integrals of forces with bends (onset, rupture, Coulomb's
#   limit). Cut them at the bend.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'python-flint==0.9.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

from flint import acb, arb

print("python-flint", version("python-flint"))
results = {}
for name, law, exact in (
    ("abs(x)", lambda x, analytic: acb(abs(x)), 1),
    ("sqrt(x x)", lambda x, analytic: (x * x).sqrt(), 1),
    ("max(Re x, 0)", lambda x, analytic: acb(max(x.real, arb(0))), arb(1) / 2),
    ("sqrt(x x, analytic)", lambda x, analytic: (x * x).sqrt(analytic=analytic), 1),
):
    results[name] = acb.integral(law, -1, 1).real
    enclosed = results[name].contains(arb(exact))
    print(f"{name:20s} from -1 to 1: {str(results[name]):36s} exact {float(exact):g}, enclosed: {enclosed}")
halves = [acb.integral(lambda x, analytic: -x, -1, 0), acb.integral(lambda x, analytic: x, 0, 1)]
print("cut at the bend:", (halves[0] + halves[1]).real)
assert (halves[0] + halves[1]).real.contains(arb(1)), "changed: cut at the bend"
assert results["sqrt(x x, analytic)"].contains(arb(1)), "changed: with the argument"
for name, wrong in (("abs(x)", 1.1547), ("sqrt(x x)", 1.1547), ("max(Re x, 0)", 0.57735)):
    assert abs(float(results[name]) - wrong) < 1e-4 and float(results[name].rad()) < 1e-13, f"changed: {name}"
PY
