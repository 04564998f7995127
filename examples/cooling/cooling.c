/* A freely cooling gas of wet spheres in a periodic box, event by event, with an exported collision law.
 *
 * Between collisions spheres fly straight. Each has one event at a time: its next collision, or the next face of its cell.
 * A pair whose films touch is handed to the law, which moves both to the end of their collision; until then it is left
 * alone. Pairs that stick are rigid doublets: they are left out of further collisions, and stay where they stuck. So are
 * the few that the law leaves undecided, which are together after its largest number of steps; they are counted.
 *
 * cooling COUNT SHARE SPEED COLLISIONS > rows.csv: spheres, share of the volume, standard deviation of the velocity
 * components (m/s), collisions for each sphere at most. It ends when all have stuck. Positions, in parts of the box, go to snapshots.csv:
 * at the beginning, when each quarter has stuck, and at the end.
 */
#include "granulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COLLISION, FACE };
enum { UNDECIDED = 3, OUTCOMES = 4 }; /* beside the law's, 0 to 2 */

typedef struct {
    granulation_particle p; /* at its own time */
    double time;
    int cell, next, before; /* the list of its cell */
    int flown;              /* events that have changed it, by which older predictions are known */
    int outcome, stuck;     /* of its last collision, -1 before it; in a doublet */
} sphere;

typedef struct {
    double time;
    int kind, one, other, flown, others_flown; /* of a face, `other` is twice the axis, and 1 if it is the upper */
} event;

static granulation_material material;
static sphere *gas;
static event *heap;
static int *cells, count, side, queued, room;
static double box, width, distance, mass, inertia, now;

/* ---- the queue */

static void push(event e)
{
    int k = queued++;
    if (queued > room && !(heap = realloc(heap, sizeof *heap*(size_t)(room = 2*queued))))
        exit(1);
    for (; k > 0 && heap[(k - 1)/2].time > e.time; k = (k - 1)/2)
        heap[k] = heap[(k - 1)/2];
    heap[k] = e;
}

static event pop(void)
{
    event first = heap[0], last = heap[--queued];
    int k = 0, child;
    for (; (child = 2*k + 1) < queued; k = child) {
        if (child + 1 < queued && heap[child + 1].time < heap[child].time)
            child++;
        if (!(heap[child].time < last.time))
            break;
        heap[k] = heap[child];
    }
    heap[k] = last;
    return first;
}

/* ---- cells, at least as wide as the distance at which spheres collide */

static double image(double x)
{
    return x - box*floor(x/box + 0.5);
}

static void leave(int i)
{
    if (gas[i].before >= 0)
        gas[gas[i].before].next = gas[i].next;
    else
        cells[gas[i].cell] = gas[i].next;
    if (gas[i].next >= 0)
        gas[gas[i].next].before = gas[i].before;
}

static void enter(int i, int cell)
{
    gas[i].cell = cell;
    gas[i].before = -1;
    gas[i].next = cells[cell];
    if (cells[cell] >= 0)
        gas[cells[cell]].before = i;
    cells[cell] = i;
}

static int cell_of(const sphere *s)
{
    int found = 0;
    for (int k = 0; k < 3; k++) {
        int at = (int)floor(s->p.position[k]/width);
        found = found*side + (at < 0 ? 0 : at >= side ? side - 1 : at);
    }
    return found;
}

/* ---- what comes next */

/* The time at which two spheres collide, from when both are free on; INFINITY if they do not. */
static double meeting(const sphere *s, const sphere *o)
{
    double start = fmax(now, fmax(s->time, o->time)), b = 0.0, c = -distance*distance, v2 = 0.0, root;
    for (int k = 0; k < 3; k++) {
        double x = image(o->p.position[k] + o->p.velocity[k]*(start - o->time) - s->p.position[k]
            - s->p.velocity[k]*(start - s->time));
        double v = o->p.velocity[k] - s->p.velocity[k];
        b += x*v;
        c += x*x;
        v2 += v*v;
    }
    if (b >= 0.0)
        return INFINITY;
    if (c <= 0.0) /* within the distance already, as after a collision: at once */
        return start;
    root = b*b - v2*c;
    return root < 0.0 ? INFINITY : start + c/(sqrt(root) - b);
}

