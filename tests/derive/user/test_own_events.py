"""Declared events in the derivation: what is refused, their form in the structures, and what is shown of them."""

from pathlib import Path

import pytest
import sympy as sp
from wetdoublet.derive.emit.compare import same
from wetdoublet.derive.equations.model import derive
from wetdoublet.derive.laws.modelfile import read
from wetdoublet.derive.physics.structure import Structure
from wetdoublet.derive.user.declarations import ModelFileError
from wetdoublet.derive.user.structures import UserModel

OBLIQUE = Structure(True, True, False)
HEAD = 'from wetdoublet.derive.user import *\nk = quantity("k", unit="1/s")\nd = quantity("d", unit="m")\n'
USES = '\nevent("other", guard=k - u / x + k * (x - d) / d)'


def model(body: str) -> UserModel:
    """The model of a file with these lines."""
    return read(Path("mine.py"), HEAD + body + USES)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('event("snap", guard=k - u)', "line 4: event snap.guard: 'k - u' term"),
        (
            'event("snap", guard=k)',
            "event snap.guard: k never changes; accepted: an expression of x, u, omega, xi, beta or t",
        ),
        ('event("snap", guard=sp.Symbol("speed_of_light") - u)', "is not known to an event; accepted: x, u, omega"),
        ('event("snap", guard=d - x, where="outside")', "event snap.where: 'outside' is not accepted; accepted: "),
        ('event("snap", guard=d - x, jump={x: d})', "surfaces move apart and together continuously: a gap"),
        ('event("snap", guard=d - x, jump={u: x})', "event snap.jump: 'x' has dimension L; accepted: "),
        ('event("snap", guard=d - x, jump={omega: omega + k})', "turns what does not turn"),
        ('event("snap", guard=d - x, releases=m)', "event snap.releases: 'm' has dimension M; accepted"),
        ('event("snap", guard=d - x, word="rupture")', "event snap.word: 'rupture' exists already; accepted: any word"),
        ('event("snap", guard=d - x, ends="bounce")', "event snap.ends: 'bounce' is not accepted; accepted"),
        ('event("snap", guard=d - x, ends="separated")', "event snap.where: 'any' may be on approach"),
        ('event("snap", guard=d - x, ends="stick", jump={u: u/2})', "event snap.jump"),
        ('event("glass", guard=d - x)', "'glass' is an event of the library; accepted: a name of your own"),
        ('event("gap", guard=d - x)', "event: 'gap' is taken already"),
        ('event("k", guard=d - x)', "event: 'k' is taken already"),
        ('event("snap", guard=d - x)\nevent("snap", guard=d - x)', "line 5: event: 'snap' is taken already"),
        ('event("snap", guard=d - x)\nquantity("before_snap")', "quantity: 'before_snap' is taken already"),
    ],
)
def test_bad_events_are_named(body: str, said: str):
    """An event that cannot be is one line with file, line, what is wrong and what is accepted."""
    with pytest.raises(ModelFileError) as caught:
        model(body)
    assert str(caught.value).startswith("mine.py, line ")
    assert said in str(caught.value)
    assert "accepted: " in str(caught.value)


def test_guard_and_jump_in_a_structure():
    """The guard is dimensionless, the mark a state that is 1 before the event and 0 after it, all else continuous."""
    made = model('event("snap", guard=k - u / x, jump={u: u / 2})').extended(derive(OBLIQUE))
    names = [state.name for state in made.states]
    assert names[-2:] == ["before_snap", "before_other"]
    guard = dict(made["events"].outputs)["snap"]
    assert {symbol.name for symbol in guard.free_symbols} <= {"gap", "normal_velocity", "aspect", "k_number"}
    after = dict(made["jump_snap"].outputs)
    speed = sp.Symbol("normal_velocity", real=True)
    assert after["normal_velocity"] == speed / 2
    assert after["before_snap"] == 0
    assert [str(after[name]) for name in ("gap", "orbital_momentum", "spin", "before_other")] == [
        "gap", "orbital_momentum", "spin", "before_other",
    ]  # fmt: skip
    assert dict(made["start"].outputs)["before_snap"] == 1
    assert dict(made["right_hand_side"].outputs)["before_snap"] == 0


@pytest.mark.parametrize(
    ("body", "takes", "harmless", "known"),
    [
        ('event("snap", guard=k - u / x, where="opening", jump={u: u / 2})', True, True, True),
        ('event("snap", guard=k - u / x, where="opening", jump={u: 2 * u})', False, False, True),
        ('event("snap", guard=k - u / x, where="opening", ends="separated")', True, False, True),
        ('event("snap", guard=omega - xi - k, jump={omega: omega / 2})', True, False, False),
        ('event("snap", guard=k * d - u * cos(x / d), where="opening", ends="separated")', True, False, False),
        ('on = event("snap", guard=d - x)\nlaw("bridge", "mine", force=on * sigma * a)', True, False, True),
        ('event("snap", guard=d - x)\nevent("more", guard=2 * (d - x), jump={u: u / 2})', True, False, True),
        ('on = event("snap", guard=d - x)\nevent("more", guard=2 * d * on - x)', True, False, True),
    ],
)
def test_what_is_shown_decides_the_certificates(body: str, takes: bool, harmless: bool, known: bool):
    """That a jump adds no energy, that nothing a proof needs is changed, and the signs of the guard's slopes."""
    event = model(body).events[0]
    assert event.takes is takes
    assert event.harmless is harmless
    assert event.reach(OBLIQUE).is_known is known


