"""
One collision, drawn
====================

Two granules meet at 75 degrees. They stick, turn as a doublet, and separate faster than they met.
"""

from wetdoublet import collide

collision = collide("granulation", stokes=0.02, angle="75 deg", trajectory=True)
print(collision.outcome, "e_n =", round(collision.restitution, 3))
for event in collision.events:
    print(f"{1e6 * event.time:8.2f} us  {event.kind}")

collision.plot("collision.png")
