"""Laws of liquids against integrals of their own, their limits, viscosities by name, and both contact angles."""

import math
import sys
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from scipy import integrate, interpolate, optimize, special
from wetdoublet.derive.checks.user import model_checks
from wetdoublet.derive.laws.liquids import file_of
from wetdoublet.generated.laws import film_finite, glass_film_corrected, glass_literal, shear_film, shear_immersed
from wetdoublet.solvers import Scene, collide, collide_many
from wetdoublet.solvers.errors import InputError, ModelWarning
from wetdoublet.solvers.scene.liquids import cheng
from wetdoublet.solvers.scene.quantities import common_angle
from wetdoublet.solvers.scene.schema import LIQUIDS
from wetdoublet.solvers.scene.user_model_source import liquid_package

ASPECT = 0.16
Curve = Callable[[float], float]


def law(name: str, slot: str, which: str):
    return liquid_package(name).law(slot, f"{name}-{which}")


def resistance(stress: Curve, gap: float, speed: float) -> float:
    """A film's force over 6 pi mu a^2 u/x0: 2 pi a times the integral of s (stress at the wall)/h over h."""

    def ring(root: float) -> float:
        thickness = gap + root**2
        rate = 3 * speed * math.sqrt(2 / ASPECT) * root / thickness**2
        return 2 * root**2 * stress(rate) / thickness

    ends = math.sqrt(1 - gap)
    inner = [math.sqrt(gap / 3)] if gap / 3 < 1 - gap else None
    total = integrate.quad(ring, 0, ends, points=inner, limit=400, epsrel=1e-9)[0]
    return total * math.sqrt(2 * ASPECT) / (3 * speed)


def in_slit(viscosity: Curve) -> Curve:
    """The stress at the wall of a flow between plates by the apparent rate, from the integral of stress over rate."""

    def wall(apparent: float) -> float:
        def excess(logarithm: float) -> float:
            rate = math.exp(logarithm)
            stress = viscosity(rate) * rate
            squares = integrate.quad(lambda y: (viscosity(math.exp(y)) * math.exp(y)) ** 2 * math.exp(y),
                                     logarithm - 40, logarithm, epsrel=1e-8, limit=200)[0]  # fmt: skip
            return math.log(1.5 * (rate - squares / stress**2) / apparent)

        rate = math.exp(optimize.brentq(excess, math.log(apparent) - 2, math.log(apparent) + 3, xtol=1e-9))
        return viscosity(rate) * rate

    places = np.linspace(-10, 12, 45)
    curve = interpolate.CubicSpline(places, [math.log(wall(math.exp(place))) for place in places])
    return lambda rate: math.exp(curve(math.log(max(rate, 1e-4))))


def cross(n: float, time: float, last: float) -> Curve:
    return lambda rate: last + (1 - last) / (1 + (time * rate) ** (1 - n))


def carreau(n: float, time: float, last: float) -> Curve:
    return lambda rate: last + (1 - last) * (1 + (time * rate) ** 2) ** ((n - 1) / 2)


@pytest.mark.parametrize("n", [0.3, 0.5, 0.8, 1.3])
def test_power_law_film_is_an_incomplete_beta_function(n: float):
    """Rodin's integral of the squeeze force, ended at the rim of the film: B(1 - x/x0; (n + 3)/2, (3n - 1)/2)."""
    film = law("power-law", "film", "finite").resistance
    for gap, speed in ((1e-2, 1.0), (0.1, 0.01), (0.9, 1.0)):
        beta = integrate.quad(lambda t: t ** ((n + 1) / 2) * (1 - t) ** (1.5 * (n - 1)), 0, 1 - gap, epsrel=1e-11)[0]
        if n > 1 / 3:
            a, b = (n + 3) / 2, (3 * n - 1) / 2
            assert beta == pytest.approx(special.betainc(a, b, 1 - gap) * special.beta(a, b), rel=1e-8)
        rate = 3 * speed * math.sqrt(2 / ASPECT) / gap**1.5
        expected = 2 / gap * ((2 * n + 1) / (3 * n)) ** n * (rate / 0.1) ** (n - 1) * beta
        found = float(film(gap, -speed, ASPECT, n, 0.1, 1e-9))
        assert found == pytest.approx(expected, rel=5e-4)  # ten nodes


