"""Terms of a model file beside Lagrange's equations written out here in SI, and what follows from them exactly."""

import math
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from wetdoublet.solvers import InputError, Scene, collide, collide_many, collide_pair, pair_gradients, sensitivities
from wetdoublet.solvers.export.hybrid import equations
from wetdoublet.solvers.export.law.kernels import kernels

from ...helpers.exported_law import FOUND, Law, law_alone
from ...helpers.judged_models import judged

HEAD = "from wetdoublet.derive.user import *\n"
PULL = 'pull = quantity("pull", unit="N", default="2e-6 N")\n'
GAS = 'drag = quantity("gas", unit="kg/s", default="2e-7 kg/s", bounds=">= 0")\nforce_on("gap", -drag*u)\n'
ADDED = 'added = quantity("added_mass", unit="kg", default="8e-10 kg", bounds=">= 0")\n'
MASS = ADDED + "energy(added*u**2/2*x0/(x0 + x))\n"
TWIST = 'twist = quantity("twist", unit="N m", default="1e-10 N m", bounds="> -1")\n'
TORQUE = TWIST + 'force_on("rotation", twist)\n'
SPRING = 'stiff = quantity("stiffness", unit="N m", default="5e-9 N m")\nenergy(stiff*beta**2/2)\n'
BETWEEN = """rub = quantity("rub", unit="N m", default="3e-6 N m")
force_on("spin", rub*x0/v0*(omega - xi))
force_on("rotation", rub*x0/v0*(xi - omega))
"""
JERK = 'delay = quantity("delay", unit="s", default="2 us")\nevent("kick", guard=delay - t, jump={u: u/2})\n'
SPIN = 'heavy = quantity("heavy", unit="kg", default="8e-10 kg")\nenergy(heavy*R**2*xi**2*x/x0)\n'
# What a model file says, and energy and generalised forces of the same in the symbols of the reference below
CASES = {
    "gap": (PULL + "energy(pull*x)\n" + GAS + MASS, "-2e-6*x + 4e-10*u**2*x0/(x0 + x)", {"x": "-2e-7*u"}),
    "rotation and angle": (
        TORQUE + SPRING + BETWEEN + SPIN
        + PULL + "energy(pull*r*cos(beta + pi/3))\n" + ADDED + "energy(added*u**2/2*(1 + beta**2))",
        "8e-10*4*a**2*xi**2*x/x0 - 5e-9*beta**2/2 - 2e-6*(4*a + x)*cos(beta + pi/3) + 4e-10*u**2*(1 + beta**2)",
        {"spin": "3e-6*x0/v0*(omega - xi)", "beta": "1e-10 + 3e-6*x0/v0*(xi - omega)"},
    ),
}  # fmt: skip
FREE = """
[particles]
reduced_radius = "50 um"
reduced_mass = "5.2e-9 kg"
roughness = "0.2 um"
dry_restitution = 0.9
[liquid]
viscosity = "0.5 Pa s"
film_thickness = "8 um"
[impact]
stokes = 0.6
angle = "60 deg"
"""


def scene(folder: Path, body: str, text: str = FREE) -> Scene:
    """A scene with a model of these lines."""
    path = folder / "mine.py"
    path.write_text(HEAD + body)
    return Scene.from_toml(text).with_model(path)


