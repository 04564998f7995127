"""Emitted bridge laws and groups against those retyped in plain floats and SI."""

import importlib
import math
import random

import pytest
from wetdoublet.generated import scaling
from wetdoublet.solvers.host.emitted import LAWS

from ...helpers.two_bodies import Bodies

pi, sqrt = math.pi, math.sqrt


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


def _scene(draw: random.Random) -> dict[str, float]:
    a = 10 ** draw.uniform(-4.5, -2)
    scene = {"a": a, "m": 10 ** draw.uniform(-9, -1), "mu": draw.uniform(0.5, 15), "x0": a * draw.uniform(0.03, 0.3)}
    return scene | {
        "sigma": draw.uniform(0.01, 0.07),
        "V": draw.uniform(0.02, 0.15),
        "phi": draw.uniform(0, 0.8),
        "l": a * draw.uniform(30, 200),
        "g": 9.81,
        "v0": draw.uniform(0.01, 2),
        "theta": draw.uniform(0.2, 1.4),
        "spin": draw.uniform(-3, 3) / a,
    }


def _scale(scene: dict[str, float]) -> float:
    """T: the largest of tan(theta0) and R |xi|/v0."""
    return max(math.tan(scene["theta"]), 2 * scene["a"] * abs(scene["spin"]) / scene["v0"])


def _groups(scene: dict[str, float], names: tuple[str, ...]) -> dict[str, float]:
    """Groups by the definitions of section 4, retyped."""
    a, m, mu, x0, v0 = (scene[key] for key in ("a", "m", "mu", "x0", "v0"))
    every = {
        "stokes": m * v0 / (6 * pi * mu * a**2),
        "aspect": x0 / a,
        "obliquity": _scale(scene),
        "initial_turning": math.tan(scene["theta"]) / _scale(scene),
        "initial_spin": scene["spin"] / (v0 * _scale(scene) / (4 * a)),
        "capillary": 3 * mu * a * v0 / (scene["sigma"] * x0),
        "volume": scene["V"],
        "contact_angle": scene["phi"],
        "weight": scene["g"] * x0 / v0**2,
        "string_ratio": scene["l"] / a,
    }
    return {name: every[name] for name in names if name in every}


def test_emitted_groups_are_the_published_ones():
    """scaling.py gives the published groups from SI numbers."""
    draw = random.Random(4)
    for _ in range(50):
        scene = _scene(draw)
        extra = {"rho": draw.uniform(700, 1300), "p": 10 ** draw.uniform(6, 8), "E": 2e11, "nu": 0.28, "b": 1e-6}
        a, m, mu, x0, v0 = (scene[key] for key in ("a", "m", "mu", "x0", "v0"))
        si = {
            "reduced_radius": a, "reduced_mass": m, "viscosity": mu, "film_thickness": x0, "speed": v0,
            "angle": scene["theta"], "surface_tension": scene["sigma"], "volume": scene["V"],
            "contact_angle": scene["phi"], "string_length": scene["l"], "gravity": scene["g"],
            "density": extra["rho"], "glass_transition_pressure": extra["p"], "youngs_modulus": extra["E"],
            "poisson_ratio": extra["nu"], "roughness": extra["b"], "hamaker": 1e-19, "radius_ratio": 2.5,
            "initial_rate": 7.0, "attraction_force": 3e-5, "impact_spin": scene["spin"],
            "impact_partner_spin": -2 / a, "obliquity": 1.7, "rate_scale": 11.0,
        }  # fmt: skip
        turns = {name: [draw.uniform(-300, 300) for _ in range(3)] for name in ("turning", "spin", "partner_spin")}
        si |= {f"impact_{name}_{axis}": value for name, own in turns.items() for axis, value in zip("xyz", own)}
        theta_e = 2 * (1 - extra["nu"] ** 2) / (pi * extra["E"])
        tangent, turned = math.tan(scene["theta"]), abs(scene["spin"]) / v0
        published = _groups(scene, ("stokes", "aspect", "obliquity", "capillary", "weight", "string_ratio")) | {
            "initial_turning": tangent / 1.7,
            "initial_spin": scene["spin"] / 11.0,
            "initial_partner_spin": -2 / a / 11.0,
            "obliquity_pair": max(tangent, 1.4 * a * turned, 3.5 * a * (2 / a) / v0),
            "obliquity_wall": max(tangent, a * turned),
            "obliquity_space": math.hypot(
                *(4.9 * a * each / v0 for each in turns["turning"]),
                *(1.4 * a * each / v0 for each in turns["spin"]),
                *(3.5 * a * each / v0 for each in turns["partner_spin"]),
            ),
            "rate_scale": 1.7 * v0 / (4 * a),
            "rate_scale_pair": 1.7 * v0 / (4.9 * a),
            "rate_scale_wall": 1.7 * v0 / a,
            "centrifugal": m * (v0 * math.tan(scene["theta"]) / (4 * a)) ** 2 / scene["sigma"],
            "reynolds": extra["rho"] * v0 * x0 / mu,
            "glass_number": extra["p"] / (3 * mu * a * v0 / x0**2),
            "elastic_gap": (3 * pi * theta_e * mu * a**1.5 * v0 / sqrt(2)) ** 0.4 / x0,
            "rough_gap": extra["b"] / x0,
            "initial_rate": v0 * math.tan(scene["theta"]) / (4 * a),
            "rupture_gap": 2 * a * scene["V"] ** (1 / 3) * (1 + scene["phi"] / 2) / x0,
            "adhesion": 1e-19 * a / (6 * x0**2) / (6 * pi * mu * a**2 * v0 / x0),
            # R1 = a (1 + ratio)/ratio and R2 = a (1 + ratio)
            "initial_rate_pair": v0 * math.tan(scene["theta"]) / (1.4 * a + 3.5 * a),
            "centrifugal_pair": m * (v0 * math.tan(scene["theta"]) / (4.9 * a)) ** 2 / scene["sigma"],
            "generalised_centrifugal": m * 7.0**2 * a / 3e-5,
        }
        assert published.keys() == scaling.ARGUMENTS.keys()
        for name, expected in published.items():
            found = getattr(scaling, name)(*(si[key] for key in scaling.ARGUMENTS[name]))
            assert float(found) == pytest.approx(expected, rel=1e-13), name
