"""
Boundaries over the angle
=========================

The Stokes numbers at which the outcome changes, found exactly, for three viscosities.
"""

import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import Scene, boundary

scene, degrees = Scene.load("granulation"), np.arange(20, 81, 7.5)
figure, axes = plt.subplots(layout="constrained")
for viscosity, colour in (("1 Pa s", "#e3b34c"), ("2 Pa s", "#c1554a"), ("4 Pa s", "#5b7fa3")):
    lines = boundary(scene.with_entries({"liquid.viscosity": viscosity}), angle=np.radians(degrees))
    first = [changes[0].stokes for changes in lines.changes]
    axes.plot(degrees, first, "o-", ms=4, color=colour, label=viscosity)
axes.set(yscale="log", xlabel="impact angle (deg)", ylabel="largest Stokes number that sticks")
axes.legend(title="viscosity", frameon=False)
figure.savefig("boundaries.png", dpi=120)