def test_structures_that_cannot_have_an_event():
    """Head-on and beside a wall nothing turns, and a jump of the rotation needs the spin as a state."""
    event = model('event("lock", guard=omega - xi - k, jump={xi: omega})').events[0]
    wanted = {
        OBLIQUE: True, Structure(False, True, False): False, Structure(True, True, False, partner="wall"): False,
        Structure(True, True, False, partner="pair"): True, Structure(True, True, False, reduced=True): False,
    }  # fmt: skip
    assert {structure: event.fits(structure) for structure in wanted} == wanted


def test_head_on_the_mark_of_a_rotation_stays():
    """What only a rotation brings about never happens head-on: the mark that a law has is 1 for good there."""
    body = 'on = event("lock", guard=k - omega)\nlaw("bridge", "mine", force=on * sigma * a)'
    made = model(body).extended(derive(Structure(False, True, False)))
    assert "lock" not in made["events"].by_name
    assert (made["start"].by_name["before_lock"], made["right_hand_side"].by_name["before_lock"]) == (1, 0)


def test_the_angle_turned_and_the_time_are_states():
    """What a guard watches beside the motion is integrated with it, also in resting contact; the pendulum has it."""
    both = model('event("late", guard=1 + 0*t - beta - k*t)')
    made = both.extended(derive(OBLIQUE))
    rates = made["right_hand_side"].by_name
    assert same(rates["angle_turned"], made["turning_rate"].by_name["rotation"])
    assert rates["time_passed"] == 1
    assert {made["start"].by_name[name] for name in ("angle_turned", "time_passed")} == {0}
    assert made["resting_rates"].by_name["time_passed"] == 1
    pendulum = both.extended(derive(Structure(True, False, True)))
    assert "angle_turned" not in {state.name for state in pendulum.states}
    assert sp.Symbol("rotation", real=True) in pendulum["events"].by_name["late"].free_symbols
    head_on = both.extended(derive(Structure(False, True, False)))
    assert "angle_turned" not in {state.name for state in head_on.states}
    assert "late" in head_on["events"].by_name
    turning = model('event("late", guard=1 - beta)').extended(derive(Structure(False, True, False)))
    assert "late" not in turning["events"].by_name


@pytest.mark.parametrize(
    ("second", "waits"),
    [
        ('guard=d - x, where="opening"', "before_first - 1/2"),
        ('guard=3*(d - x)*m/(x*d), where="opening"', "before_first - 1/2"),
        ('guard=d - x, where="closing"', ""),
        ('guard=x - d, where="opening"', ""),
        ('guard=(d - x)*u, where="opening"', ""),
        ('guard=d - 2*x, where="opening"', ""),
    ],
)
def test_an_event_with_the_guard_of_an_earlier_one_waits_for_it(second: str, waits: str):
    """Where a guard is a positive multiple of an earlier one, in the same place, the order of the file decides."""
    made = model(f'event("first", guard=d - x, where="opening", jump={{u: u/2}})\nevent("second", {second})')
    guard = made.extended(derive(OBLIQUE))["events"].by_name["second"]
    assert (str(guard) == waits) if waits else not guard.has(sp.Symbol("before_first", nonnegative=True))


def test_guards_that_differ_by_a_rotation_are_one_head_on():
    """What a structure makes of two guards decides whether they fall to zero together."""
    made = model(
        'event("first", guard=d - x, where="opening", jump={u: u/2})\n'
        'event("second", guard=d - x + d*beta**2, where="opening")'
    )
    second = {
        oblique: made.extended(derive(Structure(oblique, True, False)))["events"].by_name["second"]
        for oblique in (True, False)
    }
    assert str(second[False]) == "before_first - 1/2"
    assert not second[True].has(sp.Symbol("before_first", nonnegative=True))
    assert not made.events[0].harmless


def test_an_event_waits_and_then_watches_its_guard_where_the_earlier_one_changes_it():
    """A guard of u after a jump of u, and one on the other side of a reversal: the guard itself decides when."""
    body = (
        'event("first", guard=k*d - u, where="opening", jump={u: u/2})\nevent("second", guard=k - u/d, where="opening")'
    )
    guard = model(body).extended(derive(OBLIQUE))["events"].by_name["second"]
    mark = sp.Symbol("before_first", nonnegative=True)
    assert guard.subs(mark, 1) == 1
    assert guard.subs(mark, 0).has(sp.Symbol("normal_velocity", real=True))


def test_an_event_may_have_a_name_of_several_words():
    """The word of reports, and with underscores the name in emitted code."""
    (event, _) = model('event("quarter turn", guard=1 - beta)').events
    assert (event.name, event.proposed.word, event.mark.name) == ("quarter_turn", "quarter turn", "before_quarter_turn")
