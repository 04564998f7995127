#!/usr/bin/env bash
# pygran-analysis 1.1.0: units of a granular dump
#
# Guess: `units("cgs")` and then `units("si")` gives the numbers of the file again; a system read with `units="cgs"`
#   has every frame in centimetres.
# What happens: only the first conversion of a session is right. Spheres with a radius of 1 mm have 1e-3 m, 0.1 cm,
#   1e-5 m, 10 cm, 1e-9 m, and a second system, read from the same file, starts with the wrong factor, too. Of a
#   system read with `units="cgs"` the first frame is converted, and all others have the numbers of the file under the
#   name "cgs": positions fall to a hundredth from one frame to the next, and speeds with them.
# Why: the factor is computed within the table of units itself, and stays there. A frame that is read later is stored
#   as it is.
# Why it matters here: radius, distance and speed of one frame are all wrong by the same power of ten, so that nothing
#   looks odd, while the Stokes number is wrong by the square of it. Convert by hand, once.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numpy==2.4.6' 'scipy==1.17.1' 'setuptools==80.9.0'
# its setup.py has two names that Python 3.12 removed
cat >"$(echo "$work"/venv/lib/python3*/site-packages)/sitecustomize.py" <<'PY'
import configparser

configparser.SafeConfigParser = configparser.ConfigParser
configparser.ConfigParser.readfp = configparser.ConfigParser.read_file
PY
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-build-isolation 'pygran-analysis==1.1.0'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import pygran_analysis

RADIUS, SPEED, FRAMES = 1e-3, 0.5, 3
with open("impact.dump", "w") as file:
    for frame in range(FRAMES):
        print(f"ITEM: TIMESTEP\n{1000 * frame}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff", file=file)
        print("-1 1\n-1 1\n-1 1\nITEM: ATOMS id type x y z vx vy vz radius", file=file)
        for number, place in ((1, 0.0005 * (frame + 1)), (2, 0.004)):
            print(number, 1, place, 0, 0, SPEED if number == 1 else 0, 0, 0, RADIUS, file=file)

print("pygran-analysis", version("pygran-analysis"), f"- radius {RADIUS} m, speed {SPEED} m/s")
print("units   radius     x of sphere 2   speed of sphere 1")
system = pygran_analysis.System(Particles="impact.dump")
radii = []


def show():
    grains = system.Particles
    radii.append(grains.radius[0])
    print(f"{grains.units():5s} {grains.radius[0]:9.3g} {grains.x[1]:15.3g} {grains.vx[0]:17.3g}")


show()
for units in ("cgs", "si", "cgs", "si"):
    system.units(units)
    show()
print("the same file again:")
system = pygran_analysis.System(Particles="impact.dump")
show()
system.units("cgs")
show()
assert np.allclose(radii[:2], [1e-3, 0.1]), "the first conversion"
assert np.allclose(radii[2:5], [1e-5, 10, 1e-9], rtol=1e-9, atol=0), "changed: conversions"
assert radii[5] == 1e-3 and not np.isclose(radii[6], 0.1), "changed: second system"
PY
"$work/venv/bin/python" -W ignore - <<'PY'
import contextlib
import io

import numpy as np
import pygran_analysis

print("a new session, read with units=\"cgs\":")
print("frame   units   x of sphere 1   radius")
system = pygran_analysis.System(Particles="impact.dump", units="cgs")
rows = [(0, system.Particles.units(), system.Particles.x[0], system.Particles.radius[0])]
with contextlib.redirect_stdout(io.StringIO()):  # it reports each of its own attributes
    for frame in system:
        rows.append((frame, system.Particles.units(), system.Particles.x[0], system.Particles.radius[0]))
for row in rows:
    print("{:5d} {:>7s} {:15.3g} {:8.3g}".format(*row))
assert [row[1] for row in rows] == ["cgs"] * 3, "changed: frames"
assert np.allclose([row[2] for row in rows], [0.05, 0.001, 0.0015]), "changed: frames"
PY
