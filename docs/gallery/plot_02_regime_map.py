"""
Regime map
==========

Outcome over Stokes number and angle: ten thousand collisions in a fraction of a second.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap
from wetdoublet import regime_map

stokes, degrees = np.geomspace(0.005, 1, 100), np.linspace(0, 85, 100)
grid = regime_map("granulation", stokes=stokes, angle=np.radians(degrees), of=["restitution"])

figure, axes = plt.subplots(layout="constrained")
axes.pcolormesh(degrees, stokes, grid.outcome.T, cmap=ListedColormap(["#5b7fa3", "#e3b34c", "#c1554a"]), vmin=0, vmax=2)
axes.set(yscale="log", xlabel="impact angle (deg)", ylabel="Stokes number")
for x, y, text in ((25, 0.03, "stick"), (68, 0.045, "stick,\nrotate,\nseparate"), (30, 0.4, "bounce")):
    axes.text(x, y, text, ha="center", va="center")
figure.savefig("regime_map.png", dpi=120)
