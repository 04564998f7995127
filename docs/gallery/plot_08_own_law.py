"""
A law of your own
=================

A bridge that decays exponentially over a length that the scene gives.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import Scene, collide_many

model = Path(tempfile.mkdtemp()) / "decaying.py"
model.write_text("""
from wetdoublet.derive.user import *

reach = quantity("reach", unit="m", default="10 um", bounds="> 0", meaning="decay length of the bridge's force")
law("bridge", "decaying", source="illustration", meaning="exponential decay", force=2*pi*R*sigma*exp(-x/reach))
""")
scene = Scene.load("granulation", model=model)

stokes = np.geomspace(0.01, 0.3, 80)
figure, axes = plt.subplots(layout="constrained")
for reach in ("5 um", "20 um", "80 um"):
    many = collide_many(scene.with_entries({"custom.reach": reach}), stokes=stokes, angle="70 deg")
    axes.plot(stokes, many.restitution, label=reach)
axes.set(xscale="log", xlabel="Stokes number", ylabel="normal restitution")
axes.legend(title="decay length", frameon=False)
figure.savefig("own_law.png", dpi=120)
