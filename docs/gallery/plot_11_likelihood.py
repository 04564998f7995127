"""
Likelihood of two entries
=========================

The log-density of a fit as a plain function: for a sampler, or as here on a grid. Film thickness and glass transition
pressure are told only together, as x0^2 p_gt: a thinner film at a higher pressure gives the same collisions.
"""

import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import log_likelihood

names = ["liquid.film_thickness", "liquid.glass_transition_pressure"]
# the impacts of the tutorial, as a clone has them
data = Path(os.environ.get("WETDOUBLET_DOCS", "docs")) / "data" / "synthetic-steel-spheres.csv"
density = log_likelihood("pendulum", data, names, prior={"liquid.film_thickness": "400 um +- 30 %"})  # and its gradient

film, force = np.meshgrid(np.linspace(200e-6, 600e-6, 9), 380e-6**2 * 15e6 * np.linspace(0.92, 1.08, 5))  # m, N
pressure = force / film**2  # Pa: the grid follows the curve on which x0^2 p_gt is that of the truth
points = zip(film.flat, pressure.flat, strict=True)
values = np.reshape([density([*point])[0] for point in points], film.shape)

figure, axes = plt.subplots(layout="constrained")
levels = [-18, -12.5, -8, -4.5, -2, -0.5, 0]
filled = axes.contourf(1e6 * film, 1e-6 * pressure, values - values.max(), levels=levels, cmap="Blues")
axes.plot(380, 15, "*", color="#c1554a", markersize=12, label="truth of the synthetic data")
axes.set(xlabel="film thickness (µm)", ylabel="glass transition pressure (MPa)")
axes.legend()
figure.colorbar(filled, label="log-density below its maximum")
figure.savefig("likelihood.png", dpi=120)
