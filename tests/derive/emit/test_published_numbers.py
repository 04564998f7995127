"""Emitted functions against the equations retyped in plain floats and SI, law by law, structure by structure."""

import importlib
import math
import random
from collections.abc import Callable
from itertools import product
from types import ModuleType

import pytest
from wetdoublet.derive.physics.structure import Structure, structures
from wetdoublet.generated import scaling
from wetdoublet.generated.assemble import Laws

Bridge = Callable[[float, float, float], float]
pi, ln, exp, sqrt, cos, sin = math.pi, math.log, math.exp, math.sqrt, math.cos, math.sin


def emitted(name: str) -> ModuleType:
    """An emitted module of `generated`."""
    return importlib.import_module(f"wetdoublet.generated.{name}")


# The published bridge laws, F_c/(pi R sigma) as a function of h = x/R, V and phi.


def _exponential(h: float, V: float, phi: float, slope: float, offset: float, tail: float, logarithm: float) -> float:
    A = -1.1 * V**-0.53
    B = (slope * logarithm - 0.96) * phi**2 + offset * logarithm + 0.48
    C = tail * logarithm + 0.078
    return exp(A * h + B) + C


WILLETT = (
    ((-0.44507, 0.050832, -1.1466), (-0.1119, -0.000411, -0.1490), (-0.012101, -0.0036456, -0.01255),
     (-0.0005, -0.0003505, -0.00029076)),
    ((1.9222, -0.57473, -1.2918), (-0.0668, -0.1201, -0.22574), (-0.0013375, -0.0068988, -0.01137)),
    ((1.268, -0.01396, -0.23566), (0.198, 0.092, -0.06418), (0.02232, 0.02238, -0.009853),
     (0.0008585, 0.001318, -0.00053)),
    ((-0.010703, 0.073776, -0.34742), (0.03345, 0.04543, -0.09056), (0.0018574, 0.004456, -0.006257)),
)  # fmt: skip
"""Of f1 to f4, by powers of ln V: coefficients of 1, phi and phi^2."""


def _willett(h: float, V: float, phi: float) -> float:
    lnS, L = ln(h / (2 * sqrt(V))), ln(V)

    def term(p: float, q: float, r: float) -> float:
        return p + q * phi + r * phi**2

    f1, f2, f3, f4 = (sum(term(*row) * L**k for k, row in enumerate(rows)) for rows in WILLETT)
    return 2 * exp(f1 - f2 * exp(f3 * lnS + f4 * lnS**2))


def _lambert(h: float, V: float, phi: float) -> float:
    return 2 * cos(phi) * (1 - h / sqrt(h * h + 2 * V / pi))


def _rabinovich(h: float, V: float, phi: float) -> float:
    filling = sqrt(sqrt(h * h + 2 * V / pi) - h)
    return _lambert(h, V, phi) + 2 * sin(filling) * sin(filling + phi)


def _willett_simple(h: float, V: float, phi: float) -> float:
    S = h / sqrt(V)
    return 2 * cos(phi) / (1 + 1.05 * S + 2.5 * S * S)


BRIDGES: dict[str, Bridge] = {
    "mikami": lambda h, V, phi: _exponential(h, V, phi, -0.34, -0.019, 0.0042, ln(V)),
    "mikami_log10": lambda h, V, phi: _exponential(h, V, phi, -0.34, -0.019, 0.0042, math.log10(V)),
    "soulie": lambda h, V, phi: _exponential(h, V, phi, -0.148, -0.0082, 0.0018, ln(V)),
    "willett": _willett,
    "willett_simple": _willett_simple,
    "lambert": _lambert,
    "rabinovich": _rabinovich,
    "constant": lambda h, V, phi: 2 * cos(phi),
}


def test_every_bridge_law_is_retyped():
    """The laws above are those that are emitted."""
    names = {each.name.removeprefix("bridge_") for each in _law_modules("bridge")}
    assert names == BRIDGES.keys()


def _law_modules(slot: str) -> list[ModuleType]:
    from wetdoublet.derive.physics.laws import LAWS

    modules = [emitted(f"laws.{law.module}") for law in LAWS[slot].values()]
    for module in modules:
        module.name = module.__name__.rsplit(".", 1)[-1]
    return modules


@pytest.mark.parametrize("name", BRIDGES)
def test_bridge_law(name: str):
    """The emitted law is the published fit at 200 random gaps, volumes and angles, to 1e-13 of its value's terms."""
    law, published, draw = emitted(f"laws.bridge_{name}"), BRIDGES[name], random.Random(name)
    for _ in range(200):
        h, V, phi = draw.uniform(1e-3, 0.6), 10 ** draw.uniform(-3, -0.7), draw.uniform(0, 1.2)
        expected = published(h, V, phi)
        # largest term: the exponential forms add C < 0.1, lambert's 1 - h/s cancels by at most s/(s - h)
        assert float(law.force(h, V, phi)) == pytest.approx(expected, rel=1e-13, abs=1e-14), (h, V, phi)


# The equations of motion, section 2 and 3, in SI.


