"""A host with time steps, in C: two particles under the exported force alone, from before contact to separation."""

import ctypes
import subprocess
from pathlib import Path

import numpy as np
from wetdoublet.solvers import Scene
from wetdoublet.solvers.collision.space.pairs import Bodies

from .exported_law import Law

LOOP = """
#include "{name}.h"
#include <math.h>
#include <string.h>

typedef struct {{
    double restitution, energy, angular_momentum, apart;
    double velocity[3], spins[2][3];
    int outcome, steps;
}} flight;

static double dot(const double *a, const double *b)
{{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}}

static void sums(
    const {name}_material *m, const double *inertia, const {name}_pair_motion *s, double *momentum, double *energy)
{{
    const double *r = s->position, *v = s->velocity;
    for (int k = 0; k < 3; k++) {{
        int i = (k + 1)%3, j = (k + 2)%3;
        momentum[k] = m->reduced_mass*(r[i]*v[j] - r[j]*v[i]) + inertia[0]*s->spins[0][k] + inertia[1]*s->spins[1][k];
    }}
    *energy = 0.5*m->reduced_mass*dot(v, v);
    for (int k = 0; k < 2; k++)
        *energy += 0.5*inertia[k]*dot(s->spins[k], s->spins[k]);
}}

/* From `position` at initial contact, where the host is `phase` steps before it. */
static void fly(const {name}_material *m, const double *inertia, const double *position, const double *velocity,
                const double *spins, double dt, double phase, long most, flight *f)
{{
    {name}_pair_motion s;
    {name}_pair_history h;
    {name}_pair_force found;
    double first[3], momentum[3], initial, energy, size = 0.0;
    memset(&s, 0, sizeof s);
    memset(&h, 0, sizeof h);
    memset(f, 0, sizeof *f);
    for (int k = 0; k < 3; k++) {{
        s.position[k] = position[k] - phase*dt*velocity[k];
        s.velocity[k] = velocity[k];
        s.spins[0][k] = spins[k];
        s.spins[1][k] = spins[3 + k];
    }}
    sums(m, inertia, &s, first, &initial);
    size = m->reduced_mass*sqrt(dot(position, position)*dot(velocity, velocity));
    size += inertia[0]*sqrt(dot(spins, spins)) + inertia[1]*sqrt(dot(spins + 3, spins + 3));
    f->energy = initial;
    for (f->steps = 1; f->steps <= most; f->steps++) {{
        f->outcome = -1 - {name}_contact_force(m, &s, dt, &h, &found);
        if (f->outcome != -1)
            return;
        for (int k = 0; k < 3; k++) {{
            s.velocity[k] += dt*found.force[k]/m->reduced_mass;
            for (int j = 0; j < 2; j++)
                s.spins[j][k] += dt*found.torques[j][k]/inertia[j];
        }}
        sums(m, inertia, &s, momentum, &energy);
        f->energy = fmax(f->energy, energy);
        for (int k = 0; k < 3; k++) {{
            f->angular_momentum = fmax(f->angular_momentum, fabs(momentum[k] - first[k])/size);
            s.position[k] += dt*s.velocity[k];
        }}
        f->restitution = found.restitution;
        if (found.outcome >= 0)
            break;
    }}
    f->energy /= initial;
    f->outcome = found.outcome >= 0 ? found.outcome : h.joined ? 0 : -1000;
    double middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = s.position[k] - 0.5*dt*s.velocity[k];
    f->apart = sqrt(dot(middle, middle)) - {name}_contact_distance(m) + m->film_thickness - found.gap;
    memcpy(f->velocity, s.velocity, sizeof s.velocity);
    memcpy(f->spins, s.spins, sizeof s.spins);
}}

void fly_many(const {name}_material *m, const double *inertia, const double *positions, const double *velocities,
              const double *spins, const double *dt, const double *phases, long count, long most, flight *f)
{{
    for (long k = 0; k < count; k++)
        fly(m, inertia, positions + 3*k, velocities + 3*k, spins + 6*k, dt[k], phases[k], most, f + k);
}}
"""
FLIGHT = np.dtype(
    [
        ("restitution", "f8"), ("energy", "f8"), ("angular_momentum", "f8"), ("apart", "f8"), ("velocity", "f8", 3),
        ("spins", "f8", (2, 3)), ("outcome", "i4"), ("steps", "i4"),
    ]
)  # fmt: skip
"""Of each pair: the restitution; the largest kinetic energy over the first; the largest change of a component of the
angular momentum over its size; how much further apart the host has them than the contact, m; motion, outcome, steps."""


class Host:
    """The host of a law, beside its library in a folder."""

    def __init__(self, scene: Scene, law: Law, folder: Path) -> None:
        self._law, self._bodies = law, Bodies.of(scene)
        (folder / "host.c").write_text(LOOP.format(name=law.name))
        command = ["gcc", "-std=c99", "-O1", "-fPIC", "-shared", "-o", "host.so", "host.c", str(law.library), "-lm"]
        subprocess.run(command, cwd=folder, check=True)
        self._library = ctypes.CDLL(str(folder / "host.so"))

    def fly(
        self,
        pairs: tuple[np.ndarray, np.ndarray, np.ndarray],
        dt: np.ndarray,
        most: int,
        material: np.ndarray | None = None,
    ) -> np.ndarray:
        """Rows of FLIGHT for normals, velocities and spins at initial contact, in at most so many steps of dt, s."""
        normal, velocities, spins = pairs
        count = len(normal)
        moving = velocities[:, 1] - velocities[:, 0]
        phases = np.random.default_rng(4).uniform(2.0, 3.0, count)
        found = np.zeros(count, FLIGHT)
        rows = (self._law.contact_distance() * normal, moving, spins, dt, phases)
        material = self._law.material() if material is None else material
        given = [np.ascontiguousarray(each) for each in (material, np.array(self._bodies.inertia), *rows)]
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in given]
        self._library.fly_many(*pointers, ctypes.c_long(count), ctypes.c_long(most), ctypes.c_void_p(found.ctypes.data))
        return found
