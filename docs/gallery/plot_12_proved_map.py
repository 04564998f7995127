"""
A proved regime map
===================

Outcomes that hold for every impact within a cell, by interval arithmetic. A cell that is not proved is halved; what is
left after ten halvings is undecided and black: a sliver along the boundaries, which the next makes thinner.
"""

import numpy as np
from wetdoublet import prove_map

proved = prove_map("granulation", stokes=np.geomspace(0.08, 0.13, 3), angle=np.radians([31, 36]), depth=10)
print(proved)
proved.plot("proved_map.png")
