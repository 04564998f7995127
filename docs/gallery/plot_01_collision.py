"""
One collision, drawn
====================

Two granules meet at 75 degrees. They stick, turn as a doublet, and separate faster than they met.
"""

from wetdoublet import collide

one = collide("granulation", stokes=0.02, angle="75 deg", trajectory=True)
print(one.outcome, "e_n =", round(one.restitution, 3))
for event in one.events:
    print(f"{1e6 * event.time:8.2f} us  {event.kind}")

one.plot("collision.png")
