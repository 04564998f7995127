"""Entries of a scene as a file has them, and what refuses a wrong one."""

import pytest
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.scene.scene import Scene

BASE = {  # granulation, as a file has it
    "particles.reduced_radius": "50 um",
    "particles.reduced_mass": "5.2e-6 g",
    "particles.roughness": "0.2 um",
    "particles.dry_restitution": 0.99,
    "liquid.viscosity": "2 Pa s",
    "liquid.film_thickness": "8 um",
    "liquid.glass_transition_pressure": "20 MPa",
}
PEOPLE = {  # spheres in a coating, as a laboratory has them
    "particles.diameter": "200 um", "particles.density": "2.5 g/cm^3", "particles.roughness": "0.2 um",
    "particles.dry_restitution": 0.9, "liquid.viscosity": "20 mPa s", "liquid.coating_thickness": "4 um",
    "bridge.surface_tension": "50 mN/m", "impact.relative_speed": "6 m/s", "impact.angle": "50 deg",
}  # fmt: skip
BRIDGE = {"bridge.surface_tension": "0.025 N/m", "bridge.volume": 0.1, "bridge.contact_angle": "0 deg"}

CIRCLES = {  # a doublet that dips ever less into its film
    "particles": {
        "reduced_radius": 1.61e-4, "reduced_mass": 5.4e-10, "roughness": 1.25e-6, "dry_restitution": 0.938,
        "youngs_modulus": 3.2e10, "poisson_ratio": 0.0156,
    },
    "liquid": {"viscosity": 1.794, "film_thickness": 4.66e-5, "glass_transition_pressure": 1.1e8},
    "bridge": {"surface_tension": 0.096, "volume": 0.9565, "contact_angle": 0.981, "law": "mikami-log10"},
    "model": {"arm": "midgap", "tangential": "film"},
}  # fmt: skip


def tables(entries):
    """Return nested tables of dotted entries, leaving out those that are None."""
    nested = {}
    for name, value in entries.items():
        table, _, key = name.partition(".")
        if value is not None:
            nested.setdefault(table, {})[key] = value
    return nested


def refused(entries, from_file=True):
    """Return the InputError that a scene of these entries raises, checked to be one full line."""
    with pytest.raises(InputError) as caught:
        Scene.from_dict(tables(entries), from_file=from_file)
    line = str(caught.value)
    assert len(line.splitlines()) == 1
    assert line.startswith(caught.value.field + ": ") and "; accepted: " in line
    return caught.value
