"""The part of NAME.h about contacts that a host interrupts."""

from .comments import comment

MEMORY = 64  # doubles, and so many more with a ledger; the C compiler asserts that they suffice
_BOOK = 32
_MOTIONS = (
    ("CLOSING", "the gap falls"),
    ("OPENING", "the gap rises"),
    ("RESTING", "the gap is held in solid contact; the rotation goes on"),
    ("APART", "separated: this is the state at separation, and the contact is over"),
    ("CUT_OFF", "over as the strings' experiment ends: half a turn, or the rotation reverses"),
    ("LOST", "it cannot be followed further; `status` says why. What is said of a stick stays true"),
)
_FIELDS = (
    ("int", "status", "LAW_OK, or why there is no answer"),
    ("int", "motion", "LAW_CLOSING, LAW_OPENING, LAW_RESTING, LAW_APART, LAW_CUT_OFF or LAW_LOST"),
    ("int", "outcome", "LAW_STICK from when it is certain; after separation as in law_collision; else LAW_UNDECIDED"),
    ("int", "certified", "1 where the stick is proved. Its motion goes on all the same"),
    ("int", "rebound", "the first rebound criterion met so far, LAW_NO_REBOUND if none"),
    ("int", "wet", "1 while the gap is within the film, else 0; a bridge holds until the motion is LAW_APART"),
    ("double", "time", "s since initial contact"),
    ("double", "gap", "m"),
    ("double", "smallest_gap", "m, so far"),
    ("double", "normal_velocity", "m/s, rate of the gap: negative while it closes"),
    ("double", "rotation", "rad, angle that the line of centres has turned"),
    ("double", "rotation_rate", "rad/s, of the line of centres"),
    ("double", "spin", "rad/s, of the sphere"),
    ("double", "partner_spin", "rad/s, of the partner"),
)
LEDGER = (
    ("double", "initial_energy", "J, kinetic, at initial contact: the sum of all that follow, up to the tolerance"),
    ("double", "kinetic_energy", "J, now"),
    ("double", "normal_loss", "J, dissipated by the normal force of the film so far, as all that follow"),
    ("double", "tangential_loss", "J, dissipated by the tangential force"),
    ("double", "capillary_work", "J, work against the bridge: given back while it is negative"),
    ("double", "attraction_work", "J, work against van der Waals forces"),
    ("double", "dry_loss", "J, lost in the solid contact"),
    ("double", "strings_work", "J, stored in the strings"),
    ("double", "own_loss", "J, taken by jumps of a model's own events"),
)
"""The energy ledger of a contact."""


def contact_header(ledger: bool) -> list[str]:
    """Lines of the header: the state of a contact, and the functions that begin and advance it."""
    fields = (*_FIELDS, *(LEDGER if ledger else ()))
    return [
        *(["#define LAW_LEDGER 1", ""] if ledger else []),
        "/* Where a contact is. */",
        "enum {",
        *(f"    LAW_{name} = {k}, /* {what} */" for k, (name, what) in enumerate(_MOTIONS)),
        "};",
        "",
        *comment(
            "A contact that the host interrupts. It may be copied and moved; read it, but change nothing. What follows "
            f"`{fields[-1][1]}` is for the next call."
        ),
        "typedef struct {",
        *(f"    {kind} {name}; /* {what} */" for kind, name, what in fields),
        "    law_material material;",
        "    law_impact impact;",
        "    double rtol;",
        "    int budget;",
        f"    double memory[{MEMORY + _BOOK * ledger}];",
        "} law_contact;",
        "",
        *comment(
            "Begins a contact at initial contact, time 0; a rebound criterion that holds there has been met. `budget` "
            "is that of each later call. Returns contact->status."
        ),
        "int law_begin(",
        "    const law_material *material, const law_impact *impact, double rtol, int budget, law_contact *contact);",
        "",
        *comment(
            "Follows a contact to the time t, s since initial contact, not before contact->time. Where it ends "
            "earlier, contact->time is when. The steps are those of law_collide: where the host interrupts makes no "
            "difference beyond the tolerance. Returns contact->status, or LAW_BAD_TIME and nothing changes."
        ),
        "int law_advance(law_contact *contact, double t);",
        "",
    ]
