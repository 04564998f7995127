"""Emitted bridge laws and scales of rates against those retyped in plain floats and SI."""

import importlib
import math
import random

import pytest
from wetdoublet.derive.physics.scaling import group_definitions
from wetdoublet.generated import scaling
from wetdoublet.solvers.host.emitted import LAWS

from ...helpers.two_bodies import Bodies

pi = math.pi


@pytest.mark.parametrize("name", LAWS["bridge"])
def test_bridge_law(name: str):
    """The emitted law is the published fit at 200 random gaps, volumes and angles, to 1e-13 of its value's terms."""
    law, draw = (
        importlib.import_module(f"wetdoublet.generated.laws.bridge_{name.replace('-', '_')}"),
        random.Random(name),
    )
    rest = {"masses": (1.0, 1.0), "viscosity": 1.0, "film_thickness": 1.0, "roughness": 0.0, "dry_restitution": 1.0}
    for _ in range(200):
        h, V, phi = draw.uniform(1e-3, 0.6), 10 ** draw.uniform(-3, -0.7), draw.uniform(0, 1.2)
        published = Bodies(radii=(1.0, 1.0), law=name, tension=1 / pi, volume=V, wetting=phi, **rest)  # R = 1
        # largest term: the exponential forms add C < 0.1, lambert's 1 - h/s cancels by at most s/(s - h)
        assert float(law.force(h, V, phi)) == pytest.approx(published.pull(h), rel=1e-13, abs=1e-14), (h, V, phi)


def test_scales_of_rates_are_the_published_ones():
    """Of spheres of ratio 2.5, with R1 = 1.4 a and R2 = 3.5 a, beside a wall and in space, from SI numbers."""
    draw = random.Random(4)
    for _ in range(50):
        a, m, v0, theta = 10 ** draw.uniform(-4.5, -2), 10 ** draw.uniform(-9, -1), draw.uniform(0.01, 2), draw.random()
        spins = {"impact_spin": draw.uniform(-3, 3) / a, "impact_partner_spin": -2 / a}
        si = {"reduced_radius": a, "reduced_mass": m, "speed": v0, "angle": theta, "surface_tension": 0.03,
              "radius_ratio": 2.5, "initial_rate": 7.0, "attraction_force": 3e-5, "obliquity": 1.7, "rate_scale": 11.0,
              **spins}  # fmt: skip
        turns = {name: [draw.uniform(-300, 300) for _ in range(3)] for name in ("turning", "spin", "partner_spin")}
        si |= {f"impact_{name}_{axis}": value for name, own in turns.items() for axis, value in zip("xyz", own)}
        tangent, one, other = math.tan(theta), *(abs(spin) * a / v0 for spin in spins.values())
        lever = {"turning": 4.9, "spin": 1.4, "partner_spin": 3.5}
        published = {
            "initial_turning": tangent / 1.7, "initial_spin": si["impact_spin"] / 11.0,
            "initial_partner_spin": si["impact_partner_spin"] / 11.0,
            "obliquity_pair": max(tangent, 1.4 * one, 3.5 * other), "obliquity_wall": max(tangent, one),
            "obliquity_space": math.hypot(*(lever[name] * a * each / v0 for name in turns for each in turns[name])),
            "rate_scale": 1.7 * v0 / (4 * a), "rate_scale_pair": 1.7 * v0 / (4.9 * a),
            "rate_scale_wall": 1.7 * v0 / a, "initial_rate": v0 * tangent / (4 * a),
            "initial_rate_pair": v0 * tangent / (4.9 * a),
            "centrifugal_pair": m * (v0 * tangent / (4.9 * a)) ** 2 / 0.03,
            "generalised_centrifugal": m * 7.0**2 * a / 3e-5,
        }  # fmt: skip
        assert published.keys() == scaling.ARGUMENTS.keys() - {symbol.name for symbol in group_definitions()}
        for name, expected in published.items():
            found = getattr(scaling, name)(*(si[key] for key in scaling.ARGUMENTS[name]))
            assert float(found) == pytest.approx(expected, rel=1e-13), name