def reference(given: Scene, lagrangian: str, forces: dict[str, str]) -> np.ndarray:
    """Angle, velocities u, omega, xi and time at separation: Lagrange's equations with a full matrix of inertia."""
    si = dict(given.si)
    speed, angle = given.need_impact()
    names = "x beta spin u omega xi a m mu x0 v0"
    x, beta, spin, u, omega, xi, a, m, mu, x0, v0 = sp.symbols(names)
    space = {str(symbol): symbol for symbol in (x, beta, u, omega, xi, a, x0, v0)}
    r, q, rates = 4 * a + x, (x, beta, spin), (u, omega, xi)
    energy = m * u**2 / 2 + m * r**2 * omega**2 / 2 + sp.Rational(16, 5) * m * a**2 * xi**2
    energy += sp.sympify(lagrangian, space)
    film = 6 * sp.pi * mu * a**2 * u / x * (1 - x / x0) ** 2
    shear = 8 * sp.pi * mu * a**2 * (omega - xi) * sp.log(2 * a / x)
    work = {"x": -film, "beta": -shear * r, "spin": shear * r}
    work = [work[name] + sp.sympify(forces.get(name, "0"), space) for name in ("x", "beta", "spin")]
    momenta = [energy.diff(rate) for rate in rates]
    inertia = sp.Matrix([[p.diff(rate) for rate in rates] for p in momenta])
    left = [
        force + energy.diff(at) - sum(p.diff(other) * rate for other, rate in zip(q, rates))
        for force, at, p in zip(work, q, momenta)
    ]
    values = {
        a: si["particles.reduced_radius"], m: si["particles.reduced_mass"], mu: si["liquid.viscosity"],
        x0: si["liquid.film_thickness"], v0: speed,
    }  # fmt: skip
    compiled = sp.lambdify((*q, *rates), [inertia.subs(values), sp.Matrix(left).subs(values)])

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        matrix, vector = compiled(*(y * units))
        found = np.linalg.solve(matrix, np.ravel(vector))
        return np.concatenate([y[3:] * units[3:], found]) / units * time

    film_thickness = values[x0]
    time, turning = film_thickness / speed, speed * math.tan(angle) / (4 * values[a])
    units = np.array([film_thickness, 1.0, 1.0, speed, turning, turning])

    def parts(_: float, y: np.ndarray) -> float:
        return y[0] - 1.0

    parts.terminal, parts.direction = True, 1
    first = np.array([1.0 - 1e-15, 0.0, 0.0, -1.0, 1.0, 0.0])
    found = solve_ivp(rate, (0, 1e4), first, "LSODA", events=[parts], rtol=1e-11, atol=1e-13)
    last = found.y_events[0][0] * units
    return np.array([last[1], *last[3:], found.t_events[0][0] * time])


@pytest.mark.parametrize("case", ["gap", pytest.param("rotation and angle", marks=pytest.mark.slow)])  # much sympy
def test_lagranges_equations_in_si(case: str, tmp_path: Path):
    """Angle, velocities and time at separation are those of the equations in SI; each term counts."""
    body, lagrangian, forces = CASES[case]
    given = scene(tmp_path, body)
    found = collide(given, rtol=1e-11)
    values = [
        found.rotation, found.restitution * found.speed, found.final_rotation_rate, found.final_spin,
        found.contact_time,
    ]  # fmt: skip
    assert values == pytest.approx(reference(given, lagrangian, forces), rel=1e-7)
    assert abs(found.energy.residual) < 1e-9 * found.energy.largest
    for name in given.package.quantities:
        without = collide(given.with_si({f"custom.{name}": 1e-6 * dict(given.si)[f"custom.{name}"]}), rtol=1e-11)
        assert abs(found.restitution / without.restitution - 1) > 1e-4, name


def test_a_torque_changes_the_angular_momentum_by_its_impulse(tmp_path: Path):
    """L(t) - L(0) is the torque times the time; the drift that is reported says so."""
    found = collide(scene(tmp_path, TORQUE), rtol=1e-11)
    mass, radius = found.scene.reduced_mass, found.scene.particles.reduced_radius
    first = mass * (4 * radius + 8e-6) ** 2 * found.speed * math.tan(found.angle) / (4 * radius)
    assert found.angular_momentum_drift == pytest.approx(1e-10 * found.contact_time / first, rel=1e-9)


