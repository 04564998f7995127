"""
Your own material
=================

Up to which speed do granules stay together? A scene from diameters, coatings and mPa s, for three solutions.
"""

import matplotlib.pyplot as plt
import numpy as np
import wetdoublet as wd

scene = wd.Scene.load("lactose-pvp").with_entries({"particles.diameter": "300 um", "liquid.coating_thickness": "6 um"})
angles = np.radians(np.linspace(0, 75, 11))

figure, axes = plt.subplots(layout="constrained")
for viscosity in ("7 mPa s", "40 mPa s", "100 mPa s"):
    solution = scene.with_entries({"liquid.viscosity": viscosity})
    lines = wd.boundary(solution, angle=angles)
    highest = [lines.speed_at(changes[0].stokes, angle) for angle, changes in zip(angles, lines.changes)]
    axes.plot(np.degrees(angles), highest, "o-", ms=4, label=viscosity)
axes.set(xlabel="impact angle (deg)", ylabel="relative speed up to which they stick (m/s)", ylim=(0, None))
axes.legend(title="viscosity", frameon=False)
figure.savefig("own_material.png", dpi=120)
