"""The enclosing engine's own arithmetic against exact rationals and 200 digits, with mutants of it; what it refuses."""

import ctypes
import platform
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, prove
from wetdoublet.solvers.engines.interval.build import FLAGS, RUNTIME, Why, engine, source
from wetdoublet.solvers.engines.interval.call import BOX, enclose
from wetdoublet.solvers.engines.interval.inputs import Inputs
from wetdoublet.solvers.engines.machine import own_sets
from wetdoublet.solvers.host.compiler import compiler, library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.model.model import select_model

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")

HARNESS = """
__attribute__((visibility("default"))) void operate(int which, int n, const double *a, double *r)
{
    int mode = fegetround();
    fesetround(FE_UPWARD);
    set_tables();
    for (int i = 0; i < n; i++) {
        iv x = iv_of(a[4*i], a[4*i + 1]), y = iv_of(a[4*i + 2], a[4*i + 3]), z = x, other;
        switch (which) {
        case 0: z = iv_add(x, y); break;
        case 1: z = iv_sub(x, y); break;
        case 2: z = iv_mul(x, y); break;
        case 3: z = iv_div(x, y); break;
        case 4: z = iv_square(x); break;
        case 5: z = iv_root(x); break;
        case 6: z = iv_exp(x); break;
        case 7: z = iv_log(x); break;
        case 8: iv_circular(x, &z, &other); break;
        case 9: iv_circular(x, &other, &z); break;
        }
        r[2*i] = iv_lo(z);
        r[2*i + 1] = iv_hi(z);
    }
    fesetround(mode);
}
"""
ADD, SUB, MUL, DIV, SQUARE, ROOT, EXP, LOG, SINE, COSINE = range(10)
EDGES = (0.0, 5e-324, 2.2250738585072014e-308, 1e-160, 1.0, 1 - 2**-53, 1 + 2**-52, 1e160, 1.7976931348623157e308)


def compiled(text: str) -> ctypes.CDLL:
    return loaded(library(text + HARNESS, (*own_sets()[0].flags, *FLAGS)), ctypes.CDLL)


@pytest.fixture(scope="module")
def runtime() -> str:
    return (RUNTIME / "interval.h").read_text().replace("#pragma once\n", "")


@pytest.fixture(scope="module")
def operations(runtime: str) -> ctypes.CDLL:
    return compiled(runtime)


def operands(count: int, seed: int) -> np.ndarray:
    """Pairs of intervals: of all magnitudes, points among them, and ends from the edges of the format."""
    random = np.random.default_rng(seed)
    sizes = np.ldexp(random.uniform(-1, 1, (count, 4)), random.integers(-40, 40, (count, 4)))
    edges = np.array([*EDGES, *(-np.array(EDGES))])
    some = random.random((count, 4)) < 0.2
    sizes[some] = random.choice(edges, some.sum())
    points = random.random(count) < 0.3
    sizes[points, 1], sizes[points, 3] = sizes[points, 0], sizes[points, 2]
    return np.hstack([np.sort(sizes[:, :2]), np.sort(sizes[:, 2:])])


def results(operations: ctypes.CDLL, which: int, pairs: np.ndarray) -> np.ndarray:
    given, found = np.ascontiguousarray(pairs), np.empty((len(pairs), 2))
    operations.operate(which, len(pairs), given.ctypes.data_as(ctypes.c_void_p), found.ctypes.data_as(ctypes.c_void_p))
    return found


def violations(operations: ctypes.CDLL, which: int, count: int, seed: int = 1) -> int:
    """How many results of an exact operation do not hold the exact value of every pair of ends."""
    pairs = operands(count, seed)
    found = results(operations, which, pairs)
    bad = 0
    for (a, b, c, d), (low, high) in zip(pairs.tolist(), found.tolist(), strict=True):
        for x in (a, b):
            for y in (c, d) if which < SQUARE else (0.0,):
                p, q = Fraction(x), Fraction(y)
                if which == DIV and q == 0:
                    continue
                value = p + q if which == ADD else p - q if which == SUB else p * q if which == MUL else p * p
                value = p / q if which == DIV else value
                above = low < np.inf and (low == -np.inf or Fraction(low) <= value)
                bad += not (above and high > -np.inf and (high == np.inf or value <= Fraction(high)))
    return bad