/* Finds and queues the next event of a sphere. */
static void predict(int i)
{
    sphere *s = &gas[i];
    event e = {INFINITY, FACE, i, 0, s->flown, 0};
    int at[3] = {s->cell/(side*side), s->cell/side%side, s->cell%side};
    for (int k = 0; k < 3; k++) {
        double v = s->p.velocity[k], face = (at[k] + (v > 0.0))*width;
        double time = v != 0.0 ? s->time + fmax((face - s->p.position[k])/v, 0.0) : INFINITY;
        if (time < e.time) {
            e.time = time;
            e.other = 2*k + (v > 0.0);
        }
    }
    for (int n = 0; n < 27; n++) {
        int x = (at[0] + n/9 + side - 1)%side, y = (at[1] + n/3%3 + side - 1)%side, z = (at[2] + n%3 + side - 1)%side;
        for (int j = cells[(x*side + y)*side + z]; j >= 0; j = gas[j].next) {
            double time = j == i ? INFINITY : meeting(s, &gas[j]);
            if (time < e.time) {
                event sooner = {time, COLLISION, i, j, s->flown, gas[j].flown};
                e = sooner;
            }
        }
    }
    push(e);
}

/* ---- what happens */

static void fly(sphere *s)
{
    for (int k = 0; k < 3; k++)
        s->p.position[k] += s->p.velocity[k]*(now - s->time);
    s->time = now;
}

static void cross(int i, int face)
{
    sphere *s = &gas[i];
    int axis = face/2, up = face%2, step = axis == 0 ? side*side : axis == 1 ? side : 1, at = s->cell/step%side;
    int to = (at + (up ? 1 : side - 1))%side;
    fly(s);
    s->p.position[axis] = (up ? to : to + 1)*width; /* on the face, without rounding */
    leave(i);
    enter(i, s->cell + (to - at)*step);
    predict(i);
}

/* Two spheres collide by the law; returns the outcome, or UNDECIDED. */
static int collide(int i, int j)
{
    sphere *both[2];
    granulation_pair_after after;
    both[0] = &gas[i];
    both[1] = &gas[j];
    fly(both[0]);
    fly(both[1]);
    for (int k = 0; k < 3; k++) /* the image next to it */
        both[1]->p.position[k] = both[0]->p.position[k] + image(both[1]->p.position[k] - both[0]->p.position[k]);
    after.time = 0.0;
    /* whom others have passed while it was in contact may be found within them: any distance is taken back to contact */
    int status = granulation_collide_particles(&material, &both[0]->p, &both[1]->p, 1.0, 1e-8, 0, &after);
    if (status >= GRANULATION_BAD_RTOL) {
        fprintf(stderr, "a collision is refused: %s\n", granulation_message(status));
        exit(1);
    }
    int separated = status == GRANULATION_OK && after.outcome != GRANULATION_STICK;
    for (int b = 0; b < 2; b++) {
        both[b]->time = now + (separated ? after.time : 0.0);
        if (both[b]->time < now)
            fly(both[b]);
        for (int k = 0; k < 3; k++)
            both[b]->p.position[k] -= box*floor(both[b]->p.position[k]/box);
        both[b]->outcome = separated ? after.outcome : GRANULATION_STICK;
        both[b]->stuck = !separated;
        both[b]->flown++;
        leave(b ? j : i);
        if (separated)
            enter(b ? j : i, cell_of(both[b]));
    }
    if (separated) {
        predict(i);
        predict(j);
    }
    return status == GRANULATION_OK ? after.outcome : UNDECIDED;
}

/* ---- what is written */

static void row(const long *counts)
{
    double momentum[3] = {0.0, 0.0, 0.0}, energy = 0.0, moving = 0.0, spinning = 0.0;
    int single = 0;
    for (int i = 0; i < count; i++) {
        const sphere *s = &gas[i];
        double v2 = 0.0, w2 = 0.0;
        for (int k = 0; k < 3; k++) {
            v2 += s->p.velocity[k]*s->p.velocity[k];
            w2 += s->p.spin[k]*s->p.spin[k];
            momentum[k] += mass*s->p.velocity[k];
        }
        energy += 0.5*(mass*v2 + inertia*w2);
        if (!s->stuck) {
            moving += v2/3.0;
            spinning += inertia/mass*w2/3.0;
            single++;
        }
    }
    printf("%.9g,%ld,%ld,%ld,%ld,%d,%.9g,%.9g,%.17g,%.17g,%.17g,%.17g\n", now, counts[0], counts[1], counts[2],
        counts[UNDECIDED], single, single ? moving/single : 0.0, single ? spinning/single : 0.0, energy, momentum[0], momentum[1], momentum[2]);
}

