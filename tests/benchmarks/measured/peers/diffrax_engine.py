"""Collisions by diffrax: Tsit5 with events, jitted and vectorised over all collisions, from the emitted equations.

A trajectory is a loop over phases, each ended by diffrax's own event with a Newton root finder; like scipy's methods it
looks at signs at the ends of steps. The level that proves a stick is an event of the energy, computed beforehand.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from wetdoublet.solvers.scene.scene import Scene

from ..tasks import Answer, Impact, dimensionless
from ..timing import Call
from .automaton import CERTIFIED, automata
from .heyoka_engine import starts, translated

_HORIZON, _STEPS, _PHASES = 1e10, 20_000, 12
_RUNNING, SEPARATED, _STUCK, _FAILED = range(4)


def collisions(scene: Scene, impacts: Sequence[Impact], rtol: float) -> Call:
    """All impacts in one call; compiled at the first. ComputationError for what it does not do."""
    import jax

    jax.config.update("jax_enable_x64", True)
    numbers = [dimensionless(scene, impact) for impact in impacts]
    followed = automata(numbers, rtol)
    choice, names = followed[0].model.choice, tuple(followed[0].model.groups)
    begun = starts(followed, names)
    states, parameters = (np.array([getattr(each, name) for each in begun]) for name in ("state", "parameters"))
    rebound = np.array([each.reversed for each in begun])
    run = jax.jit(jax.vmap(trajectory(choice, names, followed[0].proof, rtol)))

    def every() -> list[np.ndarray]:
        return [np.asarray(each) for each in run(states, parameters, rebound)]

    def read(found: list[np.ndarray]) -> list[Answer | str]:
        ended, e_n, met = found
        outcomes = np.where(ended == _STUCK, "stick", np.where(met, "bounce", "stick-rotate-separate"))
        return [
            Answer(str(outcome), float(value) if code == SEPARATED else 0.0)
            if code in (SEPARATED, _STUCK)
            else "failed"
            for code, outcome, value in zip(ended, outcomes, e_n)
        ]

    return Call(every, read)


def trajectory(choice: Any, names: tuple[str, ...], proved: str, rtol: float) -> Callable[..., Any]:
    """The trajectory of one collision as a function that jax can transform."""
    import diffrax
    import jax
    import jax.numpy as jnp
    import optimistix

    structure, laws = translated(choice, lambda word: getattr(jnp, word))
    bridge, states = choice.law("bridge") is not None, structure.STATES

    def unpacked(y: Any, args: Any) -> tuple[dict[str, Any], dict[str, Any], Any, Any]:
        return dict(zip(states, y)), dict(zip(names, args)), args[len(names)], args[-1]

    def rates(_: Any, y: Any, args: Any) -> Any:
        state, groups, film, _level = unpacked(y, args)
        found = list(structure.right_hand_side(state, groups, laws, film, 1).values())
        if proved == "energy" and bridge:
            found.append(structure.energy_rates(state, groups, laws, film, 1)["capillary"])
        return args[-2] * jnp.stack(
            [jnp.asarray(each, float) for each in found]
        )  # at rest where a trajectory has ended

    def events(y: Any, args: Any) -> dict[str, Any]:
        state, groups, film, level = unpacked(y, args)
        table = structure.events(state, groups, laws)
        found = {"glass": table["glass"], "contact": jnp.minimum(table["elastic"], table["rough"])}
        found["rupture"] = table["rupture"]
        found |= {name: table[name] for name in ("half_turn", "unwinding") if name in table}
        if bridge:
            found["film_edge"] = (2 * film - 1) * table["film_edge"]
        if proved == "energy":
            energy = sum(structure.energies(state, groups, laws).values())
            found[CERTIFIED] = energy + (y[-1] if bridge else 0.0) - level
        return found

    def watched(name: str) -> Callable[..., Any]:
        return lambda t, y, args, **_: events(y, args)[name]

    width = len(states) + int(proved == "energy" and bridge)
    known = [name for name in ("glass", "contact", "rupture", "half_turn", "unwinding", "film_edge", CERTIFIED)
             if name in jax.eval_shape(events, jnp.zeros(width), jnp.ones(len(names) + 3))]  # fmt: skip
    event = diffrax.Event(
        [watched(name) for name in known],
        optimistix.Newton(rtol, 1e-3 * rtol, optimistix.rms_norm),
        direction=[False] * len(known),
    )
    term, controller = diffrax.ODETerm(rates), diffrax.PIDController(rtol=rtol, atol=1e-3 * rtol)

    def phase(carry: Any) -> Any:
        y, args, met, _, count = carry
        found = diffrax.diffeqsolve(
            term, diffrax.Tsit5(), 0.0, _HORIZON, 1e-3, y, args, saveat=diffrax.SaveAt(t1=True),
            stepsize_controller=controller, event=event, max_steps=_STEPS, throw=False,
            adjoint=diffrax.ForwardMode(),
        )  # fmt: skip
        y = found.ys[0]
        hit = dict(zip(known, found.event_mask))
        rebounds = hit["glass"] | hit["contact"]
        speed = jnp.where(rebounds, -dict(zip(names, args))["dry_restitution"] * y[1], y[1])
        y = y.at[1].set(speed)
        if bridge:
            args = args.at[len(names)].set(jnp.where(hit["film_edge"], 1 - args[len(names)], args[len(names)]))
        stuck = hit.get("half_turn", False) | hit.get("unwinding", False) | hit.get(CERTIFIED, False)
        if proved:
            stuck = stuck | (rebounds & (events(y, args)[CERTIFIED] < 0))
        any_hit = jnp.any(jnp.stack(list(hit.values())))
        ended = jnp.where(hit["rupture"], SEPARATED, jnp.where(stuck, _STUCK, jnp.where(any_hit, _RUNNING, _FAILED)))
        args = args.at[-2].set(jnp.where(ended == _RUNNING, 1.0, 0.0))
        return y, args, met | rebounds, ended, count + 1

    def whole(y: Any, args: Any, met: Any) -> Any:
        going = lambda carry: (carry[3] == _RUNNING) & (carry[4] < _PHASES)  # noqa: E731 # as jax asks for it
        y, args, met, ended, _ = jax.lax.while_loop(going, phase, (y, args, met, jnp.asarray(_RUNNING), jnp.asarray(0)))
        return ended, y[1], met

    return whole
