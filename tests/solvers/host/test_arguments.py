"""Wrong arguments from Python: whatever is given to whatever argument, it is an InputError that names it."""

import datetime as dt
import inspect

import numpy as np
import pytest
import wetdoublet.solvers as public
import xarray as xr
from wetdoublet.solvers import InputError, Scene, collide, collide_many, gradients_many, regime_map, sensitivities
from wetdoublet.solvers.many.arguments import checked_numbers
from wetdoublet.solvers.scene.units import quantity


@pytest.fixture(scope="module")
def registry():
    """A registry of pint's that is not ours."""
    import pint

    return pint.UnitRegistry()


class Hostile:
    """An object that will not even be shown."""

    def __repr__(self):
        raise RuntimeError("no")

    def __array__(self, *_args, **_more):
        raise RuntimeError("no")

    def __len__(self):
        return 3


NEST = []
NEST.append(NEST)
WRONG = {  # for every argument
    "an object": object(),
    "a hostile object": Hostile(),
    "a class": dict,
    "bytes": b"granulation",
    "a complex number": 1j,
    "a date": dt.date(2020, 1, 1),
    "a set": {1.5},
    "a list that holds itself": NEST,
    "a list of objects": [object(), None],
    "an array of dates": np.array(["2020-01-01"], "M8[D]"),
    "an array of complex numbers": np.array([1j, 2.0]),
    "an array of truth values": np.array([True, False]),
    "a structured array": np.zeros(2, [("a", float)]),
    "an array of objects": np.array([object(), [1]], dtype=object),
    "an array in three dimensions": np.full((2, 2, 2), 0.1),
    "masked numbers": np.ma.array([0.1, 0.2], mask=[True, False]),
    "a huge integer": 10**5000,
    "a negative number": -1,
    "not a number": float("nan"),
    "long nonsense": "nonsense" * 2000,
    "a table of nonsense": {"nonsense": object()},
    "a table without names": {3: 1.0},
}
FUNCTIONS = {
    "collide": {}, "collide_many": {}, "regime_map": {}, "boundary": {}, "atlas": {"span": (0.5, 0.6)},
    "sensitivities": {}, "gradients_many": {}, "boundary_sensitivities": {},
    "band": {"uncertainty": {"liquid.viscosity": "5 %"}, "over": "impact.stokes", "values": [0.02]},
}  # fmt: skip
ARGUMENTS = [(name, each) for name in FUNCTIONS for each in inspect.signature(getattr(public, name)).parameters]
FINE = [("progress", "a class"), ("slow", "a class")]  # what happens to be right
SHAPED = [(f"collide_many.{each}", "an array in three dimensions")
          for each in ("stokes", "speed", "relative_speed", "angle")]  # fmt: skip
# by the entry that they are values of, or that there is none of
NAMED = {"values": "impact.stokes", "span": "impact.angle", "vary": "nonsense", "over": "nonsense"}


@pytest.mark.parametrize(("name", "argument"), ARGUMENTS, ids=[".".join(each) for each in ARGUMENTS])
def test_a_wrong_argument_is_named(name, argument):
    """Every wrong value of every argument of every public function: one line, not long, that names the argument."""
    for said, value in WRONG.items():
        if (argument, said) in FINE or (f"{name}.{argument}", said) in SHAPED:
            continue
        with pytest.raises(InputError) as caught:
            getattr(public, name)(**{"scene": "granulation", **FUNCTIONS[name], argument: value})
        line = str(caught.value)
        assert "\n" not in line and len(line) < 1500, said
        field = line.partition(": ")[0]
        assert argument in field or field.startswith(NAMED.get(argument, argument)), (said, line)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_mistyped_keyword_is_answered_by_the_nearest(name):
    """What is no argument of a public function is bad input, and the argument that is meant is named."""
    known = list(inspect.signature(getattr(public, name)).parameters)
    for argument in known:
        with pytest.raises(InputError, match=f"is no argument of {name}, did you mean") as caught:
            getattr(public, name)("granulation", **{f"{argument}z": 1})
        assert caught.value.field == f"{argument}z"
        assert caught.value.accepted == ", ".join(known)


METHODS = {
    "load": lambda value: Scene.load("granulation", model=value),
    "from_toml": Scene.from_toml,
    "from_dict": Scene.from_dict,
    "comments": lambda value: Scene.from_dict({}, comments=value),
    "package": lambda value: Scene.from_dict({}, package=value),
    "with_entries": Scene.load("granulation").with_entries,
    "an entry": lambda value: Scene.load("granulation").with_entries({"liquid.viscosity": value}),
    "a choice": lambda value: Scene.load("granulation").with_entries({"bridge.law": value}),
    "a flag": lambda value: Scene.load("granulation").with_entries({"partner.wall": value}),
    "the name": lambda value: Scene.load("granulation").with_entries({"name": value}),
    "stokes": lambda value: Scene.load("granulation").with_impact(stokes=value),
    "with_model": Scene.load("granulation").with_model,
    "given": lambda value: Scene("", value),
}


