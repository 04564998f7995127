"""A collision as a small table for a notebook."""

from ..formatting.notebook import view
from .outcome import Outcome
from .text import assumed, degrees, name_of, plain, quantity, reason


def html(one: Outcome) -> str:
    """Outcome and why, results with units, events, and what the model warns of."""
    rows = [
        ("outcome", one.outcome, reason(one)),
        ("impact", f"St {plain(one.stokes)}, {degrees(one.angle)}", f"normal speed {quantity(one.speed, 'm/s')}"),
        ("normal restitution e_n", plain(one.restitution), ""),
    ]
    results = [
        ("tangential restitution e_t", plain(one.tangential_restitution), one.tangential_restitution),
        ("rotation", degrees(one.rotation), one.rotation),
        ("contact time", quantity(one.contact_time, "s"), one.contact_time),
        ("smallest gap", quantity(one.smallest_gap, "m"), one.smallest_gap),
        ("final spin", plain(one.final_spin, "rad/s"), one.final_spin),
        ("final spin of the partner", plain(one.final_spin_partner, "rad/s"), one.final_spin_partner),
        ("final rotation rate", plain(one.final_rotation_rate, "rad/s"), one.final_rotation_rate),
    ]
    rows += [(name, shown, "") for name, shown, value in results if value is not None]
    if one.events:
        happened = [f"{event.kind} at {quantity(event.time, 's')}" for event in one.events[:6]]
        more = [f"{len(one.events) - 6} more"] if len(one.events) > 6 else []
        rows.append(("events", "; ".join([*happened, *more]), ""))
    if one.energy is not None:
        end = f"{quantity(one.energy.final, 'J')} at the end; residual {one.energy.residual:.1e} J"
        rows.append(("energy", f"{quantity(one.energy.initial, 'J')} at contact", end))
    engine = f"{one.engine}, {one.steps} steps" + (f" ({one.engine_reason})" if one.engine_reason else "")
    return view(name_of(one.scene), rows, notes=[*one.validity, *assumed(one.scene), engine])
