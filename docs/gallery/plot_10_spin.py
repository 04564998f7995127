"""
Granules that arrive spinning
=============================

A spin in the sense of the impact adds to the angular momentum and tears doublets apart; one against it takes it away, and
beside the band where the angular momentum vanishes everything sticks. Beyond that the doublet turns the other way.
"""

import numpy as np
from wetdoublet import regime_map

found = regime_map(
    "granulation",
    stokes=np.geomspace(0.002, 0.3, 40),
    angle=np.radians(np.linspace(0, 80, 41)),
    vary={"impact.spin": [-3e4, 0.0, 3e4]},
)
found.plot("spin.png")
