/* A cooling gas of wet spheres of two sizes that agglomerate: time steps, with an exported law's forces of contacts.
 *
 * Every contact is a pair with a history, so that a cluster is as rigid as its films: whatever strikes it meets all of its
 * contacts at once. Pairs are kicked one after the other, each with the velocities that the last has left.
 *
 * agglomerates COUNT SHARE SPEED VISCOSITY COLLISIONS SEED > rows.csv: spheres, share of the volume, standard deviation of
 * the velocity components (m/s), Pa s, contacts to be begun. Every third sphere has 1.5 times the radius. It ends as well when no
 * contact has begun for as long as it took to begin all. A last line has the largest growth of the energy in a step, over
 * the first energy, and the agglomerates: how many, times their size. The same bits come from every compiler without
 * contraction of products and sums (-ffp-contract=off), in any number of lanes.
 */
#include "granulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 2000, PARTS = 10 }; /* spheres, and steps in which the gas crosses a film */

typedef struct {
    double x[3], v[3], spin[3], mass, inertia, radius;
    int large, root; /* kind, and a sphere of the same agglomerate */
} sphere;

static sphere gas[MOST];
static granulation_material materials[2][2];
static granulation_pair_history (*histories)[MOST]; /* of every pair, the second sphere after the first */
static int (*near)[2], count, pairs;
static double box, film, bounds[2][2], momentum[3], turned[3], potential, begun, ended[3];

static double image(double x)
{
    return x - box*floor(x/box + 0.5);
}

static double apart(const sphere *s, const sphere *o, double *way)
{
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        way[k] = image(o->x[k] - s->x[k]);
        square += way[k]*way[k];
    }
    return sqrt(square);
}

/* Pairs that are in contact, or may be within a way. */
static void find_pairs(double way)
{
    double between[3];
    pairs = 0;
    for (int i = 0; i < count; i++)
        for (int j = i + 1; j < count; j++)
            if (histories[i][j].joined || apart(gas + i, gas + j, between) < bounds[gas[i].large][gas[j].large] + way) {
                near[pairs][0] = i;
                near[pairs++][1] = j;
            }
}

/* Energy of a bridge (Mikami's law, as in the scene), from the gap at which it forms, J. */
static double bridge_energy(const granulation_material *m, double gap)
{
    double radius = 2.0*m->reduced_radius, log_volume = log(m->volume), slope = -1.1*pow(m->volume, -0.53)/radius;
    double angle2 = m->contact_angle*m->contact_angle, tail = 0.0042*log_volume + 0.078;
    double offset = (-0.34*log_volume - 0.96)*angle2 - 0.019*log_volume + 0.48;
    double from = m->film_thickness, sum = (exp(slope*gap + offset) - exp(slope*from + offset))/slope;
    return 3.141592653589793*radius*m->surface_tension*(sum + tail*(gap - from));
}

/* The kick of a pair, which conserves momentum and angular momentum. */
static void kick(int i, int j, double dt)
{
    sphere *s = gas + i, *o = gas + j;
    granulation_pair_history *history = &histories[i][j];
    const granulation_material *m = &materials[s->large][o->large];
    granulation_pair_motion motion;
    granulation_pair_force found;
    double fastest = 0.0;
    memset(&motion, 0, sizeof motion);
    double distance = apart(s, o, motion.position);
    for (int k = 0; k < 3; k++) {
        motion.velocity[k] = o->v[k] - s->v[k];
        fastest += fabs(motion.velocity[k]);
        motion.spins[0][k] = s->spin[k];
        motion.spins[1][k] = o->spin[k];
    }
    if (!history->joined && distance > bounds[s->large][o->large] + fastest*dt)
        return;
    int status = granulation_contact_force(m, &motion, dt, history, &found);
    if (status != GRANULATION_OK) {
        fprintf(stderr, "a force is refused: %s\n", granulation_message(status));
        exit(1);
    }
    for (int k = 0; k < 3; k++) {
        int p = (k + 1)%3, q = (k + 2)%3;
        s->v[k] -= dt*found.force[k]/s->mass;
        o->v[k] += dt*found.force[k]/o->mass;
        s->spin[k] += dt*found.torques[0][k]/s->inertia;
        o->spin[k] += dt*found.torques[1][k]/o->inertia;
        turned[k] += dt*(motion.position[p]*found.force[q] - motion.position[q]*found.force[p] + found.torques[0][k]
            + found.torques[1][k]);
    }
    begun += (found.events & GRANULATION_BEGINS) != 0;
    if (found.outcome >= 0)
        ended[found.outcome]++;
    if (history->joined)
        potential += bridge_energy(m, found.gap) + history->spare; /* what it may give back of what it has taken */
}

