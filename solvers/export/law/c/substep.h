/* The motion of a contact along its line of centres, substep by substep: resistance and attraction are means over the gaps
 * that a substep passes, so that the momentum that the film takes and the work of the attractions are those between them.
 */

enum { SUBSTEPS = 2000, REBOUNDS = 8 }; /* most in a step; more rebounds are rest */
static const double WIDEST = 0.5;       /* change of the gap in a substep, over the gap */

/* A step along the line of centres: what goes on from substep to substep. */
typedef struct {
    space_held h;
    double mass, others, load; /* reduced, kg; force of all else along the line, N, without and with the centrifugal */
    double gap, velocity, work; /* work against the attractions, J */
} line;

/* (1 - exp(-z))/z, and the mean of it from 0 to z. */
static double decayed(double z)
{
    return z < 1e-5 ? 1.0 - 0.5*z : -expm1(-z)/z;
}

static double decayed_twice(double z)
{
    return z < 1e-3 ? 0.5 - z*(1.0 - 0.25*z)/6.0 : (1.0 - decayed(z))/z;
}

/* Way and velocity after a time with constant coefficients. */
static double way(const line *l, const space_response *r, double time, double *velocity)
{
    double z = r->resistance/l->mass*time, push = (l->load - r->attraction)/l->mass*time;
    *velocity = l->velocity*exp(-z) + push*decayed(z);
    return time*(l->velocity*decayed(z) + push*decayed_twice(z));
}

/* The substep of a length, with the means over its own way; false if that is too wide, or is not found. */
static int substep(const line *l, const space_response *here, double time, double *gap, double *velocity, space_response *r)
{
    double direction = l->velocity != 0.0 ? l->velocity : l->load;
    double before = l->gap, off = 0.0, tried = l->gap + way(l, here, time, velocity);
    if (!(fabs(tried - l->gap) <= WIDEST*l->gap))
        return 0;
    for (int k = 0; k < 30; k++) {
        *r = space_mean_response(&l->h, l->gap, tried, direction);
        double found = l->gap + way(l, r, time, velocity), error = found - tried;
        if (!(fabs(found - l->gap) <= WIDEST*l->gap))
            return 0;
        if (fabs(error) <= 1e-12*l->gap) {
            *gap = found;
            return 1;
        }
        double next = k == 0 || error == off ? found : tried - error*(tried - before)/(error - off);
        if (!(fabs(next - l->gap) <= WIDEST*l->gap))
            next = found;
        before = tried;
        off = error;
        tried = next;
    }
    return 0;
}

/* The time to a gap that a substep passes. */
static double time_to(const line *l, double gap, double most, space_response *r)
{
    double least = 0.0, velocity, sense = gap > l->gap ? 1.0 : -1.0;
    *r = space_mean_response(&l->h, l->gap, gap, sense);
    for (int k = 0; k < 60; k++) {
        double middle = 0.5*(least + most);
        if (sense*(l->gap + way(l, r, middle, &velocity) - gap) < 0.0)
            least = middle;
        else
            most = middle;
    }
    return most;
}

/* The target among gaps that a substep passes first; its own gap if none. */
static double passed(const line *l, double gap)
{
    const double targets[3] = {l->h.contact, l->h.film, l->h.end};
    double first = gap;
    for (int k = 0; k < 3; k++)
        if ((l->gap - targets[k])*(first - targets[k]) < 0.0)
            first = targets[k];
    return first;
}

/* Whether solids meet, or glass would, at the state or on the way from it to another; never where they open. */
static int glass_may_come(const line *l, double gap, double velocity)
{
    double least = gap < l->gap ? gap : l->gap, fastest = velocity < l->velocity ? velocity : l->velocity;
    return fastest < 0.0 && !(space_glass_clears(&l->h, least, fastest) > 0.0);
}

/* What a rebound leaves; pairs that rebound again and again rest. */
static void meet(line *l, law_pair_history *s, law_pair_force *found, int kind, int *rebounds)
{
    l->velocity = ++*rebounds > REBOUNDS ? 0.0 : space_rebounds_with(&l->h, l->velocity);
    if (s->rebound == LAW_NO_REBOUND)
        s->rebound = kind;
    found->events |= LAW_REBOUNDS;
}

