"""Emitted structures as CasADi functions: their derivatives, and the force that decides what rests."""

import casadi
import numpy as np
import pytest
from wetdoublet.generated.assemble import Laws, casadi_functions
from wetdoublet.solvers.host.emitted import LAWS, manifest, module

VALUES = {"gap": 0.4, "normal_velocity": 0.7, "orbital_momentum": 12.0, "string_ratio": 50.0}


def emitted(name: str, **region: int) -> tuple[dict[str, casadi.Function], np.ndarray, np.ndarray]:
    """Functions of a structure with a law in each slot, a state and groups."""
    structure = module(name)
    film = "constant-volume" if "spread" in name else "finite"
    first = {slot: next(iter(laws)) for slot, laws in LAWS.items()} | {"film": film}
    laws = {slot: module(f"laws.{slot}_{first[slot].replace('-', '_')}") for slot in structure.SLOTS}
    state, groups = (np.array([VALUES.get(each, 0.3) for each in of]) for of in (structure.STATES, structure.GROUPS))
    return casadi_functions(structure, Laws(**laws), **region), state, groups


@pytest.mark.parametrize(("film", "shear"), [(1, 1), (0, 1), (0, 0)])
def test_derivatives_are_differences(film: int, shear: int):
    """The Jacobian of the rates and the rates of the events are those of the functions that they are of."""
    functions, state, groups = emitted("oblique_bridge", film=film, shear=shear)

    def slope(name: str, along: np.ndarray) -> np.ndarray:
        ahead, behind = (functions[name](state + step * along, groups).full().ravel() for step in (1e-5, -1e-5))
        return np.asarray(ahead - behind) / 2e-5

    jacobian = functions["jacobian"](state, groups).full()
    expected = np.stack([slope("right_hand_side", axis) for axis in np.eye(state.size)], axis=1)
    np.testing.assert_allclose(jacobian, expected, rtol=1e-6, atol=1e-7 * np.abs(jacobian).max())
    rates = functions["right_hand_side"](state, groups).full().ravel()
    found = functions["event_rates"](state, groups).full().ravel()
    size = np.abs(rates).max()
    expected = size * slope("events", rates / size)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-7 * np.abs(found).max())


@pytest.mark.parametrize("name", manifest()["structures"])
def test_the_inward_force_accelerates_inward(name: str):
    """Where there is no film: over m v0^2/x0, so that it is minus the acceleration over v0^2/x0."""
    functions, state, groups = emitted(name, film=0)
    rate = functions["right_hand_side"](state, groups)[module(name).STATES.index("normal_velocity")]
    assert float(functions["inward_force"](state, groups)) == pytest.approx(-float(rate), rel=1e-13, abs=1e-15)


def test_an_empty_slot_is_named():
    """A structure whose slot no law fills says which slot."""
    with pytest.raises(AttributeError, match="'bridge'"):
        _ = Laws(film=module("laws.film_finite")).bridge
