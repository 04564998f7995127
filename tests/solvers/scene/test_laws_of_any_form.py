"""Laws of one's own of any form: exponents, arms, power laws and kinks, by every engine, with their derivatives."""

import math
from pathlib import Path

import pytest
from wetdoublet.solvers import InputError, Scene, collide

from ...helpers.judged_models import compared

pytestmark = pytest.mark.slow
HEAD = "from wetdoublet.derive.user import *\n"
SHARE = (
    'share = quantity("arm_share", unit="1", default="0.5", bounds="0 to 1")\n'
    'law("arm", "mine", lever=2*a + share*x/2, accept=("angular momentum",))'
)


def scene(folder: Path, body: str, preset: str = "granulation", **entries: str) -> Scene:
    """A preset with a model of these lines."""
    path = folder / "mine.py"
    path.write_text(HEAD + body)
    found = Scene.load(preset)
    if 'law("attraction"' in body:
        found = found.with_entries({"attraction.hamaker": "1e-11 J"})
    return found.with_model(path).with_entries({name.replace("__", "."): value for name, value in entries.items()})


def by_kernel(given: Scene, **impact: object) -> float:
    """The restitution by the kernel."""
    found = collide(given, rtol=1e-11, engine="taylor", ledger=False, **impact)
    assert found.engine == "taylor"
    return float(found.restitution)


def test_an_arm_with_a_quantity(tmp_path: Path):
    """Half of the way from the surface to mid-gap, as a number in the file or as a quantity."""
    number = scene(tmp_path, 'law("arm", "mine", lever=2*a + x/4, accept=("angular momentum",))')
    found = collide(number, rtol=1e-11)
    assert (found.restitution, found.engine) == (pytest.approx(0.4982, abs=5e-5), "taylor")
    shared = scene(tmp_path, SHARE)
    assert by_kernel(shared) == pytest.approx(found.restitution, rel=1e-9)
    midgap = shared.with_entries({"custom.arm_share": 1.0})
    assert by_kernel(midgap) == pytest.approx(by_kernel(Scene.load("granulation")), rel=1e-9)


FILM = 'law("film", "mine", resistance=6*pi*mu*a**2*u/x*(1 - x/x0)**2*'
KINKED = "1 + Max(Abs(u/v0 + 0.4) - 0.2, 0) + (Abs(u)/v0)**0.7"
ARC = "acos(1 - 2/(1 + x/x0)) + atan(x0/x)/4"  # with the angle that a cap of liquid takes
DEPTH = 'depth = quantity("depth", unit="1", default="0.3", bounds=">= 0")\n'
NODES = "sum(sqrt(1 + (1 + k*depth)*x/x0)*exp(-k*depth*x/x0) for k in range(1, 8))"  # constants that differ by node


STEP = "(Rational(5, 4) + tanh(u/(v0/1000))/4)"  # a thousand times steeper than the speeds vary: no exp overflows
GAUSSIAN = f"{FILM}(Rational(5, 4) - exp(-((50*u/v0)**2))/4))"
BENT = "3*mu*a*(-u)/x**2*(1.95 + Min(x/x0, 0.926))"
ARCS = "(acos(x/x0) + asin(x/x0/2) + (2 + atan(5*u/v0))/4)"
CAPPED = "force=Min(1/gap**2, 100), potential=-Piecewise((20 - 100*gap, gap < Rational(1, 10)), (1/gap, True))"


