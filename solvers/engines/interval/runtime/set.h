#pragma once
/* Sets of states {z + C rho + Q r}: rho are the deviations of the parameters, Q is nearly orthogonal (Lohner). */
#include "model.h"

enum { COLUMNS = PARAMETERS ? PARAMETERS : 1 };

typedef struct {
    double z[STATES], parameter[STATES][COLUMNS], q[STATES][STATES];
    iv r[STATES];
} set;

typedef struct {
    constants box, centre; /* over all parameters with derivatives, and at their middle */
    dual level[LEVELS];
    iv level_centre[LEVELS], rho[COLUMNS];
} problem;

/* Each value narrowed by the mean value theorem. */
static void narrow(const problem *p, dual *box, const dual *centre, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        iv sum = centre[i].v;
        EACH_DIRECTION(j, box[i].mask) sum = iv_add(sum, iv_mul(box[i].d[j], p->rho[j - STATES]));
        if (iv_finite(sum))
            box[i].v = iv_meet(box[i].v, sum);
    }
}

/* Which forces act: that of the film, and the tangential one, in part across an edge that is only enclosed. */
typedef struct {
    int film;
    iv shear;
} region;

static void enter_region(problem *p, region r)
{
    constants *each[2] = {&p->box, &p->centre};
    dual centre[LEVELS];
    for (int i = 0; i < 2; i++) {
        each[i]->film = d_value(iv_point(r.film));
        each[i]->shear = d_value(r.shear);
        prepare(each[i]);
    }
    if (PARAMETERS)
        narrow(p, (dual *)&p->box, (const dual *)&p->centre, sizeof(constants)/sizeof(dual));
    levels(&p->box, p->level);
    levels(&p->centre, centre);
    narrow(p, p->level, centre, LEVELS);
    for (int i = 0; i < LEVELS; i++)
        p->level_centre[i] = centre[i].v;
}

static void hull_of(const problem *p, const set *s, iv *x)
{
    for (int i = 0; i < STATES; i++) {
        iv sum = iv_point(s->z[i]);
        for (int j = 0; j < PARAMETERS; j++)
            sum = iv_add(sum, iv_mul(iv_point(s->parameter[i][j]), p->rho[j]));
        for (int j = 0; j < STATES; j++)
            sum = iv_add(sum, iv_mul(iv_point(s->q[i][j]), s->r[j]));
        x[i] = sum;
    }
}

/* A box as a set. */
static void set_of(const iv *x, set *s)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < STATES; i++) {
        s->z[i] = iv_middle(x[i]);
        s->q[i][i] = 1.0;
        s->r[i] = iv_sub(x[i], iv_point(s->z[i]));
    }
}

static double dot(const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < STATES; i++)
        sum += a[i]*b[i];
    return sum;
}

/* An approximately orthogonal matrix whose first columns span the longest ones of `a`, a column each in q[.]. */
static void orthogonal(double a[STATES][STATES], const iv *r, double q[STATES][STATES])
{
    int used[STATES] = {0};
    for (int n = 0; n < STATES; n++) {
        int longest = -1;
        double most = -1.0;
        for (int j = 0; j < STATES; j++) {
            double length = dot(a[j], a[j])*iv_magnitude(r[j])*iv_magnitude(r[j]);
            if (!used[j] && (length > most || longest < 0)) {
                most = length;
                longest = j;
            }
        }
        used[longest] = 1;
        double v[STATES], before = sqrt(dot(a[longest], a[longest]));
        memcpy(v, a[longest], sizeof v);
        for (int axis = -1; axis < STATES; axis++) { /* in place of a dependent column any direction */
            if (axis >= 0) {
                memset(v, 0, sizeof v);
                v[axis] = before = 1.0;
            }
            for (int twice = 0; twice < 2; twice++)
                for (int b = 0; b < n; b++) {
                    double part = dot(v, q[b]);
                    for (int i = 0; i < STATES; i++)
                        v[i] -= part*q[b][i];
                }
            if (sqrt(dot(v, v)) > (axis < 0 ? 1e-12 : 0.3)*before && before > 1e-290)
                break;
        }
        double length = sqrt(dot(v, v));
        for (int i = 0; i < STATES; i++)
            q[n][i] = v[i]/length;
    }
}

/* The set's image under a map: `at` of the centre, `by` its derivatives over the set. False if it is lost. */
static int map_set(const problem *p, set *s, const iv *at, iv by[STATES][DIRECTIONS])
{
    set next;
    iv columns[STATES][STATES], rest[STATES];
    double middles[STATES][STATES], q[STATES][STATES], worst = 0.0;
    for (int i = 0; i < STATES; i++) {
        next.z[i] = iv_middle(at[i]);
        rest[i] = iv_sub(at[i], iv_point(next.z[i]));
        for (int j = 0; j < PARAMETERS; j++) {
            iv sum = by[i][STATES + j];
            for (int l = 0; l < STATES; l++)
                sum = iv_add(sum, iv_mul(by[i][l], iv_point(s->parameter[l][j])));
            next.parameter[i][j] = iv_middle(sum);
            rest[i] = iv_add(rest[i], iv_mul(iv_sub(sum, iv_point(next.parameter[i][j])), p->rho[j]));
        }
        for (int j = 0; j < STATES; j++) {
            iv sum = iv_point(0.0);
            for (int l = 0; l < STATES; l++)
                sum = iv_add(sum, iv_mul(by[i][l], iv_point(s->q[l][j])));
            columns[i][j] = sum;
            middles[j][i] = iv_middle(sum);
        }
        if (!iv_finite(rest[i]))
            return 0;
    }
    orthogonal(middles, s->r, q);
    for (int i = 0; i < STATES; i++) { /* the rows of Q^T Q - 1 */
        double row = 0.0;
        for (int j = 0; j < STATES; j++) {
            iv sum = iv_point(i == j ? -1.0 : 0.0);
            for (int l = 0; l < STATES; l++)
                sum = iv_add(sum, iv_mul(iv_point(q[i][l]), iv_point(q[j][l])));
            row += iv_magnitude(sum);
        }
        worst = larger(worst, row);
    }
    if (!(worst < 1e-3))
        return 0;
    /* |Q^-1 - Q^T| <= worst/(1 - worst) |Q^T|, whose rows sum to less than STATES */
    const iv slack = iv_ball(2.0*worst*STATES);
    for (int i = 0; i < STATES; i++) {
        iv sum = iv_point(0.0);
        for (int j = 0; j < STATES; j++) {
            iv column = iv_point(0.0);
            for (int l = 0; l < STATES; l++)
                column = iv_add(column, iv_mul(iv_add(iv_point(q[i][l]), slack), columns[l][j]));
            sum = iv_add(sum, iv_mul(column, s->r[j]));
            sum = iv_add(sum, iv_mul(iv_add(iv_point(q[i][j]), slack), rest[j]));
            next.q[j][i] = q[i][j];
        }
        next.r[i] = sum;
        if (!iv_finite(sum))
            return 0;
    }
    *s = next;
    return 1;
}
