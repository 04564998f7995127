"""
Partners: another size, a wall
==============================

A granule meets a larger one, or a wall. Beside a wall nothing turns, so that there is no separation by rotation.
"""

import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import Scene, collide_many

equal = Scene.load("granulation")
partners = {
    "equal spheres": equal,
    "three times as large": equal.with_entries({"partner.radius": "300 um", "partner.density": "2500 kg/m^3"}),
    "a wall": equal.with_entries({"partner.wall": True}),
}
stokes = np.geomspace(0.01, 1, 150)
figure, axes = plt.subplots(layout="constrained")
for name, scene in partners.items():
    axes.plot(stokes, collide_many(scene, stokes=stokes, angle="60 deg").restitution, label=name)
axes.set(xscale="log", xlabel="Stokes number", ylabel="normal restitution")
axes.legend(frameon=False)
figure.savefig("partners.png", dpi=120)
