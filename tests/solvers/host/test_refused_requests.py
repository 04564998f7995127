"""Requests from Python whose arguments do not go together: refused before anything is computed, by the argument."""

from typing import Any

import numpy as np
import pytest
import wetdoublet.solvers as public
import xarray as xr
from wetdoublet.solvers import InputError, Scene

from ...helpers.own_arm import surface

FREE = ["liquid.viscosity", "liquid.film_thickness"]
WALL = Scene.load("granulation").with_entries({"partner.wall": True})
COATED = Scene.load("lactose-pvp")  # with a bridge from the coating
RUBBED = WALL.with_entries({"particles.friction": 0.3})
VECTORS, PAIRED = np.ones((2, 3)), xr.DataArray([0.1, 0.2], {"k": [1, 2]})
SEEN = {"stokes": [0.1], "angle": [0.5], "outcome": ["stick"]}
RIGHT: dict[str, dict[str, Any]] = {  # a request that each function answers
    "sensitivities": {},
    "collide_many": {}, "regime_map": {}, "collision_averages": {"speeds": 1.0},
    "collide_pair": {"normal": [0, 0, 1], "velocities": VECTORS, "spins": VECTORS},
    "solve": {"free": "liquid.viscosity", "within": (0.2, 20.0), "restitution": 0.5},
    "equations": {}, "prove": {"stokes": 0.1, "angle": 0.5},
    "fit": {"data": SEEN, "free": "liquid.viscosity"},
    "design": {"free": FREE, "over": {"stokes": (0.06, 0.3), "angle": 0.0}, "n": 4},
}  # fmt: skip
REFUSED: dict[str, list[tuple[Any, ...]]] = {  # what is changed of it, the field, and for some what is said
    "collide_many": [
        ({"stokes": [0.1, 0.2], "angle": [0.1, 0.2, 0.3]}, "impact.angle", "differs in length"),
        ({"vary": {"liquid.viscosity": [1.0, 2.0], "bridge.volume": [0.1] * 3}}, "bridge.volume", "length"),
        ({"stokes": [0.1, -0.2]}, "impact.stokes", "out of range"),
        ({"stokes": np.full((2, 3), 0.1), "angle": [0.1, 0.2]}, "impact.angle", "does not fit"),
        ({"stokes": PAIRED, "angle": [0.1, 0.2, 0.3]}, "impact.angle", "does not fit"),
        ({"stokes": PAIRED, "angle": PAIRED.assign_coords(k=[1, 3])}, "impact.angle", "is not aligned"),
        ({"stokes": PAIRED.rename(k="angle"), "angle": 0.1}, "dims", "does not lie alone"),
        ({"stokes": PAIRED.rename(k="outcome")}, "dims", "is the name of a result"),
        ({"stokes": ["much"]}, "impact.stokes", "is not a number"),
        ({"stokes": 0.1, "speed": 1.0}, "speed", "together with stokes"),
        ({"angle": ["60"]}, "impact.angle", "has no unit"),
        ({"of": ["restitutoin"]}, "of", "did you mean restitution?"),
        ({"vary": {"impact.angle": [1.0]}}, "vary", "has an argument of its own"),
        ({"vary": {"bridge.law": ["mikami", "willet"]}}, "bridge.law", "did you mean willett?"),
        ({"vary": {"partner.wall": True}}, "vary", "is a choice"),
        ({"vary": {"pendulum.length": [1.0]}}, "vary", "table that the scene granulation has not"),
        ({"vary": {"particles.radius": [1e-4]}}, "particles.radius", "with particles.reduced_radius"),
    ],
    "regime_map": [
        ({"stokes": [0.1, 0.1]}, "impact.stokes"),
        ({"stokes": np.geomspace(1, 2, 4000), "angle": np.linspace(0, 1, 5000)}, "impact.angle"),
        ({"vary": {"model.film": "finite"}}, "vary"), ({"of": ["e_n"]}, "of"),
    ],
    "collision_averages": [
        ({"scene": "pendulum"}, "scene"), ({"speeds": None}, "speeds"),
        ({"speeds": ([1.0, 0.5], [1.0, 1.0])}, "speeds"), ({"speeds": ([0.5, 1.0], [0.0, 0.0])}, "speeds"),
        ({"speeds": ([0.5, 1.0, 2.0], [1.0, 3.0, -2.0])}, "speeds", "-2.0 is no density"),
        ({"speeds": "there-is-none.csv"}, "speeds"), ({"radii": [1e-4, 1e-4]}, "radii"),
        ({"films": "thick"}, "films"), ({"tolerance": 1.0}, "tolerance"), ({"wrt": "impact.speed"}, "wrt"),
    ],
    "collide_pair": [
        ({"normal": [0, 1]}, "normal"), ({"velocities": VECTORS[:1]}, "velocities"),
        ({"velocities": np.ones((4, 2, 3)), "spins": np.ones((3, 2, 3))}, "normal, velocities, spins"),
        ({"scene": WALL, "velocities": VECTORS[:1]}, "spins"), ({"velocities": [["fast"] * 3] * 2}, "velocities"),
        ({"velocities": [["5 m"] * 3] * 2}, "velocities"), ({"spins": None}, "spins"),
        ({"scene": "pendulum"}, "pendulum"), ({"scene": surface}, "model.arm"),
        ({"scene": RUBBED, "velocities": VECTORS[:1], "spins": VECTORS[:1]}, "particles.friction"),
    ],
    "equations": [({"until": -1.0}, "until"), ({"until": float("nan")}, "until"), ({"until": "1 m"}, "until")],
    "prove": [
        ({"within": 0.0}, "within"), ({"within": -1.0}, "within"), ({"within": 2.0}, "within"),
        *(({"within": {"liquid.viscosity": ends}}, "within liquid.viscosity") for ends in ((2, 1.9), (2, 2), (-1, 2))),
        ({"within": {"bridge.law": 0.1}}, "within bridge.law"), ({"within": {"liquid.colour": 0.1}}, "within", "col"),
        ({"within": {"impact.speed": 0.1}}, "within impact.speed"),
        ({"within": {"liquid.viscosty": 0.1}}, "within", "did you mean liquid.viscosity?"),
    ],
    "solve": [
        ({"within": (3.0, 1.0)}, "within"), ({"contact_time": 1e-3}, "target"),
        ({"restitution": "half"}, "restitution"), ({"free": "bridge.law"}, "free"),
        ({"scene": COATED, "free": "bridge.volume"}, "free", '"from coating" in this scene'),
        ({"restitution": None, "contact_time": "5 Pa"}, "contact_time"), ({"restitution": None}, "target"),
    ],
    "sensitivities": [
        ({"scene": COATED, "wrt": "bridge.volume"}, "wrt", '"from coating" in this scene'),
        ({"wrt": "bridge.law"}, "wrt", "is a choice"),
    ],
    "fit": [
        ({"free": "liquid.viscosty"}, "free", "did you mean liquid.viscosity?"),
        ({"free": "bridge.law"}, "free", "bridge.law"),
        ({"scene": COATED, "free": "bridge.volume"}, "free", '"from coating" in this scene'),
        ({"prior": {"liquid.film_thickness": "8 um +- 10 %"}}, "prior", "is not free"),
        ({"prior": {"liquid.viscosity": "2 Pa s"}}, "prior", "is no prior"),
        ({"prior": {"liquid.viscosity": "2 m +- 10 %"}}, "prior liquid.viscosity", "a length"),
    ],
    "design": [
        ({"free": ["liquid.viscosty"]}, "free"), ({"scene": COATED, "free": "bridge.volume"}, "free", "not a number"),
        ({"free": ["bridge.contact_angle"], "over": {"stokes": (1e-4, 2e-4), "angle": 0.0}, "n": 1}, "free"),
        ({"over": {"stokes": (0.1, 0.2), "angle": (0.0, 1.6)}}, "impact.angle"),
        ({"over": {"stokes": (0.1, 0.2), "angle": (0.5, 0.2)}}, "over angle"),
        ({"over": {"stokes": 0.1, "speed": 1.0, "angle": 0.0}}, "speed"), ({"n": 0}, "n"),
        ({"speed_sd": "40 %"}, "speed_sd"),
        ({"restitution_sd": 0}, "restitution_sd"), ({"prior": {"particles.roughness": "1 um +- 10 %"}}, "prior"),
    ],
}  # fmt: skip


