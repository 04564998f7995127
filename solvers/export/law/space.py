"""Collisions in space as part of an exported law: what its header says of them, and its C files."""

from ...engines.settings import KERNEL_STEPS, KERNEL_STEPS_IN_SPACE
from ...scene.scene import Scene
from .comments import comment
from .kernels import only_in_a_plane
from .material import Result

ROOTS = ("space_rows.h", "held.h")
"""Files of the kernel with vectors, besides those of every kernel."""
TYPES = ("ends.h",)
"""Files with the types that kernels and callers exchange."""
PAIR = (
    ("double", "normal", (3,), "from the first particle to the second, of any length but zero"),
    ("double", "velocities", (2, 3), "m/s, of the centres, or of the centre and the wall"),
    ("double", "spins", (2, 3), "rad/s, angular velocities; of a wall not used"),
)
"""Members of `law_pair`: type, name, shape, meaning."""
AFTER = (
    ("int", "status", (), "LAW_OK, or why there is no answer"),
    ("int", "outcome", (), "as in law_collision"),
    ("int", "certified", (), "1 where a stick is proved, else 0"),
    ("double", "restitution", (), "normal relative velocity at separation over that of the approach; 0 of a stick"),
    ("double", "slip_restitution", (), "the same of the surfaces at the contact; NaN of a stick or without slip"),
    ("double", "time", (), "s, to separation; of a stick 0: it is one body from initial contact on"),
    ("double", "gap", (), "m, of the surfaces at that time"),
    ("double", "position", (3,), "m, from the first centre to the second, or to the wall's surface"),
    ("double", "normal", (3,), "direction of the position"),
    ("double", "velocities", (2, 3), "m/s, of the centres; a wall keeps its own"),
    ("double", "spins", (2, 3), "rad/s, angular velocities; of a wall NaN"),
    ("double", "centre_velocity", (3,), "m/s, of the centre of mass, or of the wall"),
    ("double", "angular_velocity", (3,), "rad/s, of the rigid rotation of a doublet that sticks; else NaN"),
)
"""Members of `law_pair_after`."""
PARTICLE = (
    ("double", "position", (3,), "m, of the centre, or of the wall's surface below the sphere"),
    ("double", "velocity", (3,), "m/s"),
    ("double", "spin", (3,), "rad/s; of a wall not used"),
)
"""Members of `law_particle`."""
MOTION = (
    ("double", "position", (3,), "m, from the first centre to the second"),
    ("double", "velocity", (3,), "m/s, of the second centre relative to the first"),
    ("double", "spins", (2, 3), "rad/s, angular velocities"),
    ("double", "forces", (2, 3), "N, on each of all but this contact; zero where they are not known"),
    ("double", "torques", (2, 3), "N m, on each of all but this contact"),
)
"""Members of `law_pair_motion`."""
HISTORY = (
    ("int", "joined", (), "1 while there is a contact, else 0"),
    ("int", "rebound", (), "the first rebound criterion met, LAW_NO_REBOUND if none"),
    ("double", "gap", (), "m, of the contact"),
    ("double", "smallest_gap", (), "m, so far"),
    ("double", "speed", (), "m/s, normal approach speed at initial contact"),
    ("double", "time", (), "s, since initial contact"),
    ("double", "lead", (), "m/s, by which the host's velocity brings its gap back to that of the contact"),
    ("double", "spare", (), "J, that the contact has taken so far; what `lead` needs comes from it"),
)
"""Members of `law_pair_history`."""
HAPPENINGS = (
    ("BEGINS", "the films touch; a bridge forms"),
    ("REBOUNDS", "a rebound criterion is met"),
    ("RESTS", "the pair is held in solid contact"),
    ("LEAVES_FILM", "the gap rises beyond the film"),
    ("SEPARATES", "the contact ends; a bridge ruptures"),
)
"""Events of a step."""
FORCE = (
    ("int", "status", (), "LAW_OK, or why there is no answer"),
    ("int", "events", (), "the sum of what happens: LAW_BEGINS, LAW_REBOUNDS ..."),
    ("int", "outcome", (), "at separation as in law_collision, else LAW_UNDECIDED"),
    ("double", "force", (3,), "N, on the second particle; the first has its opposite"),
    ("double", "torques", (2, 3), "N m, on each"),
    ("double", "gap", (), "m, at the end of the step"),
    ("double", "restitution", (), "normal velocity at separation over that of the approach; NaN before"),
)
"""Members of `law_pair_force`."""
RESULTS = (
    Result(150, "NO_DIRECTION", "the normal is zero or not finite: the particles are at one place, or nowhere"),
    Result(151, "NOT_A_NUMBER", "a velocity or a spin is not finite"),
    Result(152, "NOT_APPROACHING", "the particles do not approach along the normal"),
    Result(153, "OUT_OF_RANGE", "velocities and spins are too large, too small, or too far from each other"),
    Result(154, "NOT_IN_CONTACT", "the particles are not at contact distance within `tolerance`, or pass each other"),
    Result(155, "BAD_TOLERANCE", "tolerance must be a number from 0"),
    Result(156, "BAD_STEP", "the length of a step must be a positive number, s"),
    Result(157, "BAD_HISTORY", "the history of the pair is none that a call has left: begin with zeros"),
)
"""Statuses of pairs."""
Members = tuple[tuple[str, str, tuple[int, ...], str], ...]


