"""Model files with declared events."""

# By its defaults no event happens; a test chooses by [custom] which one does.
EVENTS = '''"""A bridge that snaps when it is stretched too fast, or lets go and the collision goes on; a brake."""
from wetdoublet.derive.user import *

critical = quantity("critical_rate", r"\\dot\\epsilon_c", unit="1/s", default="1e12 1/s", meaning="rate of snapping")
leaving = quantity("leaving_speed", r"u_l", unit="m/s", default="1e6 m/s", meaning="speed at which the bridge lets go")
kept = quantity("kept", r"k", default=0.5, bounds=">= 0", meaning="part of the speed that a brake leaves")
braking = quantity("braking_gap", r"x_k", unit="m", default="1 m", meaning="gap of the brake")

event("snap", guard=critical - u / x, where="opening beyond the film", ends="separated",
      meaning="the bridge is stretched too fast")
intact = event("let_go", guard=leaving - u, where="opening", meaning="the bridge lets go")
event("brake", guard=braking - x, where="opening", jump={u: kept * u}, word="braked")
law("bridge", "letting-go", force=intact * 4 * pi * a * sigma, source="a test")
'''


TIMED = '''"""Cut-offs at an angle, a time and a spin; a bridge that lets go after a time; a kick."""
from wetdoublet.derive.user import *

largest = quantity("largest", default=1e9, meaning="angle at which it ends, rad")
last = quantity("last", unit="s", default="1e9 s", meaning="time at which it ends")
fastest = quantity("fastest", unit="1/s", default="1e30 1/s", meaning="spin at which it ends")
holding = quantity("holding", unit="s", default="1e9 s", meaning="time for which the bridge holds")
kicked = quantity("kicked", unit="s", default="1e9 s", meaning="time of the kick")
kick = quantity("given", unit="m/s", default="0 m/s", bounds="> -1e9", meaning="speed that it gives")

event("far enough", guard=largest - beta, ends="stick")
event("late", guard=last - t, ends="stick")
event("spun", guard=fastest - xi, ends="stick")
event("kick", guard=kicked - t, jump={u: u + kick}, releases=m * kick**2)
'''
BRIDGE = 'intact = event("lets go", guard=holding - t)\nlaw("bridge", "holding", force=intact * 4 * pi * a * sigma)\n'
TORQUE = """twist = quantity("twist", unit="N m", default="0 N m", bounds="> -1", meaning="torque on the rotation")
force_on("rotation", twist)
"""
