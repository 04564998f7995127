"""Collisions in space as part of an exported law: what its header says of them, and its C files."""

from ...engines.settings import STEPS, STEPS_IN_SPACE
from ...scene.scene import Scene
from .comments import comment
from .kernels import only_in_a_plane
from .material import Result

ROOTS = ("space_rows.h",)
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
RESULTS = (
    Result(150, "NO_DIRECTION", "the normal is zero or not finite: the particles are at one place, or nowhere"),
    Result(151, "NOT_A_NUMBER", "a velocity or a spin is not finite"),
    Result(152, "NOT_APPROACHING", "the particles do not approach along the normal"),
    Result(153, "OUT_OF_RANGE", "velocities and spins are too large, too small, or too far from each other"),
    Result(154, "NOT_IN_CONTACT", "the particles are not at contact distance within `tolerance`, or pass each other"),
    Result(155, "BAD_TOLERANCE", "tolerance must be a number from 0"),
)
"""Statuses of pairs."""
Members = tuple[tuple[str, str, tuple[int, ...], str], ...]


def callers(scene: Scene) -> tuple[str, ...]:
    """C files behind the kernels."""
    return "planar_end.h", "beside_wall.h" if scene.wall else "two_spheres.h", "in_space.h", "particles.h"


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
        return [*comment(sentence), "#define LAW_IN_SPACE 0", ""]
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
            + (f"{STEPS} for each of two planar collisions" if scene.wall else f"{STEPS_IN_SPACE}, in a plane {STEPS}")
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
    return [*lines, ""]


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
