"""
Two laws on the same data
=========================

A fit with each law, and their likelihoods: with as many free entries, the law with the larger one explains the impacts
better. A difference of 2 in the logarithm is a hint, one of 5 is clear.
"""

import matplotlib.pyplot as plt
import numpy as np
from wetdoublet import Scene, collide_many, fit

scene = Scene.load("granulation")
angle, speed = np.radians(np.repeat([45.0, 75.0], 4)), np.tile(np.geomspace(0.5, 6.0, 4), 2)
truth = collide_many(scene, speed=speed, angle=angle).restitution.values  # with the law of Mikami
sigma = np.full(8, 0.02)
data = {"speed": speed, "angle": angle, "restitution": truth + np.random.default_rng(3).normal(0, sigma) * (truth > 0)}
data["restitution_sd"] = sigma
fits = {
    law: fit(scene.with_entries({"bridge.law": law}), data, "liquid.viscosity", starts=0)
    for law in ("mikami", "constant")
}
for law, result in fits.items():
    print(f"{law}: log-likelihood {result.log_likelihood:.1f}, {result.estimates['liquid.viscosity'].value:.3f} Pa s")

figure, axes = plt.subplots(layout="constrained")
for law, result in fits.items():
    many = np.geomspace(0.5, 6.0, 200)
    curve = collide_many(result.scene, speed=many, angle=angle[-1]).restitution
    axes.plot(many, curve, label=f"{law}, $\\ln L$ = {result.log_likelihood:.1f}")
axes.errorbar(speed[4:], data["restitution"][4:], sigma[4:], fmt="k.", label="data at 75 deg")
axes.set(xlabel="normal speed (m/s)", ylabel="normal restitution")
axes.legend(frameon=False)
figure.savefig("laws.png", dpi=120)
