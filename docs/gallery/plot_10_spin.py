"""
Granules that arrive spinning
=============================

A spin in the sense of the impact adds to the angular momentum and tears doublets apart. One against it takes it away:
doublets stick in the band where little is left. Below that band they turn the other way.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch
from wetdoublet import regime_map

spins = [-3e4, 0.0, 3e4]  # rad/s
stokes, degrees = np.geomspace(0.002, 0.3, 80), np.linspace(0, 80, 81)
vary = {"impact.spin": spins}
grid = regime_map("granulation", stokes=stokes, angle=np.radians(degrees), vary=vary, of=["restitution"])

figure, panels = plt.subplots(1, 3, figsize=(10, 3.6), sharey=True, layout="constrained")
colours = {"stick": "#5b7fa3", "stick-rotate-separate": "#e3b34c", "bounce": "#c1554a"}
shades = ListedColormap(list(colours.values()))
for k, (axes, spin) in enumerate(zip(panels, spins, strict=True)):
    outcome = grid.outcome.isel({"impact.spin": k})
    axes.pcolormesh(degrees, stokes, outcome.transpose("stokes", "angle"), cmap=shades, vmin=0, vmax=2)
    axes.set(yscale="log", xlabel="impact angle (deg)", title=f"spin {spin:g} rad/s")
panels[0].set_ylabel("Stokes number")
figure.legend([Patch(color=colour) for colour in colours.values()], list(colours), loc="outside upper center", ncols=3)
figure.savefig("spin.png", dpi=120)
