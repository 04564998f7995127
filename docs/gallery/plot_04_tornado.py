"""
Tornado of sensitivities
========================

By how many per cent does the restitution change when a property changes by one per cent?
"""

from wetdoublet import sensitivities

gradients = sensitivities("granulation", of=["restitution", "contact_time"])
strongest = max(gradients.elasticity["restitution"].items(), key=lambda item: abs(item[1] or 0))
print("strongest on e_n:", *strongest)

figure = gradients.plot()
figure.savefig("tornado.png", dpi=120)