def si_rates(
    scene: dict[str, float], state: dict[str, float], structure: Structure, laws: dict[str, str]
) -> dict[str, tuple[float, float]]:
    """(rate, sum of the magnitudes of its terms) of x, u, r^2 omega, xi and beta."""
    a, m, mu, x0 = (scene[key] for key in ("a", "m", "mu", "x0"))
    x, u, omega, xi, beta = (state[key] for key in ("x", "u", "omega", "xi", "beta"))
    r = 4 * a + x
    F_n = 6 * pi * mu * a**2 * u / x * (1 - x / x0) ** 2 if x < x0 else 0.0
    outer = x0 if laws["shear"] == "film" else 2 * a
    log_factor = ln(outer / x) if x < outer else 0.0
    F_t = 8 * pi * mu * a**2 * (omega - xi) * log_factor
    F_t_terms = 8 * pi * mu * a**2 * (abs(omega) + abs(xi)) * log_factor
    F_c = 0.0
    if structure.bridge:
        R = 2 * a
        F_c = pi * R * scene["sigma"] * BRIDGES[laws["bridge"]](x / R, scene["V"], scene["phi"])
    S_n = S_t = S_n_terms = 0.0
    if structure.strings:
        squared = (r * r + 16 * a * a - 8 * a * r * cos(beta)) / 4
        reach = scene["l"] if laws["strings"] == "small_angle" else sqrt(scene["l"] ** 2 - squared)
        S_n = m * scene["g"] * (r - 4 * a * cos(beta)) / reach
        S_n_terms = m * scene["g"] * (r + 4 * a) / reach
        S_t = m * scene["g"] * 4 * a * sin(beta) / reach
    arm = r / 2
    du = (m * r * omega**2 - F_n - F_c - S_n) / m
    domega = ((-F_t - S_t) / m - 2 * u * omega) / r
    return {
        "x": (u, abs(u)),
        "u": (du, r * omega**2 + (abs(F_n) + abs(F_c) + S_n_terms) / m),
        "r2omega": (2 * r * u * omega + r * r * domega, r * (F_t_terms + abs(S_t)) / m + 4 * r * abs(u * omega)),
        "xi": (F_t * arm / (16 / 5 * m * a**2), F_t_terms * arm / (16 / 5 * m * a**2)),
        "beta": (omega, abs(omega)),
    }


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


@pytest.mark.parametrize("structure", structures(), ids=lambda structure: structure.name)
def test_emitted_equations_are_the_si_equations(structure: Structure):
    """Emitted rates times their scales are the SI equations: all laws, in and out of the film and the shear's edge."""
    module, draw = emitted(structure.name), random.Random(structure.name)
    variants = {
        "shear": ("immersed", "film") if structure.oblique else ("immersed",),
        "arm": ("midgap",),
        "strings": ("exact", "small_angle") if structure.strings else ("exact",),
        "bridge": tuple(BRIDGES) if structure.bridge else ("mikami",),
    }
    for choice in product(*variants.values()):
        laws = dict(zip(variants, choice, strict=True))
        filled = Laws(
            film=emitted("laws.film_finite"), **{slot: emitted(f"laws.{slot}_{name}") for slot, name in laws.items()}
        )
        scene = _scene(draw)
        a, x0, v0 = scene["a"], scene["x0"], scene["v0"]
        omega0, unit = v0 * math.tan(scene["theta"]) / (4 * a), v0 * _scale(scene) / (4 * a)
        edge = float(filled.shear.edge(x0 / a)) * x0
        # in the film, beyond the film but sheared if the law shears there, and beyond both
        for x in (draw.uniform(0.01, 0.99) * x0, draw.uniform(1.05, 1.9) * x0, draw.uniform(1.05, 2) * max(edge, x0)):
            r = 4 * a + x
            omega = draw.uniform(0.1, 2) * omega0 if structure.oblique else 0.0
            xi = draw.uniform(-0.5, 1) * omega0 if structure.oblique else 0.0
            if structure.reduced:  # L keeps its start value
                xi = ((4 * a + x0) ** 2 * omega0 - r * r * omega) / (32 / 5 * a**2) + scene["spin"]
            beta = draw.uniform(0.01, 3) if structure.oblique else 0.0
            si = {"x": x, "u": draw.uniform(-1.5, 1.5) * v0, "omega": omega, "xi": xi, "beta": beta}
            state = {
                "gap": x / x0,
                "normal_velocity": si["u"] / v0,
                "orbital_momentum": r * r * omega / (a * a * unit),
                "spin": xi / unit,
                "rotation": beta,
            }
            rates = module.right_hand_side(
                {name: state[name] for name in module.STATES},
                _groups(scene, module.GROUPS),
                filled,
                film=int(x < x0),
                shear=int(x < edge),
            )
            expected = si_rates(scene, si, structure, laws)
            if structure.reduced:  # the eliminated spin is itself a difference
                magnitude = ((4 * a + x0) ** 2 * omega0 + r * r * omega) / (32 / 5 * a**2) + abs(scene["spin"])
                expected = {key: (value, terms * (1 + magnitude / abs(xi))) for key, (value, terms) in expected.items()}
            scales = {
                "gap": ("x", v0),
                "normal_velocity": ("u", v0**2 / x0),
                "orbital_momentum": ("r2omega", a * a * unit * v0 / x0),
                "spin": ("xi", unit * v0 / x0),
                "rotation": ("beta", v0 / x0),
            }
            assert set(rates) == set(module.STATES)
            for name, rate in rates.items():
                key, scale = scales[name]
                value, terms = expected[key]
                assert abs(float(rate) * scale - value) <= 1e-12 * terms, (name, laws, x / x0)


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
