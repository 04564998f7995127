"""
Uncertainty band
================

Restitution with uncertain viscosity and angle: first order beside a sample. They part where a boundary is near.
"""

import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import band

uncertain = {"liquid.viscosity": "5 %", "impact.angle": "1 deg"}
data = band("granulation", uncertain, "impact.stokes", np.geomspace(0.015, 0.1, 90))
stokes, e_n = data["impact.stokes"], data.restitution.where(data.restitution > 0)  # no line across the jump

figure, axes = plt.subplots(layout="constrained")
axes.fill_between(stokes, data.low, data.high, color="#bcd3e6", label="95 % of a sample")
for sign in (-2, 2):
    axes.plot(stokes, e_n + sign * data.first_order, "--", color="#c1554a", label="first order" if sign > 0 else None)
axes.plot(stokes, e_n, color="#222222", label="$e_n$")
axes.set(xscale="log", xlabel="Stokes number", ylabel="normal restitution", ylim=(-0.05, 1.1))
axes.legend(frameon=False, loc="upper left")
figure.savefig("band.png", dpi=120)