@pytest.mark.parametrize(
    ("body", "entries", "said"),
    [
        (TORQUE, {"impact.angle": "0 deg"}, "impact.angle"),
        (TORQUE, {"partner.wall": True}, "a wall has not alone"),
        (SPRING, {"partner.radius": "150 um", "partner.density": "2500 kg/m^3"}, "a pair has not alone"),
    ],
)
def test_scenes_that_cannot_have_the_terms(body: str, entries: dict[str, object], said: str, tmp_path: Path):
    """A term that a structure has no coordinate for is refused with a sentence."""
    given = scene(tmp_path, body).with_entries(entries)
    with pytest.raises(InputError, match=said):
        collide(given)


def test_a_law_is_exported_with_terms_on_the_gap_only(tmp_path: Path):
    """The spheres of an exported law have spins of their own, of which a torque on both does not speak."""
    with pytest.raises(InputError, match="has terms on a rotation, and the spheres of an exported law have spins"):
        kernels(scene(tmp_path, TORQUE), 1e-9)
    assert len(kernels(scene(tmp_path, GAS), 1e-9)) == 3  # head-on, in a plane and in space


@pytest.mark.slow
def test_friction_presses_with_the_added_mass(tmp_path: Path):
    """A rebound that slides gives each sphere mu_f (1 + e) (m + M) u r/2 over its inertia, in a film that does nothing.

    The speed of approach u is that of energy and angular momentum.
    """
    text = FREE.replace('"0.5 Pa s"', '"1e-10 Pa s"').replace("stokes = 0.6", 'speed = "1 m/s"')
    heavy = MASS.replace("8e-10 kg", "3e-9 kg")
    found = collide(scene(tmp_path, heavy, text).with_entries({"particles.friction": 0.1}), rtol=1e-11)
    a, m, added, first, last = 50e-6, 5.2e-9, 3e-9, 4 * 50e-6 + 8e-6, 4 * 50e-6 + 0.2e-6
    pressed = m + added * 8 / 8.2
    swept = first**2 * math.tan(found.angle) / (4 * a)
    square = (m + added / 2 + m * swept**2 * (1 / first**2 - 1 / last**2)) / pressed
    impulse = 0.1 * 1.9 * pressed * math.sqrt(square)
    assert found.final_spin == pytest.approx(impulse * last / 2 / (3.2 * m * a**2), rel=1e-8)
    assert abs(found.energy.residual) < 1e-9 * found.energy.largest


@pytest.mark.slow  # sympy
def test_terms_are_in_the_functions_to_build_on(tmp_path: Path):
    """A pull changes du/dt by pull/(m v0^2/x0), and the reaction at rest, of which an added mass is no part."""
    own = scene(tmp_path, PULL + "energy(pull*x)\n" + MASS).with_entries({"particles.friction": 0.2})
    rates, friction = [], []
    for pull, added in (("1e-6 N", "0 kg"), ("2e-6 N", "0 kg"), ("2e-6 N", "8e-10 kg")):
        built = equations(own.with_entries({"custom.pull": pull, "custom.added_mass": added}))
        groups = list(built.groups.values())
        state = built.functions["start"](groups).full().ravel()
        rates.append(built.functions["rates_0"](state, groups).full()[1, 0])
        state[:2] = 0.2 / 8, 0.0
        friction.append(built.functions["dry_forces"](state, groups).full())
    assert rates[1] - rates[0] == pytest.approx(-1e-6 * 8e-6 / (5.2e-9 * own.need_impact()[0] ** 2), rel=1e-9)
    assert friction[1][0, 0] != 0
    assert friction[1] == pytest.approx(friction[2], rel=1e-12)


