"""Checks of the spin-down certificate: each of its steps, on the emitted equations."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from ..equations.certificates.spin_down import (
    BEYOND,
    EDGE,
    FAR,
    NEAR,
    RATE,
    decay,
    definitions,
    impulse,
    slips,
    slowest,
)
from ..equations.model import Model, derive
from ..physics.forces import FILM, SHEAR
from ..physics.laws import LAWS, slot_call
from ..physics.laws.base import is_slot_call
from ..physics.partners.pair import PARTNER_RADIUS, RADIUS
from ..physics.partners.rolling import R_1, R_2, torque_matrix
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure
from ..vocabulary.quantities import (
    aspect,
    e_dry,
    gap,
    mu,
    normal_velocity,
    obliquity,
    orbital_momentum,
    partner_spin,
    spin,
    stokes,
)
from .base import Check, vanishing
from .closed import filled, opened, opened_rates

_ALONE = Structure(oblique=True, bridge=False, strings=False)
_COVERED = (_ALONE, replace(_ALONE, partner="pair"))
_MIDGAP = {"arm": LAWS["arm"]["midgap"]}
_LOG = sp.Symbol("log_factor", positive=True)


def _plain(expression: sp.Expr) -> sp.Expr:
    """With the lever arm at mid-gap, inside the edge of the shear, its logarithm a symbol."""
    found = filled(expression, _MIDGAP).subs(SHEAR, 1)
    calls = {n: _LOG for n in found.atoms(sp.Function) if is_slot_call(n) and n.func.__name__.startswith("shear")}
    return found.xreplace(calls)


def _spins(structure: Structure) -> list[sp.Symbol]:
    return [spin, partner_spin] if structure.partner else [spin]


def _rotating(model: Model) -> sp.Expr:
    return opened(model, model["energies"]["kinetic"]) - normal_velocity**2 / 2


def _by_slip(structure: Structure, model: Model) -> dict[sp.Symbol, sp.Expr]:
    """The rotation by the slips, for L = 0."""
    turning, spins, named = sp.Symbol("turning", real=True), _spins(structure), slips(structure)
    here = opened(model, DISTANCE)
    state = {orbital_momentum: here**2 * turning, **{s: turning - slip for s, slip in zip(spins, named, strict=True)}}
    momentum = opened(model, model["angular_momentum"]["angular_momentum"]).subs(state)
    (value,) = sp.solve(sp.expand(momentum), turning)
    return {s: sp.cancel(each.subs(turning, value)) for s, each in state.items()}


def slips_decay() -> Check:
    """A is that of the emitted equations; N A is symmetric and positive definite, with E_rot = s N s/2 for L = 0.

    And the shear takes s N A s from E_rot, so at least twice its smallest eigenvalue times E_rot.
    """
    left: list[sp.Expr] = []
    positive = True
    for structure in _COVERED:
        model, named = derive(structure), slips(structure)
        here = opened(model, DISTANCE)
        matrix = decay(structure, DISTANCE, DISTANCE, _LOG).subs(DISTANCE, here)
        rates = {state: _plain(rate) for state, rate in opened_rates(model).items()}
        moved = {s: orbital_momentum / here**2 - each for s, each in zip(named, _spins(structure), strict=True)}
        for row, each in enumerate(_spins(structure)):
            expected = -sum(matrix[row, k] * moved[s] for k, s in enumerate(named))
            left.append(rates[orbital_momentum] / here**2 - rates[each] - expected)
        by_slip = _by_slip(structure, model)
        energy = sp.cancel(_rotating(model).subs(by_slip, simultaneous=True))
        weight = sp.hessian(energy, named)
        product = (weight * matrix).applyfunc(sp.cancel)
        left += [product[0, -1] - product[-1, 0]]
        taken = _plain(opened(model, model["energy_rates"]["tangential_lubrication"]))
        vector = sp.Matrix(named)
        left.append(sp.cancel(taken.subs(by_slip, simultaneous=True) - (vector.T * product * vector)[0, 0]))
        minors = [product[:k, :k].det() / obliquity ** (2 * k) for k in range(1, len(named) + 1)]
        positive &= all(_is_positive(minor) for minor in minors)
    found = vanishing(
        "spin-down: slips decay", "ds/dt = -A s; dE_rot/dt by shear = -s N A s, N A positive definite", left
    )
    return found if positive else replace(found, ok=False, figure="N A is not positive definite")


def _is_positive(value: sp.Expr) -> bool:
    """True for a quotient of polynomials with positive coefficients, the centre distance written out."""
    top, bottom = sp.fraction(sp.factor(sp.together(value.subs(gap, sp.Symbol("x", positive=True)))))
    return all(sp.expand(part).is_positive is True for part in (top, bottom))


def mobility_is_monotonic() -> Check:
    """A = (K_line/r + K_spin r) F: with r at its largest in the first and its least in the second, a lower bound.

    F is the friction, K_line of rank one and K_spin diagonal, neither negative: the eigenvalues of K F = those of
    F^(1/2) K F^(1/2) grow with K.
    """
    left: list[sp.Expr] = []
    ok = True
    for structure in _COVERED:
        matrix = decay(structure, NEAR, FAR, _LOG)
        line = (matrix.subs(NEAR, 0) * FAR).applyfunc(sp.cancel)
        turn = ((matrix - line / FAR) / NEAR).applyfunc(sp.cancel)
        left += list(matrix - line / FAR - turn * NEAR)
        if structure.partner:
            friction = torque_matrix().subs({R_1: RADIUS, R_2: PARTNER_RADIUS}) / mu
            inverse = friction.inv()
            line, turn = (line * inverse).applyfunc(sp.cancel), (turn * inverse).applyfunc(sp.cancel)
            left += [line[0, 0] - each for each in line]
            left += [turn[0, 1], turn[1, 0]]
        scaled = [part / (aspect * _LOG) for part in (line[0, 0], *(turn[k, k] for k in range(turn.rows)))]
        ok &= all(_is_positive(part.subs(sp.Symbol("a", positive=True), 1)) for part in scaled)
        ok &= not any(part.free_symbols & {NEAR, FAR} for part in scaled)
    one, other = sp.symbols("one other", positive=True)
    two = sp.diag(one, other)
    left.append(one - slowest(two) - one**2 / (one + other))
    found = vanishing(
        "spin-down: least rate", "A = (K_line/r + K_spin r) F; det A/tr A is below both eigenvalues", left
    )
    return found if ok else replace(found, ok=False, figure="a part of the mobility is negative")


def rotation_falls() -> Check:
    """dE_rot/dt = -C u - D_t, du/dt = C - film: E_rot falls opening, and with C <= 2 E_rot/r, E_rot r^2 closing."""
    left: list[sp.Expr] = []
    squares = True
    for structure in _COVERED:
        model = derive(structure)
        rates = opened_rates(model)
        energy, here = _rotating(model), opened(model, DISTANCE)
        thrown = -opened(model, model["inward_force"]["inward_force"])
        change = sum(
            (energy.diff(state) * rate for state, rate in rates.items() if state != normal_velocity), sp.Integer(0)
        )
        taken = opened(model, model["energy_rates"]["tangential_lubrication"])
        left.append(change + thrown * normal_velocity + taken)
        film = FILM * normal_velocity * slot_call("film", "resistance", gap) / stokes
        left.append(rates[normal_velocity] - thrown + film)
        orbital = energy.subs(dict.fromkeys(_spins(structure), 0))
        left.append(thrown - 2 * aspect * orbital / here)
        spins = sp.Poly(sp.expand(energy - orbital), *_spins(structure), obliquity)
        squares &= all(c.is_positive and all(n % 2 == 0 for n in powers) for powers, c in spins.terms())
    found = vanishing(
        "spin-down: rotation", "dE_rot/dt = -C u - D_t, C = 2 E_orb/r <= 2 E_rot/r, du/dt = C - film", left
    )
    return found if squares else replace(found, ok=False, figure="the energy of the spins is no sum of squares")


def film_takes() -> tuple[Check, ...]:
    """S' = -resistance < 0, and a rebound counts most at the present gap."""
    checks = []
    deeper, now, speed = sp.symbols("deeper now speed", positive=True)
    excess = e_dry * (speed - (now + deeper) + now) - (now + deeper)  # S at the gap of the rebound is now + deeper
    worst = sp.expand(e_dry * speed - now - excess)
    for law in LAWS["film"].values():
        if any(each.name == "stopping" for each in law.functions):
            left = [law["stopping"].result.diff(gap) + law["resistance"].result, worst - (1 + e_dry) * deeper]
            checks.append(
                vanishing(f"spin-down: film, {law.name}", "S' = -resistance; rebounds from deeper are slower", left)
            )
    return tuple(checks)