@pytest.mark.parametrize("which", [ADD, SUB, MUL, DIV, SQUARE])
def test_rational_operations_hold_the_exact_result(operations: ctypes.CDLL, which: int) -> None:
    """Sums, differences, products, quotients and squares of 2,000 random and edge operands."""
    assert violations(operations, which, 2_000) == 0


def test_infinite_ends_stay_enclosed(operations: ctypes.CDLL) -> None:
    """Unbounded intervals give unbounded ones, zero times the line holds zero, and division by zero is the line."""
    line = [-np.inf, np.inf]
    assert results(operations, MUL, np.array([[0.0, 1.0, 1.0, np.inf]])).tolist() == [[0.0, np.inf]]
    (low, high) = results(operations, MUL, np.array([[0.0, 0.0, *line]]))[0]
    assert low <= 0 <= high
    assert results(operations, DIV, np.array([[1.0, 2.0, -1.0, 1.0]])).tolist() == [line]
    assert results(operations, ADD, np.array([[1.0, np.inf, -np.inf, 0.0]])).tolist() == [line]
    low, high = results(operations, LOG, np.array([[np.inf] * 4]))[0]
    assert 709 < low < high == np.inf


@pytest.mark.slow
@pytest.mark.parametrize("vectors", [True, False], ids=["as compiled here", "without vectors"])
def test_products_of_all_ends_are_the_least_that_hold_them(runtime: str, vectors: bool) -> None:
    """676 pairs of intervals with ends among 0, 1, 2 of either sign and both infinities: zero times an infinite end is
    zero, as the end is no member. An end that is no number makes the whole line.
    """
    text = runtime if vectors else runtime.replace("#if defined(__AVX__)\n    const", "#if 0\n    const")
    assert vectors or text != runtime
    ends = (-np.inf, -2.0, -1.0, 0.0, 1.0, 2.0, np.inf)
    members = [(a, b) for a in ends for b in ends if a <= b and not a == b in (np.inf, -np.inf)]
    pairs = np.array([(*x, *y) for x in members for y in members])
    assert len(pairs) == 676
    products = np.array([[p * q if p and q else 0.0 for p in (a, b) for q in (c, d)] for a, b, c, d in pairs.tolist()])
    found = results(compiled(text), MUL, pairs)
    assert (found == np.column_stack([products.min(1), products.max(1)])).all()
    unknown = results(compiled(text), MUL, np.array([[np.nan, 1.0, 1.0, 2.0], [0.0, 1.0, 0.0, np.nan]]))
    assert unknown.tolist() == [[-np.inf, np.inf]] * 2


SUMS = """
__attribute__((visibility("default"))) void sum(int n, const double *a, const double *b, double *r)
{
    int mode = fegetround();
    iv x[TERMS], y[TERMS];
    fesetround(FE_UPWARD);
    for (int i = 0; i < n; i++) {
        x[i] = iv_of(a[2*i], a[2*i + 1]);
        y[n - 1 - i] = iv_of(b[2*i], b[2*i + 1]);
    }
    iv z = products(x, y + n - 1, n);
    r[0] = iv_lo(z);
    r[1] = iv_hi(z);
    fesetround(mode);
}
"""


@pytest.mark.slow
@pytest.mark.parametrize("vectors", [True, False], ids=["as compiled here", "two ends a register"])
def test_sums_of_products_are_the_least_that_hold_them(runtime: str, vectors: bool) -> None:
    """2,000 random sums of 0 to 7 products below 1, to the rounding of 14 numbers below 8. Zero times the line is zero
    anywhere in a sum, and an end that is no number makes the whole line.
    """
    text = (RUNTIME / "series.h").read_text().replace("#pragma once\n", "").replace('#include "interval.h"\n', "")
    text = f"{runtime}enum {{ STATES = 3, PARAMETERS = 2, TERMS = 8 }};\n{text}{SUMS}"
    add = compiled(text if vectors else text.replace("#if defined(__AVX512F__)", "#if 0")).sum
    random, address = np.random.default_rng(3), lambda array: array.ctypes.data_as(ctypes.c_void_p)

    def summed(a: np.ndarray, b: np.ndarray) -> list[float]:
        found = np.empty(2)
        add(len(a), address(a), address(b), address(found))
        return found.tolist()

    rounding = 14 * Fraction(2**-50)
    for case in range(2000):
        a, b = np.sort(random.uniform(-1, 1, (2, case % 8, 2)))
        ends = [[Fraction(p) * Fraction(q) for p in x for q in y] for x, y in zip(a.tolist(), b.tolist(), strict=True)]
        low, high = (sum(map(which, ends), Fraction(0)) for which in (min, max))
        least, most = map(Fraction, summed(a, b))
        assert low - rounding <= least <= low <= high <= most <= high + rounding
    for n in range(1, 8):
        for at in range(n):
            a, b = np.zeros((2, n, 2))
            b[at] = -np.inf, np.inf
            assert summed(a, b) == [0.0, 0.0]
            b[at] = 1.0, np.nan
            assert summed(a, b) == [-np.inf, np.inf]