@pytest.mark.parametrize(("name", "curve"), [("cross", cross), ("carreau", carreau)])
@pytest.mark.parametrize(("n", "last", "error"), [(0.3, 0.0, 0.01), (0.6, 0.0, 0.006), (0.3, 0.02, 0.03)])
def test_films_between_plateaus_are_the_lubrication_integral(name: str, curve: Callable, n: float, last: float, error):
    """With the flow between plates integrated ring by ring, in the error of the representative viscosity."""
    film = law(name, "film", "finite").resistance
    for time in (0.01, 1.0, 100.0):
        stress = in_slit(curve(n, time, last))
        for gap in (0.02, 0.3):
            found = float(film(gap, -1.0, ASPECT, n, time, last))
            assert found == pytest.approx(resistance(stress, gap, 1.0), rel=error)


@pytest.mark.parametrize("n", [0.5, 1.0])
@pytest.mark.parametrize("yielding", [1e-6, 0.1, 10.0, 1000.0])
def test_yielding_films_are_the_lubrication_integral(n: float, yielding: float):
    """Between plates the apparent rate is that of the stress S beyond the yield stress, solved for S."""

    def stress(rate: float) -> float:
        def excess(logarithm: float) -> float:
            beyond = math.exp(logarithm)
            flow = 3 * n / (beyond + yielding) ** 2 * beyond ** (1 / n + 1)
            return math.log(flow * (beyond / (2 * n + 1) + yielding / (n + 1)) / rate)

        return yielding + math.exp(optimize.brentq(excess, -80, 40, xtol=1e-12)) if rate > 1e-12 else yielding

    film = law("herschel-bulkley", "film", "finite").resistance
    for gap in (0.01, 0.1, 0.5):
        found = float(film(gap, -1.0, ASPECT, n, 1.0, 1e-4, yielding))
        assert found == pytest.approx(resistance(stress, gap, 1.0), rel=0.015)


LIMITS = {
    "power-law": (1.0, 0.3, 1e-3), "cross": (1.0, 3.0, 1.0), "carreau": (1.0, 3.0, 0.2),
    "herschel-bulkley": (1.0, 0.3, 1e-3, 1e-14),
}  # fmt: skip


@pytest.mark.parametrize("name", LIQUIDS)
def test_a_liquid_of_one_viscosity_is_newtonian(name: str):
    """With the index 1, no yield stress, and a plateau as high as the other: film, shear and pressure to rounding."""
    groups = LIMITS[name]
    for gap in (1e-3, 0.2, 0.9):
        film = law(name, "film", "finite").resistance(gap, -0.7, ASPECT, *groups)
        assert float(film) == pytest.approx(film_finite.resistance(gap), rel=1e-12)
        for which, known in (("immersed", shear_immersed), ("film", shear_film)):
            factor = law(name, "shear", which).log_factor(gap, ASPECT, -0.7, *groups)
            assert float(factor) == pytest.approx(float(known.log_factor(gap, ASPECT)), rel=1e-12)
        for which, known in (("literal", glass_literal), ("film-corrected", glass_film_corrected)):
            pressure = law(name, "glass", which).pressure(gap, 0.7, ASPECT, *groups)
            assert float(pressure) == pytest.approx(known.pressure(gap, 0.7), rel=1e-12)


def test_limits_of_rates():
    """Fast shear leaves the last plateau, and a yield stress that sets in at lower rates is that of the plastic."""
    film = law("carreau", "film", "finite").resistance
    last = float(film(0.1, -1.0, ASPECT, 0.3, 1e12, 0.25))
    assert last == pytest.approx(0.25 * film_finite.resistance(0.1), rel=1e-6)
    plastic = partial(law("herschel-bulkley", "film", "finite").resistance, 0.1, -1e-2, ASPECT, 1.0, 1.0)
    near, nearer, nearest = (float(plastic(rate, 10.0)) for rate in (1e-2, 1e-3, 1e-5))
    assert near == pytest.approx(nearest, rel=2e-3)
    assert nearer == pytest.approx(nearest, rel=2e-5)


def test_shear_and_pressure_of_a_power_law_are_their_integrals():
    """Couette stress over the disc, and the pressure on the axis, with the rates of the squeeze."""
    n, groups = 0.6, (0.6, 0.1, 1e-9)
    for gap in (0.02, 0.3):

        def at(thickness: float, power: float, gap: float = gap) -> float:
            rate = 3 * 0.7 * math.sqrt(2 / ASPECT * (thickness - gap)) / thickness**2
            return (rate / 0.1) ** (n - 1) / thickness**power

        sheared = integrate.quad(at, gap, 1, args=(1,), limit=200)[0]
        found = law("power-law", "shear", "film").log_factor(gap, ASPECT, -0.7, *groups)
        assert float(found) == pytest.approx(sheared, rel=0.03)  # six nodes, and a root at the axis
        pressed = ((2 * n + 1) / (3 * n)) ** n * 2 * 0.7 * integrate.quad(at, gap, 1, args=(3,), limit=200)[0]
        found = law("power-law", "glass", "film-corrected").pressure(gap, 0.7, ASPECT, *groups)
        assert float(found) == pytest.approx(pressed, rel=0.01)