static void snapshot(FILE *file, int number)
{
    for (int i = 0; i < count; i++) {
        const sphere *s = &gas[i];
        double since = s->stuck ? 0.0 : now - s->time;
        fprintf(file, "%d,%.9g,%d,%d", number, now, s->outcome, s->stuck);
        for (int k = 0; k < 3; k++)
            fprintf(file, ",%.6f", image(s->p.position[k] + s->p.velocity[k]*since)/box + 0.5);
        fprintf(file, "\n");
    }
}

/* ---- the beginning */

static double uniform(void)
{
    static unsigned long long state = 42;
    state = state*6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(state >> 11)/9007199254740992.0;
}

static double normal(void)
{
    return sqrt(-2.0*log(1.0 - uniform()))*cos(6.283185307179586*uniform());
}

/* Spheres spread over the sites of a lattice, with velocities of the standard deviation `speed` and no momentum, and without spins. */
static void begin(double speed)
{
    int edge = (int)ceil(cbrt(count));
    double mean[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < count; i++) {
        sphere s = {{{0.0}, {0.0}, {0.0}}, 0.0, 0, -1, -1, 0, -1, 0};
        int site = (int)((long long)i*edge*edge*edge/count), at[3] = {site/(edge*edge), site/edge%edge, site%edge};
        for (int k = 0; k < 3; k++) {
            s.p.position[k] = box*(at[k] + 0.5)/edge;
            mean[k] += (s.p.velocity[k] = speed*normal())/count;
        }
        gas[i] = s;
    }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            gas[i].p.velocity[k] -= mean[k];
        enter(i, cell_of(&gas[i]));
    }
    for (int i = 0; i < count; i++)
        predict(i);
}

int main(int given, char **word)
{
    FILE *file = fopen("snapshots.csv", "w");
    long counts[OUTCOMES] = {0, 0, 0, 0}, most, done = 0, next = 0;
    int shown = 1, stuck = 0;
    double share, later = INFINITY;
    if (given != 5 || !file) {
        fprintf(stderr, "cooling COUNT SHARE SPEED COLLISIONS\n");
        return 2;
    }
    count = atoi(word[1]);
    share = atof(word[2]);
    most = (long)(atof(word[4])*count/2);
    material = granulation_default_material();
    mass = 2.0*material.reduced_mass; /* equal spheres */
    inertia = 0.4*mass*4.0*material.reduced_radius*material.reduced_radius;
    distance = granulation_contact_distance(&material);
    box = cbrt(count*4.18879020478639*8.0*pow(material.reduced_radius, 3)/share);
    side = (int)fmin(floor(box/distance), 2.0*cbrt(count));
    if (side < 3 || !(box/ceil(cbrt(count)) > distance)) {
        fprintf(stderr, "too few spheres, or too dense\n");
        return 2;
    }
    width = box/side;
    gas = malloc(sizeof *gas*(size_t)count);
    cells = malloc(sizeof *cells*(size_t)(side*side*side));
    if (!gas || !cells)
        return 1;
    for (int k = 0; k < side*side*side; k++)
        cells[k] = -1;
    begin(atof(word[3]));
    printf("time,stick,rotate,bounce,undecided,single,temperature,spin_temperature,energy,momentum_x,momentum_y,momentum_z\n");
    fprintf(file, "number,time,outcome,stuck,x,y,z\n");
    row(counts);
    snapshot(file, 0);
    while (queued && done < most && stuck < count - 1) {
        event e = pop();
        if (gas[e.one].flown != e.flown)
            continue;
        now = e.time;
        if (e.kind == FACE)
            cross(e.one, e.other);
        else if (gas[e.other].flown != e.others_flown)
            predict(e.one);
        else {
            counts[collide(e.one, e.other)]++;
            stuck = (int)(2*(counts[GRANULATION_STICK] + counts[UNDECIDED]));
            if (4*stuck >= shown*count && shown < 4)
                snapshot(file, shown++);
            if (++done > next || now > later) {
                row(counts);
                next = done + count/50 + done/30;
                later = 1.05*now;
            }
        }
    }
    row(counts);
    snapshot(file, 4);
    return fclose(file) != 0;
}
