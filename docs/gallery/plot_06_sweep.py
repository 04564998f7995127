"""
Sweep to pandas and CSV
=======================

Restitution for three surface tensions and a range of impacts, as a table.
"""

import numpy as np
from wetdoublet import regime_map

sweep = regime_map(
    "granulation",
    stokes=np.geomspace(0.01, 1, 60),
    angle="70 deg",
    vary={"bridge.surface_tension": [0.01, 0.025, 0.07]},
    of=["restitution"],
).squeeze("angle", drop=True)
frame = sweep.restitution.to_series().unstack("bridge.surface_tension")
frame.to_csv("sweep.csv")
print(frame.iloc[::12].round(3))

axes = frame.plot(logx=True, xlabel="Stokes number", ylabel="normal restitution")
axes.legend(title="surface tension (N/m)", frameon=False)
axes.figure.savefig("sweep.png", dpi=120)
