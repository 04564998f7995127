"""Why the kernel has not decided a collision, as an error with phase, time and state."""

from collections.abc import Mapping
from typing import Any

from ....generated.automaton import CLOSING, OPENING, Status
from ...errors import ComputationError, install_extra
from ...model.phases import Phase

# why a collision stays undecided, in messages
CREEPS, RESTS = "the gap changes too slowly", "the resting doublet turns for too long"
CHATTERS, REVERSED = "the gap opens and closes again and again", "the rotation reverses the approach"
ROUNDED = "rounding of its angular momentum decides"
SEPARATES = "separates when it is followed on"  # of a stick


def no_kernel(why: str = "is not shipped, and no C compiler answers here") -> ComputationError:
    """The error of a scene without a kernel."""
    return ComputationError(
        f"the kernel for this scene {why}", advice=f"install gcc or clang, or {install_extra('compiler')}"
    )


def undecided(
    answer: Mapping[str, Any], states: tuple[str, ...], last: Any = None, declared: str = "", own: bool = False
) -> ComputationError:
    """The error for an answer without an outcome, dimensionless.

    Arguments:
        answer: of the kernel; its `shown` has the state that was reached.
        states: names of the model's states.
        last: its last event with the mode after it, a row of HAPPENING, if there was any and it is known.
        declared: the last declared event that happened, by its word.
        own: a user's model is in the scene.
    """
    if answer["status"] == Status.TOO_OBLIQUE:  # it was not begun
        message = f"at this angle, with these spins, {REVERSED} within a rounding error of the film thickness"
        return ComputationError(message, advice="try a smaller angle or slower spins")
    state = {"gap": float(answer["final_gap"])}
    state |= {name: float(value) for name, value in zip(states[1:], answer["shown"], strict=False)}
    gap, velocity = state["gap"], state[states[1]]
    if last is not None:
        closing, resting, film = (int(last[name]) for name in ("closing", "resting", "film"))
    elif not answer["events"]:
        closing, resting, film = 1, 0, 1
    else:  # at rest on the solids it is zero, and nowhere else but at a turn
        closing, resting, film = velocity < 0, velocity == 0, int(gap < 1)
    phase = Phase(film, 0, CLOSING if closing else OPENING, resting=bool(resting))
    spent = f"{answer['steps']} steps with {answer['events']} events have not decided the outcome"
    why = RESTS if phase.resting else CREEPS
    ended = ', or an event with ends="stick" in the model' * own
    message, advice = {
        Status.NO_BUDGET: (spent, f"{why}: try a larger --rtol, or another impact{ended}"),
        Status.CHATTER: (spent, f"{CHATTERS}: try another impact{ended}"),
        Status.ESCAPED: (f"a stick that is proved {SEPARATES}", "please report the scene"),
        Status.WITHIN_ROUNDING: (
            f"the doublet separates so slowly that {ROUNDED}",
            "try spins with another angular momentum",
        ),
        Status.UNDECLARED: (
            f"the event {declared} creates kinetic energy that it does not declare",
            "declare what it releases, event(..., releases=), or another jump",
        ),
    }.get(answer["status"], ("the state is not finite", "try --rtol 1e-8, or a less extreme impact"))
    return ComputationError(message, phase=str(phase), time=float(answer["time"]), state=state, advice=advice)