@pytest.mark.parametrize(
    ("body", "preset"),
    [
        # kinks met again on opening, elsewhere
        (f'{FILM}({KINKED}))\nlaw("bridge", "mine", force=R*sigma*({ARC}))', "granulation"),
        # the criterion is met behind the kink
        (f'{DEPTH}{FILM}{NODES})\nlaw("glass", "mine", pressure={BENT})', "granulation"),
        # kinks that no force calls, and a polynomial of degree 2500 to sympy
        (f'{GAUSSIAN}\nlaw("attraction", "capped", {CAPPED})', "granulation-dry-bridge"),
        (f'{FILM}{STEP}*{ARCS})\nlaw("bridge", "mine", force=pi*R*sigma*asin(Min(1, x0/x/2)))', "granulation"),
    ],
    ids=["kinks and arcs", "nodes and pressure", "exponential and potential", "steep, arcs, one at its bound"],
)
def test_all_engines_agree_and_have_the_derivatives(body: str, preset: str, tmp_path: Path):
    """A potential with kinks, a step by tanh, a pressure with a kink, an arccosine at the end of its domain."""
    verdict, how = compared(scene(tmp_path, body, preset), {"stokes": 0.1, "angle": "60 deg"})
    assert verdict == "right", how


def test_a_kink_of_the_pressure_is_no_glass_transition(tmp_path: Path):
    """The law is 1.95 times the library's: pairs pass the kinks at 0.926 x0 before they meet the criterion, or none."""
    own = scene(tmp_path, 'law("glass", "mine", pressure=3*mu*a*(-u)/x**2*(1.95 + Min(Max(u/v0 - 1, 0), x/x0, 0.926)))')
    library = Scene.load("granulation").with_entries({"liquid.glass_transition_pressure": 20e6 / 1.95})
    for stokes, angle in ((0.07, "34 deg"), (0.0316, "15 deg")):
        expected = collide(library, stokes=stokes, angle=angle, rtol=1e-11, ledger=False)
        for engine in ("taylor", "rosenbrock"):
            found = collide(own, stokes=stokes, angle=angle, rtol=1e-11, engine=engine, ledger=False)
            assert (found.outcome, found.engine) == (expected.outcome, engine)
            assert found.restitution == pytest.approx(expected.restitution, rel=1e-8)


@pytest.mark.parametrize(
    "resistance",
    ["Piecewise((6*pi*mu*a**2*u/x*(1 - x/x0)**2, u < 0), (0, True))", "6*pi*mu*a**2*u/x*(1 - x/x0)**2*(1 + (u/v0)**2)"],
    ids=["while closing", "faster, more"],
)
def test_a_film_alone_stops_head_on_what_its_momentum_does_not_prove(resistance: str, tmp_path: Path):
    """Where nothing else acts, what a film that depends on the speed has stopped is a stick: where, by quadrature."""
    own = scene(tmp_path, f'law("film", "mine", resistance={resistance})', "granulation-dry-bridge")
    found = collide(own, stokes=0.02, angle=0, trajectory=True)
    assert (found.outcome, found.certified) == ("stick", False)
    assert found.steps < 200
    assert "decided, not proved: the film has stopped it" in str(found)
    taken = 0.02 * (1.0 if "Piecewise" in resistance else math.pi / 4)  # St int dw/(1 + w^2), as the film takes it
    gap = float(found.trajectory.gap[-1]) / dict(own.si)["liquid.film_thickness"]
    assert -math.log(gap) - 2 * (1 - gap) + (1 - gap**2) / 2 == pytest.approx(taken, rel=1e-6)


ENDS = (
    'cut = quantity("cut", unit="m", default="12 um")\n'
    'law("bridge", "ending", force=4*pi*a*sigma*Piecewise((1, x < cut), (0, True)))'
)
BEADS = {"particles__diameter": "300 um", "liquid__viscosity": 0.0185, "liquid__coating_thickness": "2 um"}


def test_a_constant_force_ends_at_its_step(tmp_path: Path):
    """Beyond the film, where steps have no end: impacts at one speed differ by the work between their steps."""
    own, work = scene(tmp_path, ENDS, "glass-beads-water", **BEADS), []
    pull = 4 * math.pi * own.particles.reduced_radius * own.bridge.surface_tension
    for speed in (0.52, 0.53, 0.54, 0.55, 0.56, 0.6):
        squares = []
        for cut in ("10 um", "12 um"):
            found = collide(own.with_entries({"custom.cut": cut}), speed=speed, angle=0, engine="taylor", rtol=1e-11)
            assert (found.outcome, found.steps < 200) == ("bounce", True)
            squares.append((found.restitution * found.speed) ** 2)
        work.append(own.particles.reduced_mass * (squares[0] - squares[1]) / 2)
    assert work == pytest.approx([pull * 2e-6] * len(work), rel=1e-7)