FUNCTIONS = {ROOT: mpmath.sqrt, EXP: mpmath.exp, LOG: mpmath.log, SINE: mpmath.sin, COSINE: mpmath.cos}


@pytest.mark.parametrize("which", FUNCTIONS)
def test_functions_hold_200_digits_and_are_narrow(operations: ctypes.CDLL, which: int) -> None:
    """Square root, exponential, logarithm, sine and cosine of 1000 points, to about 4 units of the last digit."""
    random = np.random.default_rng(which)
    x = np.exp(random.uniform(-30, 30, 1000)) if which in (ROOT, LOG) else random.uniform(-40, 40, 1000)
    x = random.uniform(-3.2, 3.2, 1000) if which in (SINE, COSINE) else x
    if which in (ROOT, LOG):
        x[:9] = [5e-324, 1e-310, 2.3e-308, 1.7e308, 1.0, 1 - 2**-53, 1 + 2**-52, 0.75, 1.5]
    if which == EXP:
        x[:8] = [0.0, 5e-324, -5e-324, 1e-17, 708.9, -699.0, -745.0, 720.0]
    found = results(operations, which, np.repeat(x[:, None], 4, axis=1))
    with mpmath.workdps(200):
        for value, (low, high) in zip(x.tolist(), found.tolist(), strict=True):
            exact = FUNCTIONS[which](mpmath.mpf(value))
            assert low <= exact <= high, value
            if abs(value) < 600 and high < 1e300:
                unit = 2e-15 if which < SINE else 2e-14
                assert high - low <= unit * max(abs(high), 1.0 if which >= LOG else 0.0) + 1e-300


MUTANTS = {
    ADD: ("return a + b; }", "fesetround(FE_TONEAREST); iv c = a + b; fesetround(FE_UPWARD); return c; }"),
    SUB: ("return a + iv_swap(b); }", "return a - b; }"),
    MUL: ("larger(-a[0]*b[1], -a[1]*b[0])", "-a[0]*b[1]"),
    SQUARE: ("(iv){-near*near, far*far}", "(iv){-(near*near), far*far}"),
    DIV: ("down = -a[1]/b[1];", "down = -(a[1]/b[1]);"),
}


@pytest.mark.slow
@pytest.mark.parametrize("mutated", [(ADD, SUB, MUL, SQUARE), (DIV,)])  # a quotient calls the product
def test_mutants_are_caught(runtime: str, mutated: tuple[int, ...]) -> None:
    """A sum rounded to nearest, ends that are not exchanged or dropped, a wrong side: containment is violated."""
    mutant = runtime.replace("#if defined(__AVX__)\n    const", "#if 0\n    const")
    for old, new in (MUTANTS[which] for which in mutated):
        assert old in mutant
        mutant = mutant.replace(old, new)
    operations = compiled(mutant)
    assert all(violations(operations, which, 3000) for which in mutated)


def test_the_rounding_mode_is_restored() -> None:
    """After a proof sums of doubles are rounded to nearest, as before."""
    assert prove("granulation", stokes=0.3, angle="20 deg").outcome == "bounce"
    assert (1.0 + 2**-54, -1.0 - 2**-54) == (1.0, -1.0)
    assert (0.1 + 0.2).hex() == "0x1.3333333333334p-2"


FLUSHED = """
#include <xmmintrin.h>
__attribute__((visibility("default"))) unsigned flush(unsigned bits)
{
    const unsigned before = _mm_getcsr();
    _mm_setcsr((before & ~0x8040u) | bits);
    return before & 0x8040u;
}
"""


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="bits of another processor")
def test_another_library_may_flush_small_numbers_to_zero() -> None:
    """Results, operands or both: the engine keeps small numbers all the same, and leaves that setting as it was; one
    that does not is refused at load.
    """
    flush = loaded(library(FLUSHED, (*own_sets()[0].flags, *FLAGS)), ctypes.CDLL).flush
    key = select_model(Scene.load("granulation"), False, fold=True)
    kept, text = engine(key, False, 0).library, source(key, False, 0).replace("fesetenv(FE_DFL_ENV)", "(void)0")
    mutant = loaded(library(text, (*own_sets()[0].flags, *FLAGS)), ctypes.CDLL)
    for bits in (0x8000, 0x40, 0x8040):
        try:
            flush(bits)
            started = kept.interval_start(), mutant.interval_start()
        finally:
            after = flush(0)
        assert (*started, after) == (1, 0, bits)
    assert mutant.interval_start() == 1


