#!/usr/bin/env bash
# uncertain-variables 1.0.2: Latin hypercubes and Sobol sequences of a set of variables
#
# Guess: of n values that `VariableSet.sample(n, method="QMC_LHS")` gives each variable, one lies in each of n equally
#   likely ranges, and two variables, which are independent, are not correlated.
# What happens: the ranks of two variables have the correlation -0.75, by "QMC_LHS" and by "QMC_Sobol" alike: in each
#   sample one is below its median and the other above. Of three, each pair has -0.44 (hypercube), or two have -0.75
#   and the third none (Sobol). Each variable by itself is plain random: of 512 ranges some 325 have a value. By
#   "QMC_Halton" it is plain random too, without the correlation; "MC" is what it says. No message.
# Why: number of samples and number of variables are exchanged: one hypercube is made with an axis for each sample and a
#   point for each variable, and turned over afterwards.
# Why it matters here: the force of a thinning film goes with viscosity times speed. With both known to 10 % the product
#   scatters by 14 %; with these samples by 8 %, and the ratio by 19 %. Take `scipy.stats.qmc` and each variable's
#   `invcdf`, or "MC".
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'uncertain_variables==1.0.2' \
    'numpy==2.4.6' 'scipy==1.17.1' 'SALib==1.6.0' 'pandas==3.1.1' 'python-dateutil==2.9.0.post0' 'six==1.17.0' \
    'dill==0.4.1' 'multiprocess==0.70.19' 'pint==0.25.3' 'flexcache==0.3' 'flexparser==0.4' 'platformdirs==4.5.0' \
    'typing_extensions==4.15.0'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import uncertain_variables as uv
from scipy.stats import qmc

NUMBER, SCATTER = 512, 0.1


def samples(names, method, seed):
    """Shares of each variable's distribution and its values: standard normal about 1."""
    chosen = uv.VariableSet()
    for name in names:
        chosen.add(uv.Variable(name, uv.NormalDistribution(1, SCATTER)))
    values = chosen.sample(NUMBER, method=method, random_seed=seed)
    assert values.shape == (NUMBER, len(names))
    return np.column_stack([v.cdf(values[:, i]) for i, v in enumerate(chosen.variables.values())]), values


def described(shares):
    """Correlation, number of the ranges that have a value, share of samples on different sides of the medians."""
    ranges = [len(set((NUMBER * share).astype(int))) for share in shares.T[:2]]
    return np.corrcoef(shares.T)[0, 1], ranges, np.mean((shares[:, 0] < 0.5) != (shares[:, 1] < 0.5))


print("uncertain-variables", version("uncertain_variables"), f"- viscosity and speed, {NUMBER} samples")
print("                correlation  ranges with a value   on different sides   scatter of product and of ratio")
for seed in (1, 2, 3):
    direct = qmc.LatinHypercube(2, seed=seed).random(NUMBER)
    correlation, ranges, sides = described(direct)
    print(f"scipy            {correlation:8.3f}    {ranges[0]:6d} {ranges[1]:6d} of {NUMBER}   {sides:12.3f}")
    assert ranges == [NUMBER, NUMBER] and abs(correlation) < 0.15, "hypercube of scipy"
    for method, opposed in (("MC", False), ("QMC_Halton", False), ("QMC_LHS", True), ("QMC_Sobol", True)):
        shares, values = samples(("viscosity", "speed"), method, seed)
        correlation, ranges, sides = described(shares)
        product, ratio = np.std(values[:, 0] * values[:, 1]), np.std(values[:, 1] / values[:, 0])
        print(f"{method:16s} {correlation:8.3f}    {ranges[0]:6d} {ranges[1]:6d} of {NUMBER}   {sides:12.3f}", end="")
        print(f"{product:20.3f} {ratio:8.3f}")
        # (1 - 1/m^2) / (m - 1) for m variables, one in each m-th
        assert abs(correlation + (0.75 if opposed else 0)) < 0.15, f"changed: correlation by {method}"
        assert (sides == 1) == opposed, f"changed: sides by {method}"
        assert all(0.58 < count / NUMBER < 0.69 for count in ranges), f"changed: ranges by {method}"  # 1 - 1/e

for method, expected in (("QMC_LHS", (-4 / 9, -4 / 9, -4 / 9)), ("QMC_Sobol", (-0.75, 0, 0))):
    shares, _ = samples(("viscosity", "speed", "thickness"), method, 1)
    found = np.corrcoef(shares.T)[np.triu_indices(3, 1)]
    print(f"three by {method:10s} " + " ".join(f"{value:6.2f}" for value in found))
    assert np.allclose(found, expected, atol=0.16), f"changed: three by {method}"
PY
