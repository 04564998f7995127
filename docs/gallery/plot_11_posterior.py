"""
Posterior of a fit
==================

The log-density of a fit as a plain function, for a sampler (emcee) and its summary (ArviZ). Film thickness and glass
transition pressure are told only together: the cloud is a narrow band, which the profile intervals span.
"""

import os
from pathlib import Path

import arviz
import emcee
import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import fit, log_likelihood

names = ["liquid.film_thickness", "liquid.glass_transition_pressure"]
data = Path(os.environ.get("WETDOUBLET_DOCS", "docs")) / "data" / "synthetic-steel-spheres.csv"
prior = {"liquid.film_thickness": "400 um +- 30 %"}
density = log_likelihood("pendulum", data, names, prior=prior)  # value and gradient, SI


def log_density(x):
    """Of the entries' logarithms, with a flat prior for the pressure's."""
    return density(np.exp(x))[0] if np.all(np.abs(x - start) < 2) else -np.inf


found = fit("pendulum", data, names, prior=prior)
start = np.log([found.estimates[name].value for name in names])
random = np.random.default_rng(1)
walkers = start + 0.05 * random.standard_normal((8, 1)) * [1, -2] + 0.01 * random.standard_normal((8, 2))
sampler = emcee.EnsembleSampler(len(walkers), len(names), log_density)
sampler.random_state = np.random.RandomState(1).get_state()
sampler.run_mcmc(walkers, 30)

samples = arviz.from_emcee(sampler, var_names=["ln x0", "ln p_gt"])
print(arviz.summary(samples, kind="stats"))

film, pressure = np.exp(sampler.get_chain(discard=10, flat=True)).T
figure, axes = plt.subplots(layout="constrained")
axes.plot(1e6 * film, 1e-6 * pressure, ".", color="#4477aa", markersize=3, alpha=0.5, label="posterior")
low, high = (
    [1e6 * getattr(found.estimates[names[0]], end), 1e-6 * getattr(found.estimates[names[1]], end)]
    for end in ("low", "high")
)
axes.axvspan(low[0], high[0], color="#dddddd", zorder=0, label="95 % intervals of the fit")
axes.axhspan(low[1], high[1], color="#dddddd", zorder=0, alpha=0.6)
axes.plot(380, 15, "*", color="#c1554a", markersize=12, label="truth of the synthetic data")
axes.set(xlabel="film thickness (µm)", ylabel="glass transition pressure (MPa)")
axes.legend(framealpha=1)
figure.savefig("posterior.png", dpi=120)
