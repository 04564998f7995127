"""A scene entry's way into the model: one table, for scenes, batches and sensitivities."""

import pytest
from wetdoublet.derive.vocabulary.quantities import VOCABULARY
from wetdoublet.solvers.scene.quantities import Ways, quantities
from wetdoublet.solvers.scene.schema import FIELDS

NUMBERS = [name for name, field in FIELDS.items() if field.numeric]
FULL = {
    "particles.radius": 1e-4, "particles.density": 2500.0, "particles.roughness": 2e-7,
    "particles.dry_restitution": 0.9, "particles.friction": 0.2, "particles.contact_tangential_restitution": 0.3,
    "particles.youngs_modulus": 7e10, "particles.poisson_ratio": 0.2, "liquid.viscosity": 2.0,
    "liquid.film_thickness": 8e-6, "liquid.glass_transition_pressure": 2e7, "liquid.density": 1e3,
    "bridge.surface_tension": 0.025, "bridge.volume": 0.1, "bridge.contact_angle": 0.3, "attraction.hamaker": 1e-19,
    "partner.radius": 2e-4, "partner.density": 2000.0, "pendulum.length": 0.5, "pendulum.gravity": 9.8,
    "impact.stokes": 0.03, "impact.angle": 1.0, "impact.spin": 300.0, "impact.partner_spin": -200.0,
    "partner.contact_angle": 0.5,
}  # fmt: skip
LIQUID = {
    "liquid.flow_index": 0.5, "liquid.relaxation_time": 1e-5, "liquid.infinite_shear_viscosity": 0.01,
    "liquid.yield_stress": 20.0, "liquid.reference_rate": 10.0, "liquid.plateau_rate": 0.1, "liquid.measured_to": 1e3,
}  # fmt: skip
OTHERS = {
    "particles.reduced_radius": ("particles.radius", 5e-5), "particles.reduced_mass": ("particles.density", 5e-9),
    "particles.mass": ("particles.density", 1e-8), "partner.mass": ("partner.density", 7e-8),
    "impact.speed": ("impact.stokes", 0.5), "impact.relative_speed": ("impact.stokes", 0.5),
    "particles.diameter": ("particles.radius", 2e-4), "partner.diameter": ("partner.radius", 3e-4),
    "liquid.coating_thickness": ("liquid.film_thickness", 4e-6),
    "partner.coating_thickness": ("liquid.film_thickness", 4e-6, ("liquid.coating_thickness", 4e-6)),
    "bridge.coating_fraction": (
        "liquid.film_thickness", 0.1, ("liquid.coating_thickness", 4e-6), ("bridge.volume", "from coating"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", NUMBERS)
def test_every_number_reaches_the_model(name: str) -> None:
    """What an entry is, or takes part in, are quantities of the derivation; and they change with it."""
    entries = FULL | (LIQUID if name in LIQUID else {})
    if name in OTHERS:
        instead, value, *others = OTHERS[name]
        del entries[instead]
        entries |= {name: value, **dict(others)}
    ways = Ways.of(entries)
    before = quantities(entries, ways)
    after = quantities(entries | {name: entries[name] * 1.01}, ways)
    assert {key for key in before if before[key] != after[key]}
    of_laws = {each.partition(".")[2] for each in LIQUID} if name in LIQUID else set()
    assert set(before) <= {*VOCABULARY, *of_laws}
    if FIELDS[name].quantity not in ("", "reduced_radius", "reduced_mass", "contact_angle"):  # those are the pair's
        factor = before[FIELDS[name].quantity] / entries[name]
        assert after[FIELDS[name].quantity] == pytest.approx(1.01 * factor * entries[name], rel=1e-12)