THINNING = {"liquid.law": "carreau", "liquid.flow_index": 0.5, "liquid.relaxation_time": "20 us"}


def test_a_scene_of_a_liquid_is_written_and_read():
    scene = Scene.load("granulation").with_entries(THINNING)
    assert Scene.from_toml(scene.to_toml()) == scene
    assert scene.law_of("film") == "carreau-finite"
    idle = scene.with_entries({"liquid.law": "newtonian"})
    assert idle.package is None
    assert idle.law_of("film") == "finite"


def test_what_a_liquid_that_thins_is_said_to_be():
    """Where its viscosity holds, of which St and Ca are, is said with the values that are assumed."""
    (line,) = (line for line in Scene.load("granulation").with_entries(THINNING).assumed if "liquid.viscosity" in line)
    assert "at rest; St and Ca are of it" in line
    power = Scene.load("granulation").with_entries({"liquid.law": "power-law", "liquid.flow_index": 0.6})
    assert any("liquid.reference_rate = 1 1/s (default)" in line for line in power.assumed)
    given = power.with_entries({"liquid.reference_rate": "3 1/s"})
    assert any("liquid.reference_rate = 3 1/s; St" in line for line in given.assumed)


@pytest.mark.slow
def test_collisions_of_a_thinning_liquid():
    """Three engines agree; a liquid that does not thin collides as the library's; one that thins is stopped later."""
    scene, impact = Scene.load("granulation").with_entries(THINNING), {"stokes": 0.2, "angle": 0.8, "rtol": 1e-11}
    collisions = [collide(scene, **impact, engine=by) for by in ("taylor", "rosenbrock", "cvodes")]
    found = [each.restitution for each in collisions]
    assert found == pytest.approx([found[0]] * 3, rel=1e-8)
    newtonian = collide("granulation", **impact)
    plain = collide(scene.with_entries({"liquid.flow_index": 1.0}), **impact)
    assert plain.restitution == pytest.approx(newtonian.restitution, rel=1e-9)
    assert collisions[0].smallest_gap < newtonian.smallest_gap
    many = collide_many(scene, **impact, vary={"liquid.flow_index": [0.5, 1.0]})
    assert many["restitution"].values == pytest.approx([found[0], plain.restitution], rel=1e-9)


@pytest.mark.slow
def test_a_creep_at_the_plateau_rate_is_said():
    """Where the yield stress would hold the doublet, the contact lasts as long as the rate is low, and that is said."""
    plastic = {"liquid.law": "herschel-bulkley", "liquid.yield_stress": "200 Pa", "liquid.flow_index": 1.0}
    scene = Scene.load("granulation-dry-bridge").with_entries({**plastic, "liquid.viscosity": "0.02 Pa s"})
    rates = {"liquid.plateau_rate": np.array([[1000.0], [100.0]])}
    found = collide_many(scene, speed=[0.1, 1.0], angle=1.0, vary=rates, of=["contact_time", "validity"])
    (slow, quick), (slower, as_quick) = found["contact_time"].values
    assert slower > 5 * slow
    assert as_quick == pytest.approx(quick, rel=1e-5)
    flag = 1 << found["validity"].attrs["flag_meanings"].split().index("slow_creep")
    assert (found["validity"].values & flag != 0).tolist() == [[True, False], [True, False]]
    one = collide(scene.with_entries({"liquid.plateau_rate": 1000.0}), speed=0.1, angle=1.0)
    assert any(f"the contact lasts {1000 * slow:.3g} times 1/liquid.plateau_rate" in said for said in one.validity)


@pytest.mark.slow
def test_checks_of_the_laws():
    """Every check of a user's model holds for a liquid of the library, with plateaus."""
    assert not [check for check in model_checks(file_of("carreau"))[1] if check.ok is False]


# ---- viscosities by name