static int root_of(int i)
{
    while (gas[i].root != i)
        i = gas[i].root = gas[gas[i].root].root;
    return i;
}

/* The numbers of agglomerates of each size; returns the largest size. */
static int agglomerates(int *sizes)
{
    int own[MOST] = {0}, largest = 0;
    for (int i = 0; i < count; i++)
        gas[i].root = i;
    for (int k = 0; k < pairs; k++)
        if (histories[near[k][0]][near[k][1]].joined)
            gas[root_of(near[k][0])].root = root_of(near[k][1]);
    for (int i = 0; i < count; i++)
        own[root_of(i)]++;
    memset(sizes, 0, (MOST + 1)*sizeof *sizes);
    for (int i = 0; i < count; i++) {
        sizes[own[i]]++;
        largest = own[i] > largest ? own[i] : largest;
    }
    return largest;
}

/* Kinetic energy; the momentum is in `momentum`. */
static double kinetic(void)
{
    double energy = 0.0;
    momentum[0] = momentum[1] = momentum[2] = 0.0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            const sphere *s = gas + i;
            energy += 0.5*(s->mass*s->v[k]*s->v[k] + s->inertia*s->spin[k]*s->spin[k]);
            momentum[k] += s->mass*s->v[k];
        }
    return energy;
}

static double normal(void)
{
    static unsigned long long state;
    double drawn[2];
    if (!state)
        state = (unsigned long long)begun; /* the seed, before contacts are counted */
    for (int k = 0; k < 2; k++) {
        state = state*6364136223846793005ULL + 1442695040888963407ULL;
        drawn[k] = (double)((state >> 11) + 1)/9007199254740993.0;
    }
    return sqrt(-2.0*log(drawn[0]))*cos(6.283185307179586*drawn[1]);
}

/* Materials, and spheres on the sites of a lattice, which spin with as much energy in a direction as they move with. */
static void begin(double share, double speed, double viscosity)
{
    static const double size[2] = {1.0, 1.5};
    granulation_pair_entries pair = granulation_default_pair_entries();
    pair.liquid_viscosity = viscosity;
    double radius = pair.particles_radius, volume = 0.0, whole = 0.0, mean[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            pair.particles_radius = size[i]*radius;
            pair.partner_radius = size[j]*radius;
            pair.partner_density = pair.particles_density;
            if (granulation_material_of(&pair, &materials[i][j]) != GRANULATION_OK)
                exit(1);
            bounds[i][j] = granulation_contact_distance(&materials[i][j]);
        }
    film = materials[0][0].film_thickness;
    for (int i = 0; i < count; i++) {
        sphere *s = gas + i;
        s->large = i%3 == 2;
        s->radius = size[s->large]*radius;
        s->mass = 4.1887902047863905*pair.particles_density*s->radius*s->radius*s->radius;
        s->inertia = 0.4*s->mass*s->radius*s->radius;
        volume += s->mass/pair.particles_density;
        whole += s->mass;
    }
    box = cbrt(volume/share);
    int edge = (int)ceil(cbrt(count));
    if (!(box/edge > bounds[1][1])) {
        fprintf(stderr, "too dense\n");
        exit(2);
    }
    for (int i = 0; i < count; i++) {
        sphere *s = gas + i;
        int site = (int)((long long)i*edge*edge*edge/count), at[3] = {site/(edge*edge), site/edge%edge, site%edge};
        for (int k = 0; k < 3; k++) {
            s->x[k] = box*(at[k] + 0.5)/edge;
            s->v[k] = speed*normal();
            s->spin[k] = sqrt(s->mass/s->inertia)*speed*normal();
            mean[k] += s->mass*s->v[k]/whole;
        }
    }
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            gas[i].v[k] -= mean[k];
}

