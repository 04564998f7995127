"""
Posterior of a fit
==================

The log-density of a fit as a plain function, for a sampler (emcee) and its summary (ArviZ). Film thickness and glass
transition pressure are told only together: the cloud is a narrow band.
"""

import os
from pathlib import Path

import arviz
import emcee
import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import log_likelihood

names = ["liquid.film_thickness", "liquid.glass_transition_pressure"]
data = Path(os.environ.get("WETDOUBLET_DOCS", "docs")) / "data" / "synthetic-steel-spheres.csv"
density = log_likelihood("pendulum", data, names, prior={"liquid.film_thickness": "400 um +- 30 %"})  # SI
start = np.log([400e-6, 14e6])


def log_density(x):
    """Of the entries' logarithms, with a flat prior for the pressure's."""
    return density(np.exp(x))[0] if np.all(np.abs(x - start) < 2) else -np.inf  # the second is the gradient


random = np.random.default_rng(1)
walkers = start + 0.1 * random.standard_normal((6, 1)) * [1, -2] + 0.01 * random.standard_normal((6, 2))
sampler = emcee.EnsembleSampler(len(walkers), len(names), log_density)
sampler.random_state = np.random.RandomState(1).get_state()
sampler.run_mcmc(walkers, 20)
print(arviz.summary(arviz.from_emcee(sampler, var_names=["ln x0", "ln p_gt"]), kind="stats"))

film, pressure = np.exp(sampler.get_chain(discard=5, flat=True)).T
figure, axes = plt.subplots(layout="constrained")
axes.plot(1e6 * film, 1e-6 * pressure, ".", color="#4477aa", label="posterior")
axes.plot(380, 15, "*", color="#c1554a", markersize=12, label="truth of the synthetic data")
axes.set(xlabel="film thickness (µm)", ylabel="glass transition pressure (MPa)")
axes.legend()
figure.savefig("posterior.png", dpi=120)
