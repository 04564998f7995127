"""
Sobol indices
=============

Which entry the restitution depends on over a whole box of entries: SALib chooses the impacts and reads the answers. A
first-order index is the part of the variance that an entry has alone, a total one that with all others.
"""

import matplotlib.pyplot as plt
from SALib.analyze import sobol as indices
from SALib.sample import sobol
from wetdoublet import collide_many

names = ["liquid.viscosity", "bridge.volume", "particles.dry_restitution", "angle"]
box = {"num_vars": 4, "names": names, "bounds": [(1.5, 2.5), (0.05, 0.2), (0.9, 1.0), (1.0, 1.3)]}  # SI, radians
*entries, angle = sobol.sample(box, 256, calc_second_order=False, seed=0).T
data = collide_many("granulation", stokes=0.05, angle=angle, vary=dict(zip(names, entries, strict=False)), rtol=1e-6)
result = indices.analyze(box, data.restitution.values, calc_second_order=False, seed=1)

figure, axes = plt.subplots(figsize=(6.4, 3.2), layout="constrained")
for shift, order, label in ((0.2, "S1", "first order"), (-0.2, "ST", "total")):
    axes.barh([k + shift for k in range(4)], result[order], 0.36, xerr=result[f"{order}_conf"], label=label)
axes.set_yticks(range(4), names)
axes.set(xlabel="part of the variance", title=f"Sobol indices of the restitution, {data.sizes['collision']} collisions")
axes.legend(frameon=False)
figure.savefig("sobol.png", dpi=120)
