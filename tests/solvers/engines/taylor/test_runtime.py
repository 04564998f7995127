"""The kernel's own arithmetic: functions against libm, recurrences against the equations they solve, roots."""

import ctypes
import math

import numpy as np
import pytest
from wetdoublet.solvers.engines import machine
from wetdoublet.solvers.engines.taylor import source as text
from wetdoublet.solvers.engines.taylor.source import resolved
from wetdoublet.solvers.host.compiler import compiler, library
from wetdoublet.solvers.host.user_cache import loaded

ORDER = 12
pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")

HARNESS = """#include "whole_series.h"
#include "roots.h"
#define SHOW(name) void lanes_##name(const double *x, double *y) { vec a; memcpy(&a, x, sizeof a); a = vec_##name(a); \\
    memcpy(y, &a, sizeof a); }
SHOW(exp) SHOW(log) SHOW(sin) SHOW(cos) SHOW(tan) SHOW(atan)

/* f of the series a (and b), each in every lane */
void recur(int which, const double *a, const double *b, double *f, double *g)
{
    vec u[TERMS], v[TERMS], w[TERMS], z[TERMS], slope[TERMS], over;
    for (int k = 0; k < TERMS; k++) u[k] = splat(a[k]), v[k] = splat(b[k]);
    for (int k = 0; k < TERMS; k++) {
        if (which == 0) w[k] = product(u, v, k);
        if (which == 1) w[k] = square(u, k);
        if (which == 2) w[k] = quotient(u, v, w, &over, k);
        if (which == 3) w[k] = reciprocal(u, w, k);
        if (which == 4) w[k] = root(u, w, &over, k);
        if (which == 5) w[k] = exponential(u, slope, w, k);
        if (which == 6) w[k] = logarithm(u, w, slope, &over, k);
        if (which == 7) circular(u, slope, w, z, k);
        if (which == 8) w[k] = power(u, w, splat(b[0]), &over, k);
        if (which == 9) w[k] = arctangent(u, slope, v, k);
        f[k] = LANE(w[k], LANES - 1);
        g[k] = which == 7 ? LANE(z[k], LANES - 1) : 0.0;
    }
}

/* the product of two series made whole */
void whole(const double *a, const double *b, double *f)
{
    vec u[TERMS], v[TERMS], w[TERMS];
    for (int k = 0; k < TERMS; k++) u[k] = splat(a[k]), v[k] = splat(b[k]);
    EACH_TERM(w[k] = product(u, v, k);)
    for (int k = 0; k < ORDER; k++) f[k] = LANE(w[k], LANES - 1);
}

double first(const double *a, int order)
{
    double b[TERMS + 1], binomial = 1.0;
    for (int k = 0; k <= order; binomial = binomial*(order - k)/(k + 1), k++) b[k] = a[k]/binomial;
    for (int k = 1; k <= order; k++)
        for (int j = order; j >= k; j--) b[j] += b[j - 1];
    return isolated(a, order, b, 0.0, 1.0, 0);
}
"""


@pytest.fixture(scope="module")
def runtime() -> ctypes.CDLL:
    """The runtime's arithmetic as a library."""
    settings = f"#define LANES {machine.lanes()}\n#define ORDER {ORDER}\n#define TERMS {ORDER + 1}\n"
    made = loaded(library(resolved(HARNESS, {"settings.h": settings}), text.FLAGS), ctypes.CDLL)
    made.first.restype = ctypes.c_double
    return made


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


RANGES = {
    "exp": (-700.0, 700.0), "log": (-690.0, 690.0), "sin": (-50.0, 50.0), "cos": (-50.0, 50.0), "tan": (0.0, 1.57),
    "atan": (-10.0, 10.0),
}  # fmt: skip


@pytest.mark.parametrize("name", RANGES)
def test_functions_equal_libm(runtime: ctypes.CDLL, name: str):
    """Within two units in the last place of libm (of 1 for sin and cos, whose zeros are not resolved further)."""
    draw = np.random.default_rng(1)
    lanes = machine.lanes()
    x = draw.uniform(*RANGES[name], 500 * lanes)
    x = np.exp(x) if name == "log" else x
    y = np.empty_like(x)
    for first in range(0, x.size, lanes):
        getattr(runtime, f"lanes_{name}")(_pointer(x[first:]), _pointer(y[first:]))
    expected = np.array([getattr(math, name)(value) for value in x])
    unit = np.spacing(np.maximum(np.abs(expected), 1.0 if name in ("sin", "cos") else 0.0))
    assert np.max(np.abs(y - expected) / unit) <= (4.0 if name == "tan" else 2.0)  # tan divides two of them


def test_arctangent_at_its_ends(runtime: ctypes.CDLL):
    """Small arguments are returned, infinite ones give half of pi; zero keeps its sign, and NaN stays NaN."""
    lanes = machine.lanes()
    for value in (0.0, -0.0, 1e-300, -1e-9, 1e300, math.inf, -math.inf):
        x, y = np.full(lanes, value), np.zeros(lanes)
        runtime.lanes_atan(_pointer(x), _pointer(y))
        expected = math.atan(value)
        assert (y == expected).all() and (np.copysign(1.0, y) == math.copysign(1.0, expected)).all()
    x = np.full(lanes, math.nan)
    runtime.lanes_atan(_pointer(x), _pointer(x))
    assert np.isnan(x).all()


