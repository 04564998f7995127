"""Checks of the spin-down certificate: each of its steps, on the emitted equations."""

from dataclasses import replace

import sympy as sp

from ..equations.certificates import spin_down
from ..equations.model import Model, derive
from ..laws import LAWS, filled, is_slot_call, slot_call
from ..physics.forces import FILM, SHEAR
from ..physics.partners.pair import PARTNER_RADIUS, RADIUS
from ..physics.partners.rolling import R_1, R_2, torque_matrix
from ..physics.scaling import DISTANCE
from ..physics.structure import FREE, Structure
from ..vocabulary import quantities as q
from .base import MIDGAP, SIZES, Check, Evidence, check, checks, vanishing

_STRUCTURES = (FREE, replace(FREE, partner="pair"))
_LOG = sp.Symbol("log_factor", positive=True)


def _sheared_at_midgap(expression: sp.Expr) -> sp.Expr:
    """The expression with the lever arm at mid-gap, the shear acting (flag 1), and `_LOG` for its logarithm."""
    result = filled(expression, MIDGAP).subs(SHEAR, 1)
    calls = {n: _LOG for n in result.atoms(sp.Function) if is_slot_call(n) and n.func.__name__.startswith("shear")}
    return result.xreplace(calls)


def _spins(structure: Structure) -> list[sp.Symbol]:
    return [q.spin, q.partner_spin] if structure.partner else [q.spin]


def _rotation_energy(model: Model) -> sp.Expr:
    """E_rot: the kinetic energy without that of the normal velocity."""
    return model.expanded(model["energies"]["kinetic"], SIZES) - q.normal_velocity**2 / 2


def _by_slip(structure: Structure, model: Model) -> dict[sp.Symbol, sp.Expr]:
    """J and the spins in terms of the slips, for L = 0."""
    orbital_rate, spins, slips = sp.Symbol("orbital_rate", real=True), _spins(structure), spin_down.slips(structure)
    here = model.expanded(DISTANCE, SIZES)
    state = {
        q.orbital_momentum: here**2 * orbital_rate,
        **{s: orbital_rate - slip for s, slip in zip(spins, slips, strict=True)},
    }
    momentum = model.expanded(model["angular_momentum"]["angular_momentum"], SIZES).subs(state)
    (value,) = sp.solve(sp.expand(momentum), orbital_rate)
    return {s: sp.cancel(rate.subs(orbital_rate, value)) for s, rate in state.items()}


@check("spin-down: slips decay", "ds/dt = -A s; dE_rot/dt by shear = -s N A s, N A positive definite")
def slips_decay() -> Evidence:
    """A is that of the emitted equations; N A is symmetric and positive definite, with E_rot = s N s/2 for L = 0.

    The shear takes s N A s per time from E_rot: at least twice the smallest eigenvalue of A, times E_rot.
    """
    positive = True
    for structure in _STRUCTURES:
        model, slips = derive(structure), spin_down.slips(structure)
        here = model.expanded(DISTANCE, SIZES)
        matrix = spin_down.decay(structure, DISTANCE, DISTANCE, _LOG).subs(DISTANCE, here)
        rates = {state: _sheared_at_midgap(rate) for state, rate in model.by_state("right_hand_side", SIZES).items()}
        slip_of = {s: q.orbital_momentum / here**2 - spin for s, spin in zip(slips, _spins(structure), strict=True)}
        for row, spin in enumerate(_spins(structure)):
            expected = -sum(matrix[row, k] * slip_of[s] for k, s in enumerate(slips))
            yield rates[q.orbital_momentum] / here**2 - rates[spin] - expected
        by_slip = _by_slip(structure, model)
        energy = sp.cancel(_rotation_energy(model).subs(by_slip, simultaneous=True))
        weight = sp.hessian(energy, slips)
        product = (weight * matrix).applyfunc(sp.cancel)
        yield product[0, -1] - product[-1, 0]
        dissipated = _sheared_at_midgap(model.expanded(model["energy_rates"]["tangential_lubrication"], SIZES))
        vector = sp.Matrix(slips)
        yield sp.cancel(dissipated.subs(by_slip, simultaneous=True) - (vector.T * product * vector)[0, 0])
        minors = [product[:k, :k].det() / q.obliquity ** (2 * k) for k in range(1, len(slips) + 1)]
        positive &= all(_is_positive(minor) for minor in minors)
    yield positive, "N A is not positive definite"


def _is_positive(value: sp.Expr) -> bool:
    """True for a quotient of polynomials with positive coefficients, the centre distance written out."""
    top, bottom = sp.fraction(sp.factor(sp.together(value.subs(q.gap, sp.Symbol("x", positive=True)))))
    return all(sp.expand(side).is_positive is True for side in (top, bottom))