SLOWLY = (
    FREE.replace("stokes = 0.6", "stokes = 0.04508800377045136")
    .replace("60 deg", "54.77804861980701 deg")
    .replace("0.5 Pa s", "2 Pa s")
    + """
[bridge]
surface_tension = "25 mN/m"
volume = 0.1
contact_angle = "0 deg"
"""
)
EVENTS = """reach = quantity("reach", unit="m", default="9 um")
delay = quantity("delay", unit="s", default="12 us")
event("snap", guard=reach - x, where="opening", jump={u: 0.8*u})
event("kick", guard=delay - t, jump={u: 0.9*u})
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "own", "text", "entries"),
    [
        (CASES["gap"][0], "added_mass", FREE, {"partner.radius": "150 um", "partner.density": "2500 kg/m^3"}),
        (EVENTS, "reach", SLOWLY, {}),
    ],
    ids=["terms of a pair", "events"],
)
def test_what_acts_on_the_gap_acts_in_space(body: str, own: str, text: str, entries: dict[str, object], tmp_path: Path):
    """A plane turned in space is the plane, derivatives included; with spins in any direction the ledger closes.

    A twist that changes nothing else leaves the motion to the equations in space.
    """
    given = scene(tmp_path, body, text).with_entries(entries)
    turned, _ = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))
    planar, (speed, angle) = collide(given, rtol=1e-10), given.need_impact()
    radii = 100e-6 + (150e-6 if given.partner else 100e-6)
    sideways = speed * math.tan(angle) * (radii + given.liquid.film_thickness) / radii
    pair = turned[:, 0], [turned @ [speed, sideways, 0.0], [0.0] * 3]
    twist = np.tile(1e-7 * speed / 50e-6 * turned[:, 0], (2, 1))
    found = collide_pair(given, *pair, twist, rtol=1e-10)
    assert float(found.restitution) == pytest.approx(planar.restitution, rel=1e-8)
    assert float(found.time) == pytest.approx(planar.contact_time, rel=1e-8)
    names = ["liquid.viscosity", f"custom.{own}"]
    slopes = pair_gradients(given, *pair, twist, wrt=names).d_restitution.values
    assert slopes == pytest.approx([*sensitivities(given, wrt=names).gradient["restitution"].values()], rel=1e-5)
    spins = np.random.default_rng(2).normal(size=(2, 3)) * 0.1 * speed / 50e-6
    taken = "energy.own_events" if own == "reach" else "energy.own_terms"
    for engine in ("taylor", "rosenbrock"):
        spun = collide_pair(given.with_entries({"particles.friction": 0.2}), *pair, spins, ledger=True, engine=engine)
        assert spun.outcome >= 0
        assert abs(float(spun["energy.residual"])) < 1e-3 * abs(float(spun[taken]))


def test_a_stick_is_proved_with_a_potential_and_a_drag(tmp_path: Path):
    """A pull without a bridge holds a doublet that the library lets part, by the barrier of the energy."""
    text = FREE.replace("stokes = 0.6", "stokes = 0.02").replace("60 deg", "10 deg")
    held = collide(scene(tmp_path, PULL.replace("2e-6 N", "1e-4 N") + "energy(pull*x)\n", text), rtol=1e-10)
    assert (held.outcome, held.certified) == ("stick", True)


@pytest.mark.slow
def test_what_a_drag_has_stopped_at_rest_sticks(tmp_path: Path):
    """A drag ends the rotation beside a bridge with a kink: when no force changes any more, the doublet sticks."""
    (tmp_path / "mine.py").write_text(
        HEAD + 'drag = quantity("drag", unit="kg/s", default="2e-6 kg/s")\nforce_on("rotation", -drag*R**2*omega)\n'
        'law("bridge", "mine", force=3*pi*R*sigma*exp(-Abs(x/x0 - Rational(7, 10))))\n'
    )
    found = collide(Scene.load("granulation", model=tmp_path / "mine.py"), stokes=0.036, angle="53 deg")
    assert (found.outcome, found.certified) == ("stick", False)
    assert abs(found.energy.residual) < 1e-9 * found.energy.largest


@pytest.mark.slow
def test_head_on_a_spring_of_the_rotation_is_never_strained(tmp_path: Path):
    """Outcomes and restitution are those without it, and what comes to rest sticks: nothing moves any more."""
    given = Scene.load("granulation").with_entries({"liquid.glass_transition_pressure": "2 GPa"})
    path = tmp_path / "mine.py"
    path.write_text(HEAD + SPRING)
    for stokes, outcome in ((0.022, "stick"), (3.0, "bounce")):
        plain, sprung = (collide(each, stokes=stokes, angle=0, rtol=1e-11) for each in (given, given.with_model(path)))
        assert plain.outcome == sprung.outcome == outcome
        assert sprung.restitution == pytest.approx(plain.restitution, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_chatter_takes_what_moves_alone(engine: str, tmp_path: Path):
    """A doublet with an added mass, half of whose velocity an event takes before, comes to rest at a height.

    Its potential stays, and the ledger closes.
    """
    (tmp_path / "mine.py").write_text(HEAD + PULL + "energy(pull*x)\n" + MASS + JERK)
    given = Scene.load("granulation", model=tmp_path / "mine.py").with_entries(
        {"particles.roughness": "4 um", "particles.dry_restitution": 0.3}
    )
    found = collide(given, stokes=0.05, angle="40 deg", engine=engine, until="10 ms")
    assert (found.events[0].kind, found.events[-1].kind) == ("kick", "rests")
    assert found.energy.own_events > 0
    assert abs(found.energy.residual) < 1e-9 * found.energy.largest


def test_a_criterion_is_a_roughness_of_its_own_name(tmp_path: Path):
    """The gap of a soft layer takes the roughness's place to the last bit, with its derivative, under its own word."""
    text = FREE.replace("stokes = 0.6", "stokes = 4")
    body = 'soft = quantity("soft", unit="m", default="3 um", bounds=">= 0")\ncriterion("layer", gap=soft)'
    own, rough = scene(tmp_path, body, text), Scene.from_toml(text.replace("0.2 um", "3 um"))
    found, library = (collide(each, rtol=1e-11) for each in (own, rough))
    assert (found.reversal, library.reversal) == ("layer", "rough")
    assert found.restitution == library.restitution
    assert "layer" in {event.kind for event in found.events}
    mine = sensitivities(own, wrt=["custom.soft", "particles.roughness"], engine="rosenbrock").gradient["restitution"]
    theirs = sensitivities(rough, wrt=["particles.roughness"], engine="rosenbrock").gradient["restitution"]
    assert mine["custom.soft"] == pytest.approx(theirs["particles.roughness"], rel=1e-9)
    assert mine["particles.roughness"] == 0.0
    assert collide(own.with_entries({"custom.soft": "0.1 um"}), rtol=1e-11).reversal == "rough"