int main(int given, char **word)
{
    static int sizes[MOST + 1];
    count = given == 7 ? atoi(word[1]) : 0;
    if (count < 2 || count > MOST) {
        fprintf(stderr, "agglomerates COUNT SHARE SPEED VISCOSITY COLLISIONS SEED\n");
        return 2;
    }
    histories = calloc((size_t)count, sizeof *histories);
    near = malloc(sizeof *near*(size_t)count*(size_t)count);
    if (!histories || !near)
        return 1;
    double speed = atof(word[3]), wanted = atof(word[5]), dt = film, now = 0.0, last = 0.0, shown = 0.0, spread = 0.0;
    begun = atof(word[6]);
    begin(atof(word[2]), speed, atof(word[4]));
    begun = 0.0;
    dt = film/speed/PARTS;
    double first = kinetic(), before = first, grown = 0.0, size = sqrt(2.0*first*gas[0].mass*count), skin = 0.0;
    printf("time,contacts_begun,rotate,bounce,contacts,agglomerates,largest,kinetic,energy,momentum,angular_momentum\n");
    for (long step = 0;; step++) {
        double most = 0.0, energy;
        if (spread >= skin) {
            skin = 0.3*gas[0].radius;
            spread = 0.0;
            find_pairs(2.0*skin);
        }
        potential = 0.0;
        for (int k = 0; k < pairs; k++) {
            int *pair = near[step%2 ? k : pairs - 1 - k];
            double had = begun;
            kick(pair[0], pair[1], dt);
            last = begun > had ? now : last;
        }
        energy = kinetic();
        for (int i = 0; i < count; i++) {
            double way = 0.0;
            for (int k = 0; k < 3; k++) {
                gas[i].x[k] += dt*gas[i].v[k];
                way += gas[i].v[k]*gas[i].v[k];
            }
            most = way > most ? way : most;
        }
        spread += sqrt(most)*dt;
        now += dt;
        grown = fmax(grown, (energy + potential - before)/first);
        before = energy + potential;
        int done = begun >= wanted || (begun > 0.0 && now > 2.0*last + film/speed);
        if (begun >= shown || done) {
            int largest = agglomerates(sizes), number = 0, contacts = 0;
            for (int n = 1; n <= count; n++)
                number += sizes[n];
            for (int k = 0; k < pairs; k++)
                contacts += histories[near[k][0]][near[k][1]].joined;
            double off = fmax(fabs(momentum[0]), fmax(fabs(momentum[1]), fabs(momentum[2])))/size;
            double twist = fmax(fabs(turned[0]), fmax(fabs(turned[1]), fabs(turned[2])))/(size*gas[0].radius);
            printf("%.6g,%.0f,%.0f,%.0f,%d,%d,%d,%.17g,%.17g,%.3g,%.3g\n", now, begun, ended[1], ended[2], contacts,
                number, largest, energy/first, before/first, off, twist);
            shown = begun + wanted/200.0;
        }
        if (done)
            break;
    }
    agglomerates(sizes);
    printf("# energy grows by %.2g of the first in a step at most; number*size:", grown);
    for (int n = 1; n <= count; n++)
        if (sizes[n])
            printf(" %d*%d", sizes[n], n);
    printf("\n");
    return 0;
}