@check("spin-down: least rate", "A = (K_line/r + K_spin r) F; det A/tr A is below both eigenvalues")
def mobility_is_monotonic() -> Evidence:
    """A = (K_line/r + K_spin r) F: with r at its largest in the first and its least in the second, a lower bound.

    F is the friction, K_line of rank one and K_spin diagonal, neither negative: the eigenvalues of K F = those of
    F^(1/2) K F^(1/2) grow with K.
    """
    ok = True
    for structure in _STRUCTURES:
        matrix = spin_down.decay(structure, spin_down.NEAR, spin_down.FAR, _LOG)
        line = (matrix.subs(spin_down.NEAR, 0) * spin_down.FAR).applyfunc(sp.cancel)
        turn = ((matrix - line / spin_down.FAR) / spin_down.NEAR).applyfunc(sp.cancel)
        yield from matrix - line / spin_down.FAR - turn * spin_down.NEAR
        if structure.partner:
            friction = torque_matrix().subs({R_1: RADIUS, R_2: PARTNER_RADIUS}) / q.mu
            inverse = friction.inv()
            line, turn = (line * inverse).applyfunc(sp.cancel), (turn * inverse).applyfunc(sp.cancel)
            yield from [line[0, 0] - entry for entry in line]
            yield from (turn[0, 1], turn[1, 0])
        scaled = [mobility / (q.aspect * _LOG) for mobility in (line[0, 0], *(turn[k, k] for k in range(turn.rows)))]
        ok &= all(_is_positive(entry.subs(sp.Symbol("a", positive=True), 1)) for entry in scaled)
        ok &= not any(entry.free_symbols & {spin_down.NEAR, spin_down.FAR} for entry in scaled)
    rate, other = sp.symbols("one other", positive=True)
    two = sp.diag(rate, other)
    yield rate - spin_down.slowest(two) - rate**2 / (rate + other)
    yield ok, "a part of the mobility is negative"


@check("spin-down: rotation", "dE_rot/dt = -C u - D_t, C = 2 E_orb/r <= 2 E_rot/r, du/dt = C - film")
def rotation_falls() -> Evidence:
    """dE_rot/dt = -C u - D_t, du/dt = C - film: E_rot falls opening, and with C <= 2 E_rot/r, E_rot r^2 closing."""
    squares = True
    for structure in _STRUCTURES:
        model = derive(structure)
        rates = model.by_state("right_hand_side", SIZES)
        energy, here = _rotation_energy(model), model.expanded(DISTANCE, SIZES)
        thrown = -model.expanded(model["inward_force"]["inward_force"], SIZES)
        change = sp.Add(*(energy.diff(state) * rate for state, rate in rates.items() if state != q.normal_velocity))
        dissipated = model.expanded(model["energy_rates"]["tangential_lubrication"], SIZES)
        yield change + thrown * q.normal_velocity + dissipated
        film = FILM * q.normal_velocity * slot_call("film", "resistance", q.gap) / q.stokes
        yield rates[q.normal_velocity] - thrown + film
        orbital = energy.subs(dict.fromkeys(_spins(structure), 0))
        yield thrown - 2 * q.aspect * orbital / here
        spins = sp.Poly(sp.expand(energy - orbital), *_spins(structure), q.obliquity)
        squares &= all(c.is_positive and all(n % 2 == 0 for n in powers) for powers, c in spins.terms())
    yield squares, "the energy of the spins is no sum of squares"


@checks
def film_takes() -> tuple[Check, ...]:
    """S' = -resistance < 0, and a rebound counts most at the present gap."""
    checks = []
    deeper, now, speed = sp.symbols("deeper now speed", positive=True)
    excess = q.e_dry * (speed - (now + deeper) + now) - (now + deeper)  # S at the gap of the rebound is now + deeper
    worst = sp.expand(q.e_dry * speed - now - excess)
    for law in LAWS["film"].values():
        if any(function.name == "stopping" for function in law.functions):
            residuals = [law["stopping"].result.diff(q.gap) + law["resistance"].result, worst - (1 + q.e_dry) * deeper]
            statement = "S' = -resistance; rebounds from deeper are slower"
            checks.append(vanishing(f"spin-down: film, {law.name}", statement, residuals))
    return tuple(checks)


@check("spin-down: beyond the shear", "dJ/dt = 0 without shear, du/dt = -film with J = 0")
def apart_from_shear() -> Evidence:
    """Without shear J is constant, and without J there is no centrifugal force: the gap moves head-on."""
    for structure in _STRUCTURES:
        rates = derive(structure).by_state("right_hand_side", SIZES)
        film = FILM * q.normal_velocity * slot_call("film", "resistance", q.gap) / q.stokes
        yield from (
            rates[q.orbital_momentum].subs(SHEAR, 0),
            rates[q.normal_velocity].subs(q.orbital_momentum, 0) + film,
        )


@check("spin-down: as emitted", "stays = St max(u, -e_dry u) + St impulse - (S(x) - S(d))")
def as_emitted() -> Evidence:
    """The emitted margins are these bounds."""
    for structure in (*_STRUCTURES, replace(FREE, reduced=True)):
        model = derive(structure)
        named, bounds = dict(model.definitions), dict(spin_down.definitions(structure))
        yield from [named[symbol] - value for symbol, value in bounds.items()]
        yield from (
            named[spin_down.EDGE] - slot_call("shear", "edge", q.aspect),
            named[spin_down.BEYOND] - (q.gap + sp.Min(1, spin_down.EDGE)) / 2,
        )
        emitted = model["spin_down_margins"].by_name
        here, beyond, edge = (slot_call("film", "stopping", at) for at in (q.gap, spin_down.BEYOND, spin_down.EDGE))
        opens = q.stokes * sp.Max(q.normal_velocity, -q.e_dry * q.normal_velocity) - here
        closes = -q.stokes * q.normal_velocity - edge + here
        yield emitted["stays"] - (opens + q.stokes * spin_down.impulse(structure) + beyond)
        yield from (emitted["rate"] - spin_down.RATE, emitted["apart"] - sp.Max(opens, closes))
        yield emitted["inside"] - (spin_down.EDGE - q.gap)