@pytest.mark.slow
def test_a_criterion_with_a_maximum_is_differentiated_by_the_kernel(tmp_path: Path):
    """On either side of a corner of its gap, as by Rosenbrock: a layer of at most half the film."""
    body = 'soft = quantity("soft", unit="m", default="3 um")\ncriterion("layer", gap=Max(Min(soft, x0/2), x0/100))'
    thin = scene(tmp_path, body, FREE.replace("stokes = 0.6", "stokes = 4"))
    for given, layer_counts in ((thin, True), (thin.with_entries({"custom.soft": "5 um"}), False)):
        wrt = ["custom.soft", "liquid.film_thickness"]
        kernel, casadi = (
            sensitivities(given, wrt=wrt, rtol=1e-11, engine=engine).gradient["restitution"]
            for engine in ("taylor", "rosenbrock")
        )
        assert kernel == pytest.approx(casadi, rel=1e-7, abs=1e-9)
        assert (kernel["custom.soft"] != 0.0) == layer_counts


@pytest.mark.parametrize(
    ("gap", "says"), [("2*soft", "not below the film"), ("-soft", "is negative"), ("soft*v0/soft*soft/v0*3", "film")]
)
def test_a_criterion_outside_the_film_is_refused(gap: str, says: str, tmp_path: Path):
    """As a roughness is: with the criterion, its gap, and the film's thickness; at any speed and at one."""
    body = f'soft = quantity("soft", unit="m", default="5 um", bounds=">= 0")\ncriterion("layer", gap={gap})'
    with pytest.raises(InputError, match=says) as caught:
        collide(scene(tmp_path, body, FREE))
    assert caught.value.field == "criterion layer"
    assert "8e-06 m" in str(caught.value)


