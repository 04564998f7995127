"""Sets that are moved along their trajectories onto a plane: samples that Runge and Kutta move there lie in them."""

import ctypes

import numpy as np
import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.interval.build import FLAGS, engine, source
from wetdoublet.solvers.engines.interval.inputs import Inputs
from wetdoublet.solvers.engines.machine import here
from wetdoublet.solvers.host.compiler import compiler, library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.model.model import select_model

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.slow]

# A walk as `prove` takes it; after each call of `straighten` samples of the set before it are moved, in plain doubles.
SAMPLED = r"""
#include <stdlib.h>
typedef struct { const double *quantities; const int *columns; proof *w; double *found; } walk;

static double unit(void) { return rand()/(double)RAND_MAX; }

static void rates(proof *w, const constants *c, const double *y, double *f)
{
    problem p = w->p;
    iv x[STATES], rate[STATES];
    p.box = *c;
    for (int i = 0; i < STATES; i++)
        x[i] = iv_point(y[i]);
    field(&p, &w->rest, x, rate, NULL);
    for (int i = 0; i < STATES; i++)
        f[i] = iv_middle(rate[i]);
}

static void runge_kutta(proof *w, const constants *c, double *y, double h)
{
    double k[4][STATES], there[STATES];
    const double at[4] = {0.0, 0.5, 0.5, 1.0};
    for (int n = 0; n < 4; n++) {
        for (int i = 0; i < STATES; i++)
            there[i] = y[i] + (n ? h*at[n]*k[n - 1][i] : 0.0);
        rates(w, c, there, k[n]);
    }
    for (int i = 0; i < STATES; i++)
        y[i] += h/6.0*(k[0][i] + 2.0*k[1][i] + 2.0*k[2][i] + k[3][i]);
}

/* How far a sample of `before`, moved to the plane, lies outside of the set, over its width. */
static double outside(const walk *g, const set *before)
{
    proof *w = g->w;
    double rho[COLUMNS], y[STATES], f[STATES], plane[STATES] = {0.0}, worst = 0.0;
    dual q[QUANTITIES];
    constants c = w->p.box;
    for (int i = 0; i < QUANTITIES; i++) {
        const double low = g->quantities[2*i], high = g->quantities[2*i + 1];
        const double value = low < high ? low + unit()*(high - low) : low;
        q[i] = d_value(iv_point(value));
        if (g->columns[i] >= 0)
            rho[g->columns[i]] = value - iv_middle(iv_of(low, high));
    }
    scale(&c, q);
    c.film = d_value(iv_point(w->here.film));
    c.shear = d_value(w->here.shear);
    prepare(&c);
    memcpy(y, before->z, sizeof y);
    for (int j = 0; j < STATES; j++) {
        const double e = iv_lo(before->r[j]) + unit()*iv_width(before->r[j]);
        for (int i = 0; i < STATES; i++)
            y[i] += before->q[i][j]*e + (j < PARAMETERS ? before->parameter[i][j]*rho[j] : 0.0);
    }
    rates(w, &w->p.centre, before->z, f);
    plane[GAP] = before->z[NORMAL_VELOCITY];
    plane[NORMAL_VELOCITY] = f[NORMAL_VELOCITY] > 0.0 ? 0.5*before->z[GAP] : -0.5*before->z[GAP];
    for (int pass = 0; pass < 6; pass++) { /* Newton's method; its first step in forty */
        double off = 0.0, along = 0.0;
        rates(w, &c, y, f);
        for (int i = 0; i < STATES; i++) {
            off += plane[i]*(y[i] - before->z[i]);
            along += plane[i]*f[i];
        }
        for (int n = 0, count = pass ? 1 : 40; n < count; n++)
            runge_kutta(w, &c, y, -off/along/count);
    }
    for (int j = 0; j < STATES; j++) {
        double r = 0.0;
        for (int i = 0; i < STATES; i++) {
            double away = y[i] - w->s.z[i];
            for (int l = 0; l < PARAMETERS; l++)
                away -= w->s.parameter[i][l]*rho[l];
            r += w->s.q[i][j]*away;
        }
        worst = larger(worst, larger(iv_lo(w->s.r[j]) - r, r - iv_hi(w->s.r[j]))/(iv_width(w->s.r[j]) + 1e-12));
    }
    return worst;
}

static void run_walk(void *argument)
{
    const walk *g = argument;
    proof *w = g->w;
    const options o = {12, 200, 0, 1e-10, 0.5, 0.01, 0};
    double width = 0.0;
    iv x[STATES];
    set_up(w, g->quantities, g->columns);
    for (int going = begin(w, &o); going; w->steps++) {
        const set before = w->s;
        if (w->rebounds)
            straighten(w);
        if (memcmp(&before, &w->s, sizeof before))
            for (int n = 0; n < 12; n++, g->found[0]++)
                g->found[1] = larger(g->found[1], outside(g, &before));
        hull_of(&w->p, &w->s, x);
        for (int i = 0; i < STATES; i++)
            width = larger(width, iv_width(x[i]));
        going = width < 0.5 && w->steps < 150 && step(w, &o, x, width);
    }
}

EXPORTED void walked(const double *quantities, const int *columns, void *room, double *found)
{
    walk g = {quantities, columns, room, found};
    rounded(run_walk, &g);
}
"""