def test_log_outside_its_domain(runtime: ctypes.CDLL):
    """The logarithm of zero, of a negative number, of infinity and of NaN is NaN, never a number."""
    lanes = machine.lanes()
    for value in (0.0, -1.0, math.inf, math.nan):
        x, y = np.full(lanes, value), np.zeros(lanes)
        runtime.lanes_log(_pointer(x), _pointer(y))
        assert np.isnan(y).all()


def test_products_made_whole(runtime: ctypes.CDLL):
    """A product of series made whole is their convolution, to the rounding of its sums."""
    a, b = np.random.default_rng(3).normal(size=(2, ORDER + 1))
    made = np.zeros(ORDER)
    runtime.whole(_pointer(a), _pointer(b), _pointer(made))
    rounding = 2 * ORDER * np.finfo(float).eps * np.convolve(np.abs(a), np.abs(b))[:ORDER]
    assert (np.abs(made - np.convolve(a, b)[:ORDER]) <= rounding).all()


def _series(runtime: ctypes.CDLL, which: int, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    f, g = np.zeros(ORDER + 1), np.zeros(ORDER + 1)
    runtime.recur(which, _pointer(a), _pointer(b), _pointer(f), _pointer(g))
    return f, g


def _slope(a: np.ndarray) -> np.ndarray:
    return a[1:] * np.arange(1, a.size)


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.convolve(a, b)[: min(a.size, b.size)]


def test_recurrences_solve_their_equations(runtime: ctypes.CDLL):
    """Products by convolution; q b = a; r^2 = a; e' = a' e; a l' = a'; s' = a' c, c' = -a' s; t' = a' b; a p' = r a' p.

    The arctangent's slope b is given.
    """
    draw = np.random.default_rng(2)
    a, b = draw.uniform(-1, 1, (2, ORDER + 1)) * 0.5 ** np.arange(ORDER + 1)
    a[0], b[0] = 1.3, 0.7
    near = pytest.approx

    def of(which: int) -> np.ndarray:
        return _series(runtime, which, a, b)[0]

    assert of(0) == near(_times(a, b), abs=1e-15)
    assert of(1) == near(_times(a, a), abs=1e-15)
    assert _times(of(2), b) == near(a, abs=1e-14)
    assert _times(of(3), a) == near(np.eye(1, ORDER + 1)[0], abs=1e-14)
    assert _times(of(4), of(4)) == near(a, abs=1e-14)
    assert of(5)[0] == near(math.exp(a[0]), rel=1e-15)
    assert _slope(of(5)) == near(_times(_slope(a), of(5)), abs=1e-13)
    assert of(6)[0] == near(math.log(a[0]), rel=1e-15)
    assert _times(a[:-1], _slope(of(6))) == near(_slope(a), abs=1e-13)
    sine, cosine = _series(runtime, 7, a, b)
    assert (sine[0], cosine[0]) == near((math.sin(a[0]), math.cos(a[0])), rel=1e-15)
    assert _slope(sine) == near(_times(_slope(a), cosine), abs=1e-13)
    assert _slope(cosine) == near(-_times(_slope(a), sine), abs=1e-13)
    assert of(9)[0] == near(math.atan(a[0]), rel=1e-15)
    assert _slope(of(9)) == near(_times(_slope(a), b[:-1]), abs=1e-13)
    raised = of(8)
    assert raised[0] == near(a[0] ** b[0], rel=1e-14)
    assert _times(a[:-1], _slope(raised)) == near(b[0] * _times(_slope(a), raised[:-1]), abs=1e-13)


ROOTS = [
    ([0.5], 0.5),
    ([0.25, 0.75], 0.25),
    ([0.4, 0.4 + 1e-6], 0.4),  # a double crossing inside a step, far below any sampling
    ([1.5, -0.3], None),
    ([0.9, 0.95, 0.99], 0.9),
]


@pytest.mark.parametrize(("roots", "expected"), ROOTS)
def test_the_first_root_is_isolated(runtime: ctypes.CDLL, roots: list[float], expected: float | None):
    """The first root on (0, 1] of a polynomial with known roots and a positive factor of degree 4."""
    a = np.polynomial.polynomial.polyfromroots(roots)
    a = np.convolve(a, np.convolve([1.0, 0.2, 0.3], [2.0, -0.5, 0.4]))
    a = np.ascontiguousarray(a * np.sign(a[0]))
    found = runtime.first(_pointer(a), a.size - 1)
    # a root of two that are d apart moves by rounding over d
    tolerance = 1e-14 if len(roots) < 3 and np.ptp(roots) in (0.0, 0.5, 1.8) else 1e-9
    assert found == (2.0 if expected is None else pytest.approx(expected, abs=tolerance))


@pytest.mark.parametrize(("above", "meets"), [(1e-9, False), (-1e-9, True), (1e-13, False), (-1e-13, True)])
def test_a_graze_is_decided(runtime: ctypes.CDLL, above: float, meets: bool):
    """A minimum above zero is passed by; one below is met before it."""
    a = np.array([0.25 + above, -1.0, 1.0])  # (t - 1/2)^2 + above
    found = runtime.first(_pointer(a), 2)
    assert (found < 1.0) == meets
    if meets:
        assert found == pytest.approx(0.5 - math.sqrt(-above), rel=1e-6)


@pytest.mark.parametrize("digits", [30, 47, 60])
def test_two_roots_are_found_in_a_step_of_any_length(runtime: ctypes.CDLL, digits: int):
    """A parabola that rises, and falls again, at once after the start of a step: 1 and 2 over 2^digits."""
    scale = 2.0**digits
    a = np.array([2.0, -3.0 * scale, scale**2])
    assert runtime.first(_pointer(a), 2) == pytest.approx(1 / scale, rel=1e-12, abs=0.0)
