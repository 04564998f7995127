#!/usr/bin/env bash
# chaospy 4.3.21: mean and deviation of a generalised gamma distribution
#
# Guess: `E`, `Std` and `mom` of a distribution are those of its samples, its density and its quadrature.
# What happens: not of `GeneralizedGamma`, by which sizes of drops and granules are described: with shapes 2 and 3 `E`
#   is 5 % below the mean of its samples, `Std` 1.6 times their deviation, the mean volume an eighth too large. In the
#   example of its docstring no value exceeds 1.271, and the mean is 4.591. A polynomial chaos inherits it: quadrature
#   gives it the right coefficients, and of the polynomial that is the size itself `E` is wrong again. `Frechet` has the
#   moments of that distribution and the samples of Weibull's. `Gamma`, `Weibull` and `LogNormal` are right.
# Why: the moments are given by a formula in which the two shapes are exchanged, that of a density that goes as
#   x^(shape2 - 1) exp(-x^shape1).
# Why it matters here: rates of collisions, Stokes numbers and volumes of liquid go with powers of the size, and `E` is
#   what one asks for. Take means over `sample`, or weights and nodes of `generate_quadrature`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'chaospy==4.3.21' 'numpoly==1.3.9' 'numpy==2.4.6' \
    'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import chaospy
import numpy as np
from scipy import stats

PLACES = (np.arange(10**6) + 0.5) / 10**6
SIZES = {
    "Gamma(2.5)": (chaospy.Gamma(2.5), stats.gamma(2.5)),
    "Weibull(2.5)": (chaospy.Weibull(2.5), stats.weibull_min(2.5)),
    "LogNormal(0, 0.3)": (chaospy.LogNormal(0, 0.3), stats.lognorm(0.3)),
    "GeneralizedGamma(2, 3)": (chaospy.GeneralizedGamma(2, 3), stats.gengamma(2, 3)),
    "GeneralizedGamma(1.5, 15)": (chaospy.GeneralizedGamma(1.5, 15), stats.gengamma(1.5, 15)),
    "Frechet(4.5)": (chaospy.Frechet(4.5), stats.weibull_min(4.5)),
}
print("chaospy", version("chaospy"), "- over those of the samples:")
print(f"{'':27s}{'E':>8s}{'Std':>8s}{'mom(3)':>8s}   largest of 10^6 samples   E")
ratios = {}
for name, (size, reference) in SIZES.items():
    values = size.inv(PLACES)
    assert np.allclose(values[100:-100], reference.ppf(PLACES)[100:-100], rtol=1e-4), f"samples of {name}"
    x = values[1000::1000]
    assert np.allclose(size.pdf(x), reference.pdf(x), rtol=1e-3), f"density of {name}"
    found = np.array([chaospy.E(size), chaospy.Std(size), size.mom(3)])
    ratios[name] = found / (values.mean(), values.std(), (values**3).mean())
    print(f"{name:27s}" + "".join(f"{x:8.3f}" for x in ratios[name]) + f" {values.max():25.3f} {found[0]:7.3f}")
for name in ("Gamma(2.5)", "Weibull(2.5)", "LogNormal(0, 0.3)"):
    assert np.allclose(ratios[name], 1, atol=1e-3), f"{name} is right"
assert np.allclose(ratios["GeneralizedGamma(2, 3)"], [0.948, 1.615, 1.128], atol=2e-3), "changed: GeneralizedGamma"
assert ratios["GeneralizedGamma(1.5, 15)"][0] > 4, "changed: the docstring's example"
assert abs(ratios["Frechet(4.5)"][0] - 1) > 0.2, "changed: Frechet"

size, reference = SIZES["GeneralizedGamma(2, 3)"]
print("E is that of exchanged shapes:", np.isclose(chaospy.E(size), stats.gengamma(3 / 2, 2).mean()))
nodes, weights = chaospy.generate_quadrature(6, size, rule="gaussian")
chaos = chaospy.fit_quadrature(chaospy.generate_expansion(3, size), nodes, weights, nodes[0])
assert np.allclose(chaos(np.array([0.5, 1, 1.5])), [0.5, 1, 1.5]), "the polynomial is the size"
mean, expected = (nodes[0] * weights).sum(), chaospy.E(chaos, size)
print(f"polynomial chaos of the size itself: by nodes {mean:.4f}, by E {expected:.4f}, exact {reference.mean():.4f}")
assert abs(mean - reference.mean()) < 1e-6, "quadrature"
assert abs(expected / mean - 0.948) < 2e-3, "changed: polynomial chaos"
PY
