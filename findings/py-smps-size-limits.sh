#!/usr/bin/env bash
# py-smps 2.0.0: statistics of a size distribution within limits, means by mass, fits from a least size on
#
# Guess: `stats(dmin=..., dmax=...)` counts what lies between, as documented; the mean diameter by mass of one material
#   is that by volume; a fit with `xmin` finds the log-normal law that the points lie on.
# What happens: the limits of `stats` are not used: all particles are counted, 1000 in place of 457 between 1 and 2
#   micrometres (`integrate` gives 457). The mean, geometric mean and mode by mass are those by volume times the
#   density: beads of glass (2.5 g/cm3) with a mean diameter of 1.78 micrometres by volume have 4.44. A law with the
#   median 1 micrometre has the median 5.01 when it is fitted from 0.5 on, 7.94 from 0.8 on, with errors below 1e-12;
#   `xmax` is right. No message.
# Why: the limits are taken out of the arguments and the rest is handed on; the diameters are multiplied as the masses
#   are; the sizes are cut first, and the counts then by the sizes that are left, so that they keep their first rows.
# Why it matters here: small sizes are cut off where an instrument counts badly. Every bead is then larger by the ratio
#   of the limit to the first size, and its mass by the cube: 126 times for 5.01. Cut both arrays before the fit, use
#   `integrate`, and ask for means by volume.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
# its own list of requirements has NumPy below 2 and pandas below 2, which today's Python cannot install
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'py-smps==2.0.0' 'numpy==2.4.6' \
    'scipy==1.17.1' 'pandas==3.1.1' 'statsmodels==0.15.0' 'seaborn==0.13.2' 'matplotlib==3.11.2' 'joblib==1.6.0' \
    'cloudpickle==3.1.3' 'requests==2.34.2' 'urllib3==2.5.0' 'idna==3.10' 'charset-normalizer==3.4.3' \
    'certifi==2025.8.3' 'setuptools==80.9.0' 'packaging==25.0' 'patsy==1.0.3' 'python-dateutil==2.9.0.post0' \
    'six==1.17.0' 'contourpy==1.3.3' 'cycler==0.12.1' 'fonttools==4.68.0' 'kiwisolver==1.5.1' 'pyparsing==3.3.3' \
    'pillow==13.0.0'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

import numpy as np
import pandas as pd
from scipy.stats import norm
from smps.fit import LogNormal
from smps.models import GenericParticleSizer

NUMBER, MEDIAN, SPREAD = 1000.0, 1.0, 1.5  # per cm3, micrometres, geometric standard deviation
WIDTH = math.log(SPREAD)
GLASS = 2.5  # g/cm3

edges = np.geomspace(0.1, 10, 41)  # micrometres, twenty bins to a decade
bins = np.column_stack([edges[:-1], np.sqrt(edges[:-1] * edges[1:]), edges[1:]])
size = bins[:, 1]
density = NUMBER * math.log(10) * norm.pdf(np.log(size / MEDIAN), scale=WIDTH)  # per decade
labels = [f"bin{i}" for i in range(len(size))]
table = pd.DataFrame([density], columns=labels, index=pd.to_datetime(["2026-01-01"]))
sizer = GenericParticleSizer(data=table, bins=bins, bin_labels=labels, fmt="dndlogdp")


def mean(power):
    """Mean diameter by number (0) or volume (3), by the law."""
    return MEDIAN * math.exp((power + 0.5) * WIDTH**2)


print("py-smps", version("py-smps"), f"- median {MEDIAN:g} micrometre, geometric standard deviation {SPREAD:g}")
within = sizer.stats(dmin=1, dmax=2).iloc[0]
counted = float(sizer.integrate("number", dmin=1, dmax=2).iloc[0])
true = NUMBER * (norm.cdf(math.log(2) / WIDTH) - 0.5)
print(f"1 to 2 micrometres: stats {within['number']:.0f}, integrate {counted:.0f}, by the law {true:.0f} per cm3")
assert math.isclose(within["number"], NUMBER, rel_tol=1e-3), "changed: limits of stats"
assert math.isclose(counted, true, rel_tol=1e-2), "integrate"

for weight, power in (("number", 0), ("volume", 3), ("mass", 3)):
    found = sizer.stats(weight=weight, rho=GLASS).iloc[0]["AM"] / 1e3
    print(f"mean diameter by {weight:6s} {found:.3f}, by the law {mean(power):.3f} micrometres")
    factor = GLASS if weight == "mass" else 1
    assert math.isclose(found, factor * mean(power), rel_tol=2e-3), f"changed: mean by {weight}"

for least, largest in ((None, None), (None, 2), (0.5, None), (0.8, None)):
    fit = LogNormal().fit(size, density, modes=1, xmin=least, xmax=largest)
    median, error = fit.params[0, 1], fit.errors[0, 1]
    cut = size.size - np.count_nonzero(size >= (least or 0))
    expected = MEDIAN * size[cut] / size[0]  # the counts keep their first rows
    print(f"fit, xmin {least!s:4s} xmax {largest!s:4s}: median {median:.3f} +- {error:.0e} micrometres")
    assert math.isclose(median, expected, rel_tol=1e-6), f"changed: fit from {least}"
    assert (least is None) == math.isclose(median, MEDIAN, rel_tol=1e-6), "fit"
PY