def test_of_many_impacts_those_with_a_criterion_outside_the_film_fail(tmp_path: Path):
    """By an entry that varies, and by the speed: the others are as by themselves."""
    body = 'soft = quantity("soft", unit="m", default="1 um")\nlag = quantity("lag", unit="s", default="1e-6 s")\n'
    own = scene(tmp_path, body + 'criterion("layer", gap=soft + lag*v0)')
    for axis in ({"speed": [1.0, 10.0]}, {"speed": 1.0, "vary": {"custom.soft": [1e-6, 9e-6]}}):
        many = collide_many(own, angle=0.5, **axis)
        assert many.outcome.values.tolist()[1] == -1
        assert str(many.reason.values[1]).startswith("criterion layer: ")
        assert float(many.restitution[0]) == pytest.approx(collide(own, speed=1.0, angle=0.5).restitution, rel=1e-9)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
@pytest.mark.parametrize(("number", "verdict"), [(0, "right"), (1, "right"), (5, "refused")])
def test_models_drawn_at_random(number: int, verdict: str, tmp_path: Path):
    """Terms, criteria, events and laws: refused with a sentence, or right by three engines, with the derivatives."""
    found, how = judged(number, tmp_path)
    assert found == verdict, how


def test_an_event_without_a_jump_creates_nothing_where_the_energy_is_negative(tmp_path: Path):
    """A pull's energy is below that at initial contact in a doublet that rests, when a time comes."""
    waits = 'delay = quantity("delay", unit="s", default="20 ms")\nevent("sets", guard=delay - t)\n'
    text = FREE.replace("stokes = 0.6", "stokes = 0.02").replace("60 deg", "10 deg")
    found = collide(scene(tmp_path, PULL.replace("2e-6", "2e-4") + "energy(pull*x)\n" + waits, text))
    assert (found.outcome, found.events[-1].kind) == ("stick", "sets")


@pytest.mark.slow
@pytest.mark.parametrize("push", [-1, 1])
def test_a_force_that_may_give_energy_acts_in_space(push: int, tmp_path: Path):
    """A constant force is a potential by another name: the same collision by each engine, or stick at rest.

    So it is by the exported law, whose forces for time steps have no terms.
    """
    text = FREE.replace("stokes = 0.6", f"stokes = {0.6 if push > 0 else 0.02}").replace("60 deg", "20 deg")
    pull = 'pull = quantity("pull", unit="N", default="1e-4 N", bounds="> -1")\n' + MASS
    force, energy = (
        scene(tmp_path, pull + body, text).with_entries({"custom.pull": push * 1e-4})
        for body in ('force_on("gap", pull)\n', "energy(-pull*x)\n")
    )
    speed, spin = force.need_impact()[0], np.random.default_rng(3).normal(size=(2, 3)) * 20
    pair = [1.0, 0.0, 0.0], [[speed, 0.2 * speed, 0.0], [0.0] * 3], spin
    given = ((force, "taylor"), (energy, "taylor"), (force, "rosenbrock"), (energy, "rosenbrock"))
    found = [collide_pair(each, *pair, engine=engine) for each, engine in given]
    assert [int(each.outcome) for each in found] == [1 if push > 0 else 0] * 4
    for each in found[1:]:
        assert each.velocities.values == pytest.approx(found[0].velocities.values, rel=1e-7, abs=1e-9 * speed)
    if push < 0:
        assert all(bool(each.certified) for each in found[::2])
    elif "gcc" in FOUND:
        law = Law(force, law_alone(force, tmp_path))
        exported = law.collide_pairs(law.pairs(pair[0], np.array([pair[1]]), np.array([spin])))
        assert f"#define {law.name.upper()}_FORCES 0" in law.header
        assert exported["restitution"].item() == pytest.approx(float(found[0].restitution), rel=1e-8)