@pytest.mark.slow
def test_a_compiler_that_ignores_rounding_is_refused() -> None:
    """Code that rounds to nearest all the same fails the test at load."""
    key = select_model(Scene.load("granulation"), False, fold=True)
    text = source(key, False, 0).replace("fesetround(FE_UPWARD)", "(void)0")
    library_here = loaded(library(text, (*own_sets()[0].flags, *FLAGS)), ctypes.CDLL)
    assert library_here.interval_start() == 0
    assert engine(key, False, 0).library.interval_start() == 1


def test_a_box_across_a_boundary_is_not_proved() -> None:
    """A box that holds sticks and bounces is undecided, and says why."""
    proof = prove("granulation", stokes=0.1155, angle="5 deg", within=0.05)
    assert not proof
    assert proof.reason


def test_a_start_that_is_not_finite_is_too_wide() -> None:
    """Speeds from 0 on, over which nothing is bounded: nothing is followed, from the origin neither."""
    spinning = Scene.load("granulation").with_entries({"impact.spin": 300.0}).with_impact(stokes=0.1, angle=0.5)
    inputs = Inputs.of(spinning, {"impact.stokes": 1e-3})
    found = enclose(inputs.engine(), {**inputs.ranges, "stokes": (0.0, 0.1)}, inputs.moving, BOX)
    assert (found.outcome, found.why, found.rebounds) == (0, Why.TOO_WIDE, 0)


def test_ends_hold_the_decimals_that_are_given() -> None:
    """200 random ends with units: the exact number lies in the box, whatever its double is."""
    random, scene = np.random.default_rng(5), Scene.load("granulation").with_impact(stokes=0.3, angle=0.3)
    for unit, exact in (("mPa s", Fraction(1, 1000)), ("cP", Fraction(1, 1000)), ("lbf s/ft^2", None)):
        for _ in range(70):
            low, high = sorted(f"{digits}" for digits in random.uniform(1, 9, 2).round(3))
            box = Inputs.of(scene, {"liquid.viscosity": (f"{low} {unit}", f"{high} {unit}")}).ranges["viscosity"]
            factor = exact or Fraction("4.4482216152605") / Fraction("0.3048") ** 2
            assert Fraction(box[0]) <= Fraction(low) * factor
            assert Fraction(high) * factor <= Fraction(box[1])
            assert box[1] - box[0] <= (float(high) - float(low)) * float(factor) * (1 + 1e-11) + 1e-16


def test_corners_are_admissible_scenes() -> None:
    """Two ranges of which each is admissible: a roughness above the thinnest film, a rupture within the thickest."""
    scene = Scene.load("granulation").with_impact(stokes=0.3, angle=0.3)
    film = {"liquid.film_thickness": ("1 um", "8 um")}
    for more, entry in (
        ({"particles.roughness": ("0.2 um", "2 um")}, "particles.roughness"),
        ({"bridge.volume": (1e-7, 0.1), "liquid.film_thickness": ("1 um", "8.1 um")}, "bridge.volume"),
    ):
        with pytest.raises(InputError, match=rf"within {entry}.* corner"):
            prove(scene, within={**film, **more})


def test_a_relative_speed_is_boxed_as_it_is_given() -> None:
    """The range of the impact is of the relative speed: the normal one follows from it and the angle."""
    scene = Scene.load("granulation").with_impact(relative_speed=0.5, angle="60 deg")
    proof = prove(scene, within=1e-3)
    assert set(proof.box) == {"impact.relative_speed", "impact.angle"}
    assert "impact.relative_speed between 0.4995 and 0.5005" in str(proof)
    speeds = [v * np.cos(a) for v in proof.box["impact.relative_speed"] for a in proof.box["impact.angle"]]
    assert proof.ranges["speed"] == pytest.approx((min(speeds), max(speeds)), rel=1e-14)
    assert proof.ranges["speed"][0] <= min(speeds) < max(speeds) <= proof.ranges["speed"][1]
