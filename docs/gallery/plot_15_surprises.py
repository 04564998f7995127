"""
What surprises
==============

Five facts in which intuition fails, of the page :doc:`What surprises </explanation/surprises>`: a thicker liquid sticks
less, a separation outlasts a bounce a thousand times, e_n jumps, backspin lets faster pairs stick, and a gas whose mean
e_n exceeds 1 loses energy.
"""

import matplotlib.pyplot as plt
import numpy as np
import wetdoublet as wd

scene, angle = wd.Scene.load("granulation"), np.radians(60)
figure = plt.figure(figsize=(11, 6), layout="constrained")
axes = figure.subplot_mosaic("aabbcc;.ddee.")

viscosity = np.geomspace(0.1, 8, 9)  # Pa s
for pressure, label in (("20 MPa", "glass at 20 MPa"), ("1 TPa", "glass at 1 TPa")):
    glassy = scene.with_entries({"liquid.glass_transition_pressure": pressure})
    speeds = [wd.critical(glassy.with_entries({"liquid.viscosity": mu}), angle=0.0).rows[0].speed for mu in viscosity]
    axes["a"].loglog(viscosity, speeds, label=label)
axes["a"].set(xlabel="viscosity (Pa s)", ylabel="sticks up to (m/s)", title="1: a thicker liquid sticks less")
axes["a"].set_ylim(0.5, 20)
axes["a"].legend(frameon=False)

separate, bounce = (change.stokes for change in wd.boundary(scene, angle=angle).changes[0])
above = np.geomspace(1e-6, 10, 100)
data = wd.collide_many(scene, stokes=separate * (1 + above), angle=angle, of=["contact_time"])
axes["b"].loglog(above, 1e3 * data.contact_time)
axes["b"].axvline(bounce / separate - 1, color="0.5", linestyle=":")
axes["b"].annotate("bounces", (2.5, 0.006), ha="right")
axes["b"].set(xlabel="St/St* - 1", ylabel="contact time (ms)", title="2: separation takes its time")

stokes = np.sort(
    np.concatenate([np.geomspace(0.01, 0.5, 300), *(at * (1 + np.array([-1e-6, 1e-6])) for at in (separate, bounce))])
)
data = wd.collide_many(scene, stokes=stokes, angle=angle)
for outcome, label in enumerate(("stick", "stick-rotate-separate", "bounce")):
    axes["c"].semilogx(stokes, data.restitution.where(data.outcome == outcome), label=label)
axes["c"].set(xlabel="Stokes number", ylabel="e_n", title="5: e_n jumps twice, 60 deg")
axes["c"].legend(frameon=False)

for spin in (0.0, -2e4):
    spinning = scene.with_entries({"impact.spin": spin})
    stokes = np.geomspace(0.006, 0.3, 300)
    data = wd.collide_many(spinning, stokes=stokes, angle=angle, of=["tangential_restitution"])
    axes["d"].semilogx(stokes, data.tangential_restitution, label=f"spin {spin:g} rad/s")
    low, high = stokes[data.outcome == 0][[0, -1]]
    axes["d"].axvspan(low, high, color=axes["d"].lines[-1].get_color(), alpha=0.15)
axes["d"].set(xlabel="Stokes number", ylabel="e_t", title="6: backspin: faster can stick (shaded)", ylim=(-4, 2))
axes["d"].legend(frameon=False, loc="lower right")

speeds = np.geomspace(0.5, 30, 7)  # m/s
means = [wd.collision_averages(scene, speeds=float(speed), tolerance=1e-3) for speed in speeds]
labels = {
    "restitution_all": "mean e_n",
    "kinetic_energy_loss": "energy lost",
    "normal_dissipation": "normal_dissipation",
}
for name, label in labels.items():
    axes["e"].semilogx(speeds, [float(mean[name]) for mean in means], label=label)
axes["e"].axhline(0, color="0.7", linewidth=0.8)
axes["e"].set(xlabel="relative speed (m/s)", title="8: mean e_n above 1, and energy lost", ylim=(-0.4, 2.3))
axes["e"].legend(frameon=False, loc="upper left")
figure.savefig("surprises.png", dpi=120)