@pytest.mark.parametrize("method", METHODS)
def test_a_scene_of_wrong_parts(method):
    """Whatever a scene is made of, or changed by, that is not right: one line."""
    for value in WRONG.values():
        with pytest.raises(InputError) as caught:
            METHODS[method](value)
        line = str(caught.value)
        assert "\n" not in line and len(line) < 1500


@pytest.mark.slow
def test_quantities_are_converted(registry):
    """Values that carry a unit, pint's or xarray's, are read in it, wherever numbers are taken."""
    speed, angle = registry.Quantity(54, "cm/s"), registry.Quantity(60, "deg")
    one = collide("granulation", speed=speed, angle=angle, rtol=1e-6)
    assert (one.speed, one.angle) == (0.54, pytest.approx(np.pi / 3, rel=1e-15))
    speeds = registry.Quantity(np.array([54.0, 108.0]), "cm/s")
    viscosity = xr.DataArray([1000.0, 2000.0], attrs={"units": "mPa s"})
    many = collide_many("granulation", speed=speeds, angle=angle, vary={"liquid.viscosity": viscosity})
    np.testing.assert_allclose(many.speed, [0.54, 1.08], rtol=1e-15)
    np.testing.assert_allclose(many["liquid.viscosity"], [1.0, 2.0], rtol=1e-15)
    vary = {"bridge.volume": registry.Quantity(10, "percent")}
    varied = regime_map("granulation", speed=speeds, angle=angle, vary=vary)
    np.testing.assert_allclose(varied.speed, [0.54, 1.08], rtol=1e-15)
    assert float(varied["bridge.volume"][0]) == pytest.approx(0.1, rel=1e-15)
    assert public.boundary("granulation-dry-bridge", angle=registry.Quantity(0, "deg"), stokes=(1, 2)).angles == (0.0,)
    found = sensitivities("granulation", wrt="impact.speed", speed=speed, angle=angle, rtol=1e-6)
    assert found.reference["impact.speed"] == 0.54
    slopes = gradients_many("granulation", speed=speeds, angle=angle, wrt="impact.speed", rtol=1e-6)
    np.testing.assert_allclose(slopes.speed, [0.54, 1.08], rtol=1e-15)
    changed = Scene.load("granulation").with_entries({"liquid.viscosity": registry.Quantity(3, "Pa s")})
    assert changed.liquid.viscosity == 3.0
    tables = Scene.load("granulation").to_dict()
    tables["liquid"]["film_thickness"] = registry.Quantity(8, "micrometer")
    assert Scene.from_dict(tables).liquid.film_thickness == pytest.approx(8e-6, rel=1e-15)


@pytest.mark.parametrize(("name", "unit"), [("impact.speed", "km"), ("impact.speed", ""), ("impact.stokes", "rad")])
def test_a_quantity_of_another_dimension_is_refused(registry, name, unit):
    """A length is no speed, and a speed without its unit, once it is a quantity, is none either."""
    labelled = xr.DataArray([1.0], attrs={"units": unit})
    for value in (registry.Quantity(1.0, unit), registry.Quantity(np.array([1.0]), unit), labelled):
        with pytest.raises(InputError, match=f"^{name}: .* is a"):
            checked_numbers(name, value)


def test_degrees_celsius_are_no_multiple_of_a_kelvin():
    """A unit whose zero is another one is refused rather than scaled."""
    with pytest.raises(InputError, match="whose zero is not zero"):
        quantity("25 degC", "K", "custom.temperature", "a temperature")


def test_masked_values_are_refused_and_unmasked_ones_are_numbers(registry):
    """A mask that hides something is never overlooked, in a quantity neither; one that hides nothing is no harm."""
    hidden = np.ma.array([0.1, 0.2, 0.3], mask=[False, True, False])
    for value in (hidden, registry.Quantity(hidden, ""), xr.DataArray(hidden), np.ma.masked):
        with pytest.raises(InputError, match=r"^impact.stokes: (1 of [13] values are masked|nan is not finite)"):
            checked_numbers("impact.stokes", value)
    open_ = np.ma.array([0.1, 0.2], mask=False)
    assert checked_numbers("impact.stokes", open_).tolist() == [0.1, 0.2]


def test_numbers_of_any_kind_are_numbers():
    """Arrays of no dimension, of integers, of text, Series and ranges are what they say."""
    for value in (np.array(2), np.float32(2), np.uint8(2), xr.DataArray(2.0), np.array("2"), "2", 2):
        assert checked_numbers("impact.stokes", value).tolist() == 2.0
        assert Scene.load("granulation").with_impact(stokes=value).stokes == 2.0
    for value in (range(1, 3), [np.float64(1), "2"], np.array([1, 2]), np.array(["1", "2"]), xr.DataArray([1, 2])):
        assert checked_numbers("impact.stokes", value).tolist() == [1.0, 2.0]


def test_names_in_one_text():
    """A list as on the command line is answered by that of Python, where all its names are known."""
    data = {"speed": [6.0], "angle": [0.3], "restitution": [0.9]}
    with pytest.raises(InputError, match=r'is one text; accepted: \["liquid.viscosity", "particles.roughness"\]$'):
        public.fit("granulation", data, "liquid.viscosity, particles.roughness")
    with pytest.raises(InputError, match="is not known"):
        sensitivities("granulation", wrt="liquid.viscosity, particles.rouhgness")
