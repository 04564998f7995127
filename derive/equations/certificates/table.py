"""The stick certificates, in the order in which their margins are emitted."""

from ...physics.structure import Structure
from . import attraction, orbital_momentum, pendulum, spin_down
from .certificate import Certificate, Enclosed, Proof

CERTIFICATES = (
    Certificate(
        "energy",
        "energy, or all of it but for a thousandth of tumbling in space, is below a barrier ahead",
        (
            Proof("is_below_barrier", "the energy is below a barrier, lowered by what a drift of L may do",
                  "energy < height - margin*(largest + abs(height)) - drift"),
            Proof("tumbles_for_good",
                  "a doublet that tumbles as one body is held with all momentum across the line of centres",
                  "rest < TUMBLES*rigid and rest + rigid + work < height - margin*(largest + abs(height))"),
        ),
        ("certificate",),
    ),
    Certificate(
        "film",
        "a film alone takes more than what drives a motion",
        (Proof("is_stopped", "the film takes more than what drives a motion", "excess + error < 0"),),
        ("laws",),
    ),
    Certificate(
        "rest",
        "the reaction of a resting doublet never vanishes",
        (Proof("rests_for_good", "the reaction stays inward at the largest momentum that slip allows",
               "reaction > margin*largest"),),
        ("friction", "partners"),
    ),
    pendulum.ROW,
    attraction.ROW,
    orbital_momentum.ROW,
    spin_down.ROW,
    Certificate(
        "chatter",
        "in space, rebounds take more than the rotation gives on the way back",
        (Proof("comes_back", "a rebound loses more than the rotation gives on the way back to the maximum",
               "outward < lost*(1 - margin)"),),
        ("space",),
    ),
)  # fmt: skip


def enclosed(structure: Structure) -> Enclosed | None:
    """The energies that the enclosing engine compares, where a certificate is sharper than the energy."""
    return next((row.enclosed(structure) for row in CERTIFICATES if row.enclosed and row.admits(structure)), None)