def apart_from_shear() -> Check:
    """Without shear J is constant, and without J there is no centrifugal force: the gap moves head-on."""
    left: list[sp.Expr] = []
    for structure in _COVERED:
        rates = opened_rates(derive(structure))
        film = FILM * normal_velocity * slot_call("film", "resistance", gap) / stokes
        left += [rates[orbital_momentum].subs(SHEAR, 0), rates[normal_velocity].subs(orbital_momentum, 0) + film]
    return vanishing("spin-down: beyond the shear", "dJ/dt = 0 without shear, du/dt = -film with J = 0", left)


def as_emitted() -> Check:
    """The emitted margins are these bounds."""
    left: list[sp.Expr] = []
    for structure in (*_COVERED, replace(_ALONE, reduced=True)):
        model = derive(structure)
        named, own = dict(model.definitions), dict(definitions(structure))
        left += [named[symbol] - value for symbol, value in own.items()]
        left += [named[EDGE] - slot_call("shear", "edge", aspect), named[BEYOND] - (gap + sp.Min(1, EDGE)) / 2]
        found = model["spin_down_margins"].by_name
        film = slot_call("film", "stopping", gap) - slot_call("film", "stopping", BEYOND)
        outward = sp.Max(normal_velocity, -e_dry * normal_velocity)
        left += [found["stays"] - (stokes * outward + stokes * impulse(structure) - film), found["rate"] - RATE]
        opens = stokes * outward - slot_call("film", "stopping", gap)
        closes = -stokes * normal_velocity - slot_call("film", "stopping", EDGE) + slot_call("film", "stopping", gap)
        left += [found["apart"] - sp.Max(opens, closes), found["inside"] - (EDGE - gap)]
    return vanishing("spin-down: as emitted", "stays = St max(u, -e_dry u) + St impulse - (S(x) - S(d))", left)


def spin_down_certificate() -> tuple[Check, ...]:
    """Every check of the spin-down certificate."""
    parts = (slips_decay(), mobility_is_monotonic(), rotation_falls(), *film_takes())
    return (*parts, apart_from_shear(), as_emitted())
