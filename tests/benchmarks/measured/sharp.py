"""How exact an answer can be asked for: e_n of the kernel against 80-bit numbers, in units of its conditioning."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec
from typing import Any

import numpy as np
from wetdoublet.generated.automaton import CRITERIA
from wetdoublet.solvers.model.dimensionless import Problem

from .gradient_task import Gradients
from .peers.automaton import automata
from .peers.engines import KERNEL, engines
from .peers.heyoka_engine import HORIZON, starts, system
from .tasks import TASKS

Record = dict[str, Any]

TIGHT, TIGHTER = 1e-17, 1e-18  # tolerances of the two long-double computations, whose difference is their error
RTOLS = (1e-9, 1e-10, 1e-11, 1e-12, 1e-13)
GOAL = 1e-13  # of e_n, relative, times the conditioning


@dataclass
class _Trajectory:
    """One collision at a time by heyoka in long double: no certificate, since all of them separate."""

    integrator: Any = None
    dry: Any = 1.0
    film: int = 0
    restitution: Any = None
    calls: list[str] = field(default_factory=list)

    def callback(self, event: str) -> Callable[..., bool]:
        """What heyoka calls at an event; False ends the trajectory."""

        def rebounds(ta: Any, _: int) -> bool:
            ta.state[1] *= -self.dry
            return True

        def edge(ta: Any, _: int) -> bool:
            ta.pars[self.film] = 1.0 if ta.state[1] < 0 else 0.0
            return True

        def ends(ta: Any, _: int) -> bool:
            self.restitution = ta.state[1] if event == "rupture" else None
            return False

        return rebounds if event in CRITERIA else edge if event == "film_edge" else ends


def long_double(numbers: Sequence[Problem], rtol: float) -> np.ndarray:
    """e_n of collisions that separate, by heyoka's Taylor integrator in 80-bit numbers; NaN where one does not."""
    import heyoka

    followed = automata(numbers, 1e-13)
    equations = system(followed[0].model.choice, [each.groups for each in numbers], "")
    trajectory = _Trajectory(dry=np.longdouble(numbers[0].groups["dry_restitution"]), film=len(equations.varying))
    begun = starts(followed, equations.varying)
    either, falling = heyoka.event_direction.any, heyoka.event_direction.negative
    states = [start.state[: len(equations.rates)].astype(np.longdouble) for start in begun]  # no work of the bridge
    trajectory.integrator = ta = heyoka.taylor_adaptive(
        equations.rates,
        state=states[0],
        pars=begun[0].parameters[:-1].astype(np.longdouble),
        t_events=[
            heyoka.t_event(
                g,
                callback=trajectory.callback(name),
                direction=either if name == "film_edge" else falling,
                fp_type=np.longdouble,
            )
            for name, g in equations.events.items()
        ],
        tol=np.longdouble(rtol),
        compact_mode=True,
        fp_type=np.longdouble,
    )
    found = []
    for state, start in zip(states, begun, strict=True):
        trajectory.restitution = None
        ta.time = np.longdouble(0)
        ta.reset_cooldowns()
        ta.state[:], ta.pars[:] = state, start.parameters[:-1]
        ta.propagate_until(np.longdouble(HORIZON), max_steps=100_000)
        found.append(np.longdouble(np.nan) if trajectory.restitution is None else trajectory.restitution)
    return np.array(found)


def sharp(tell: Callable[[str], None] = lambda _: None) -> list[Record]:
    """Of each task the reference's own error, and the kernel's by tolerance: relative, and over the conditioning."""
    kernel = next(each for each in engines() if each.name == KERNEL)
    if not find_spec("heyoka") or kernel.missing or np.finfo(np.longdouble).eps > 1e-18:
        return []
    assert kernel.many is not None
    found = []
    for task in TASKS:
        asked = Gradients.of(task)
        tell(f"{task.preset}: 80-bit values")
        first, truth = (long_double(asked.numbers, rtol) for rtol in (TIGHT, TIGHTER))
        slope = asked.truth[:, asked.names.index("impact.speed")]
        conditioning = np.maximum(1.0, np.abs(slope / truth.astype(float)))
        rows = []
        for rtol in RTOLS:
            tell(f"{task.preset}: kernel at {rtol:.0e}")
            answers = kernel.many(asked.scene, asked.impacts, rtol)()
            e_n = np.array([np.nan if isinstance(each, str) else each.restitution for each in answers])
            apart = np.abs(e_n / truth - 1).astype(float)
            rows.append(
                {"rtol": rtol, "relative": float(apart.max()), "conditioned": float((apart / conditioning).max())}
            )
        own = np.abs(first / truth - 1).astype(float)
        found.append(
            {
                "preset": task.preset,
                "collisions": len(asked.impacts),
                "conditioning": float(conditioning.max()),
                "reference": float((own / conditioning).max()),
                "rows": rows,
            }
        )
    return found