def test_what_the_film_stops_beyond_the_step_of_a_force_sticks(tmp_path: Path):
    """Where no force is left but what rounding leaves: it stays where it has stopped, beyond the gap of the step."""
    own = scene(tmp_path, ENDS, "glass-beads-water", **BEADS | {"liquid__coating_thickness": "20 um"})
    for speed in (0.842457, 0.842466, 0.84256, 0.8428, 0.8435):
        found = collide(own, relative_speed=speed, angle=0, engine="taylor", trajectory=True)
        assert (found.outcome, found.certified, found.steps < 300) == ("stick", False, True)
        assert 12e-6 < float(found.trajectory.gap[-1]) < 20e-6


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_a_film_with_the_mark_of_an_event_head_on(engine: str, tmp_path: Path):
    """It takes Lf(q/x0)/St of the speed, times its factor, on the way to the event's gap and on the way back."""
    body = (
        'q = quantity("q", unit="m", default="4 um")\n'
        'before = event("flip", guard=x - q, where="closing", jump={u: -u})\n'
        'law("film", "mine", resistance=6*pi*mu*a**2*u/x*(1 - x/x0)**2*(before + Rational(3, 10)))'
    )
    own = scene(tmp_path, body, "granulation-dry-bridge", liquid__glass_transition_pressure="1e6 MPa")
    found = collide(own, stokes=0.2, angle=0, engine=engine)
    s = 4e-6 / own.liquid.film_thickness
    taken = math.log(1 / s) - 1.5 + 2 * s - s**2 / 2
    assert [event.kind for event in found.events] == ["flip", "rupture"]
    assert found.restitution == pytest.approx(1 - (1.3 + 0.3) * taken / 0.2, rel=1e-8)


def test_what_a_law_reads_and_the_scene_has_not_is_named(tmp_path: Path):
    """An attraction that reads the surface tension, where there is no bridge."""
    own = scene(tmp_path, 'law("attraction", "mine", force=pi*R*sigma*x0/(x + x0))', "granulation-dry-bridge")
    with pytest.raises(InputError, match=r"bridge.surface_tension: missing"):
        collide(own)


@pytest.mark.parametrize("kink", ["2 + sin(0.355 - 1.67)", "1.15"], ids=["a long number", "within the jump"])
def test_a_largest_of_what_jumps_is_passed(kink: str, tmp_path: Path):
    """At 1.05 x0 the second jumps from 1.05 to 1.27; the trajectory is that of the branches, written out."""
    least, jumps = f"({kink})", "Piecewise(({}, x < 1.05*x0), ({}, True))"
    forms = (
        f"Max({least}, {jumps.format('x/x0', 'x/x0 + 0.22')})",
        jumps.format(f"Piecewise(({least}, x/x0 < {least}), (x/x0, True))", "x/x0 + 0.22"),
    )
    laws = (f'law("attraction", "mine", force=(x0/x)**2*({form}))' for form in forms)
    found, expected = (
        collide(scene(tmp_path, law), stokes=0.215, angle="24 deg", rtol=1e-10, engine=engine)
        for law, engine in zip(laws, ("taylor", "cvodes"), strict=True)
    )
    assert found.outcome == expected.outcome != "stick"
    assert found.steps < 200
    assert found.restitution == pytest.approx(expected.restitution, rel=1e-9)


def test_a_kink_may_lie_at_a_multiple_of_the_film_thickness(tmp_path: Path):
    """The forms of a law are not compared on its kinks, where it has no slope."""
    body = 'kink = quantity("kink", unit="1", default="0.9")\n'
    body += 'law("film", "mine", resistance=6*pi*mu*a**2*u/x*(1 - x/x0)**2*(1 + Abs(x/x0 - kink)))'
    assert collide(scene(tmp_path, body), stokes=0.1, angle=0, ledger=False).outcome == "stick"