@pytest.mark.parametrize(("name", "row"), [(name, row) for name, rows in REFUSED.items() for row in rows])
def test_a_request_that_cannot_be_is_named(name: str, row: tuple[Any, ...]) -> None:
    """Shapes, ranges, choices, axes twice, and scenes for which there is no answer."""
    changes, field, *said = row
    request = {"scene": "granulation", **RIGHT[name], **changes}
    if request["scene"] is surface:
        request["scene"] = surface("granulation")
    with pytest.raises(InputError) as caught:
        getattr(public, name)(**{key: value for key, value in request.items() if value is not None or key == "spins"})
    assert caught.value.field == field
    assert all(text in str(caught.value) for text in said)


def test_values_of_a_log_density_are_those_of_its_entries():
    """A value of another entry, one that is missing, and text are named."""
    density = public.log_likelihood("granulation", SEEN, FREE)
    given = dict.fromkeys(FREE, 1e-5)
    for values, said in (
        ({**given, "liquid.viscosty": 1.0}, "did you mean liquid.viscosity"),
        ({FREE[0]: 2.0}, f"{FREE[1]}: missing"),
        ({**given, FREE[0]: "2 Pa s"}, "is no number"),
    ):
        with pytest.raises(InputError, match=said):
            density(values)


def test_a_flow_curve_is_a_file_or_two_arrays():
    """Anything else is an input error."""
    with pytest.raises(InputError, match="is neither"):
        public.flow_curve({"rate": [1.0, 2.0, 3.0], "viscosity": [1.0, 1.0, 1.0]})