@pytest.mark.parametrize(
    ("percent", "celsius", "measured"),
    [(60, 20, 10.8), (80, 20, 60.1), (85, 20, 109), (95, 20, 523), (100, 20, 1410), (85, 40, 33.5), (60, 0, 29.9),
     (0, 20, 1.005), (50, 60, 1.86)],
)  # fmt: skip
def test_glycerol_in_water_as_measured(percent: int, celsius: int, measured: float):
    """Segur & Oberstar, Ind. Eng. Chem. 43, 2117 (1951), in mPa s."""
    assert 1e3 * cheng(percent / 100, celsius) == pytest.approx(measured, rel=0.05)


NAMED = [
    ("glycerol 85 %, 25 degC", 0.0802), ("85 wt% glycerol in water, 25 °C", 0.0802),
    ("glycerine/water 85%, 298.15 K", 0.0802),
    ("water, 20 degC", 0.0010016), ("ethylene glycol, 40 degC", 0.0095), ("glycerol, 20 C", 1.414),
    ("propylene glycol 40 %, 25 degC", 0.00358), ("ethanol, 20 degC", 0.001194),
    ("glycerol 85 %, 77 degF", 0.0802), ("water, 68 °F", 0.0010016),
]  # fmt: skip
UNNAMED = [
    ("water, 120 degC", "99.97"), ("glycerol 85 %, 120 degC", "0 to 100 degC"), ("mud 80 %, 20 degC", "in water"),
    ("glycerol 85 vol%, 20 degC", "volume"), ("glycerol 120 %, 20 degC", "fraction"),
    ("ethylene glycol 80 %, 20 degC", "60%"),
    ("oleic acid, 20 degC", "no source"), ("polyethylene glycol, 20 degC", "no source"),
    ("glycerol 85, 25 degC", '"glycerol 85 %" is a mass fraction'), ("glycerol -5 %, 25 degC", "no such fraction"),
    ("glyzerol, 25 degC", "did you mean glycerol"), ("glyzerol 85 %, 25 degC", "did you mean glycerol"),
    ("carbon dioxide, 20 degC", "no liquid at atmospheric pressure"),
]  # fmt: skip


@pytest.mark.slow
def test_viscosities_by_name():
    """Text stays as it was given, numbers are close to handbooks', and what no source has is refused with the range."""
    pytest.importorskip("CoolProp")
    scene = Scene.load("granulation")
    for text, expected in NAMED:
        named = scene.with_entries({"liquid.viscosity": text})
        assert named.liquid.viscosity == pytest.approx(expected, rel=0.01)
        assert Scene.from_toml(named.to_toml()) == named
        assert text in named.to_toml()
        assert any(text in line and "Pa s" in line for line in named.assumed)
    for text, says in UNNAMED:
        with pytest.raises(InputError, match=says) as caught:
            scene.with_entries({"liquid.viscosity": text})
        assert caught.value.field == "liquid.viscosity"
    with pytest.warns(ModelWarning, match="they differ by 11%"):
        cold = collide(scene.with_entries({"liquid.viscosity": "glycerol 60 %, 0 degC"}))
    assert any("0.03041" in line and "0.0272" in line for line in cold.validity)  # two sources, 11 % apart


def test_a_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "CoolProp", None)
    monkeypatch.setitem(sys.modules, "CoolProp.CoolProp", None)
    with pytest.raises(InputError, match=r"pip install 'wetdoublet\[liquids\]'"):
        Scene.load("granulation").with_entries({"liquid.viscosity": "glycerol 83 %, 25 degC"})


# ---- the contact angle of each partner


def test_the_common_angle_has_the_mean_cosine():
    for first in np.linspace(0, math.pi / 2, 9).tolist():
        assert common_angle(first, first) == first
        for second in np.linspace(0, math.pi / 2, 9).tolist():
            mean = (math.cos(first) + math.cos(second)) / 2
            assert math.cos(common_angle(first, second)) == pytest.approx(mean, abs=1e-15)


@pytest.mark.parametrize("partner", [{"partner.radius": "100 um", "partner.mass": "1.04e-5 g"}, {"partner.wall": True}])
def test_contact_angles_of_both(partner: dict[str, object]):
    """Equal angles are one angle to the bit, exchanged ones change nothing, and a drier partner is held less."""
    scene = Scene.load("granulation").with_entries({**partner, "bridge.contact_angle": "40 deg"})

    def at(sphere: str, other: str) -> float:
        return collide(
            scene.with_entries({"bridge.contact_angle": sphere, "partner.contact_angle": other}), stokes=0.1
        ).restitution

    assert at("40 deg", "40 deg") == collide(scene, stokes=0.1).restitution
    assert at("10 deg", "40 deg") == at("40 deg", "10 deg") != at("40 deg", "40 deg")