def callers(scene: Scene) -> tuple[str, ...]:
    """C files behind the kernels."""
    forces = () if no_forces(scene) else ("substep.h", "whirl.h", "force.h")
    return "planar_end.h", "beside_wall.h" if scene.wall else "two_spheres.h", "in_space.h", "particles.h", *forces


def no_forces(scene: Scene) -> str:
    """Why a scene has no forces for time steps; empty if it has."""
    return "partner.wall: only of two spheres" if scene.wall else ""


def bodies(scene: Scene) -> str:
    """The C function that takes the two bodies from a material."""
    names = ["reduced_radius", "reduced_mass", "radius_ratio", "mass_ratio", "film_thickness", "viscosity"]
    arguments = ["1.0" if scene.wall and name.endswith("ratio") else f"m->{name}" for name in names]
    lines = ["static bodies bodies_of(const law_material *m)", "{"]
    return "\n".join([*lines, f"    return bodies_with({', '.join(arguments)}, {int(scene.wall)});", "}", ""])


def declarations(scene: Scene) -> list[str]:
    """What the header says of collisions in space."""
    why = only_in_a_plane(scene)
    if why:
        sentence = f"There are no collisions in space (law_collide_pair) of this scene: {why}."
        return [*comment(sentence), "#define LAW_IN_SPACE 0", "#define LAW_FORCES 0", ""]
    lines = [
        *comment("There are collisions in space."),
        "#define LAW_IN_SPACE 1",
        "",
        *comment(_before(scene)),
        *_structure("law_pair", PAIR),
        *comment(_afterwards(scene)),
        *_structure("law_pair_after", AFTER),
        *comment(
            "One pair, with `rtol` and `budget` as in law_collide; a budget of 0 is "
            + (
                f"{KERNEL_STEPS} for each of two planar collisions"
                if scene.wall
                else f"{KERNEL_STEPS_IN_SPACE}, in a plane {KERNEL_STEPS}"
            )
            + ". Returns after->status."
        ),
        "int law_collide_pair(",
        "    const law_material *material, const law_pair *pair, double rtol, int budget, law_pair_after *after);",
        "",
        *comment("`count` pairs, side by side. Returns how many have another status than LAW_OK."),
        "long law_collide_pair_many(",
        "    const law_material *material, const law_pair *pairs, long count, double rtol, int budget,",
        "    law_pair_after *after);",
        "",
        *comment("A particle in the laboratory's axes."),
        *_structure("law_particle", PARTICLE),
        *comment("The distance at which the films touch and a collision begins, m: of the centres, or from the wall."),
        "double law_contact_distance(const law_material *material);",
        "",
        *comment(_in_place(scene)),
        "int law_collide_particles(",
        "    const law_material *material, law_particle *first, law_particle *second, double tolerance, double rtol,",
        "    int budget, law_pair_after *after);",
    ]
    return [*lines, "", *_forces(scene)]