def sampled(change: tuple[str, str], width: float) -> tuple[float, float]:
    """Number of samples of boxes of pairs that fall back or barely separate, and the farthest outside, in widths."""
    scene = Scene.load("lactose-pvp").with_impact(stokes=7.3, angle=1.0)
    key = select_model(scene, True, fold=True)
    text, names = source(key, False, 2), engine(key, False, 2).quantities
    assert text.count(change[0]) == 1
    built = loaded(library(text.replace(*change) + SAMPLED, (*here()[0].flags, *FLAGS)), ctypes.CDLL)
    assert built.interval_start()
    built.interval_room.restype = ctypes.c_size_t
    count, worst = 0.0, 0.0
    columns = np.array([("stokes", "angle").index(n) if n in ("stokes", "angle") else -1 for n in names], np.int32)
    for stokes in (5.0, 7.1, 7.3, 7.33):
        ranges = Inputs.of(scene.with_impact(stokes=stokes)).ranges
        ranges = {
            **ranges,
            **{n: (ranges[n][0] * (1 - width), ranges[n][0] * (1 + width)) for n in ("stokes", "angle")},
        }
        quantities = np.array([ranges.get(n, (np.nan, np.nan)) for n in names])
        room, found = ctypes.create_string_buffer(built.interval_room() + 64), np.zeros(2)
        place = -(-ctypes.addressof(room) // 64) * 64
        pointers = (quantities.ctypes.data, columns.ctypes.data, place, found.ctypes.data)
        built.walked(*map(ctypes.c_void_p, pointers))
        count, worst = count + found[0], max(worst, found[1])
    return count, worst


BY = "iv_sub(iv_point(i == j), iv_mul(part, g.d[j]))"


@pytest.mark.parametrize("width", [1e-4, 1e-3])
def test_samples_lie_in_the_set_on_the_plane(width: float) -> None:
    """With parameters and remainders at random, from before a rebound's turn to behind it."""
    count, worst = sampled((BY, BY), width)
    assert count > 500
    assert worst < 1e-3  # of the width: roundings of the samples


@pytest.mark.parametrize("part", ["0.9", "1.1"])
def test_a_set_that_is_moved_by_another_part_is_noticed(part: str) -> None:
    """Too short or too far by a tenth."""
    assert sampled((BY, f"iv_sub(iv_point(i == j), iv_mul(iv_point({part}), iv_mul(part, g.d[j])))"), 1e-3)[1] > 1e-2
