"""
Granules that arrive spinning
=============================

A spin in the sense of the impact adds to the angular momentum and tears doublets apart. One against it takes it away:
doublets stick in the band where little is left. Below that band they turn the other way.
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