def _forces(scene: Scene) -> list[str]:
    """What the header says of forces for time steps."""
    why = no_forces(scene)
    if why:
        return [*comment(f"There are no forces for time steps (law_contact_force): {why}."), "#define LAW_FORCES 0", ""]
    return [
        *comment("There are forces for time steps."),
        "#define LAW_FORCES 1",
        "",
        *comment(
            "Two particles where a force is asked for: positions of a time t, velocities and spins of half a step "
            "before it. Forces and torques are those of all else from half a step before to half a step after."
        ),
        *_structure("law_pair_motion", MOTION),
        *comment(
            "What a host keeps of a pair: zeros where there is no contact. It has no pointers, and may be copied, sent "
            "and written to a file."
        ),
        *_structure("law_pair_history", HISTORY),
        *comment("What happens in a step, added up."),
        "enum {",
        *(f"    LAW_{name} = {1 << k}, /* {what} */" for k, (name, what) in enumerate(HAPPENINGS)),
        "};",
        "",
        *comment("What the contact does to the pair."),
        *_structure("law_pair_force", FORCE),
        *comment(
            "The force of a pair for one step of the host, from `dt`/2 before the positions to `dt`/2 after them; "
            "apply it all that time. The torques balance its lever arms at these positions: momentum and angular "
            "momentum are kept to rounding. Returns found->status; without an answer the history stays as it is."
        ),
        "int law_contact_force(",
        "    const law_material *material, const law_pair_motion *motion, double dt, law_pair_history *history,",
        "    law_pair_force *found);",
        "",
        *comment(
            "Puts a contact in place, at a gap between solid contact and rupture: a bridge that is there beforehand. "
            "`speed`, m/s, is the approach that the elastic length goes by. Returns a status."
        ),
        "int law_contact_join(const law_material *material, double gap, double speed, law_pair_history *history);",
        "",
    ]


def _before(scene: Scene) -> str:
    other = "the wall" if scene.wall else "the second sphere"
    return (
        f"Two particles in space when their films touch, in the laboratory's axes: the first sphere, and {other}. "
        "Any velocities that approach along the normal, any spins. Spin about the normal (twist) has no friction to "
        "leading logarithm and stays as it is."
    )


def _afterwards(scene: Scene) -> str:
    if scene.wall:
        stick = "A stick moves with the wall, and only its twist is left."
    else:
        stick = (
            "A stick is given at initial contact, as the rigid doublet that has the momentum and angular momentum of "
            "the pair: a function of the pair alone, not of `rtol` or the compiler. Twist is each sphere's own; a host "
            "with rigid clusters gives both spheres `angular_velocity`, which has the same angular momentum. Momentum "
            "and angular momentum are kept to rounding."
        )
    return f"Both particles afterwards. {stick} Without an answer numbers are NaN."


def _in_place(scene: Scene) -> str:
    moved = (
        "The way along the wall is estimated from the velocities before and after; "
        "the wall's position follows the sphere."
        if scene.wall
        else "Their centre of mass moves on meanwhile."
    )
    return (
        "Moves two particles in place to the end of their collision, which is after->time later. A pair that is found "
        "late, or early, by at most `tolerance` of law_contact_distance (1e-6, say), is first moved along its straight "
        "paths to that distance, which changes no momentum and no energy; after->time is from the call on, so that a "
        f"late pair's is shorter, and a late stick's negative. {moved} Returns after->status; without an answer the "
        "particles stay as they are."
    )


def _structure(name: str, members: Members) -> list[str]:
    rows = [
        f"    {kind} {member}{''.join(f'[{size}]' for size in shape)}; /* {what} */"
        for kind, member, shape, what in members
    ]
    return ["typedef struct {", *rows, f"}} {name};", ""]
