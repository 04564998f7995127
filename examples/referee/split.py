"""The difference between a host and our model, split into time step, regularised gap and physics.

    host - ours = (host - host at dt -> 0)                       time step
                + (ours with the host's gap - ours)              gap
                + (host at dt -> 0 - ours with the host's gap)   physics

The limit dt -> 0 is the host's law integrated as differential equations (`exact.py`) where these are written down, and
extrapolated from the host's finest time steps otherwise. The physics is split again by taking from our model, one thing
after the other, what the host's law lacks. Each term is a difference of two computed numbers; how large the parts of a
sum are depends on the order in which things are taken away.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import exact
import hosts
import numpy as np
import translate
from wetdoublet import Scene, collide_many

OUTCOMES = ("stick", "stick-rotate-separate", "bounce")
PARTS = (1, 2, 4)  # of the working time step
OF = ("outcome", "restitution", "tangential_restitution", "contact_time")


@dataclass(frozen=True)
class Impact:
    """One collision: speeds in m/s, radius of a sphere, and the gap at which all results are compared.

    Between the end of its own law and that gap, a pair flies straight on.
    """

    speed: float
    tangential: float
    radius: float
    compared: float

    def restitutions(self, u: float, w: float, gap: float) -> tuple[float, float]:
        """e_n and e_t of a pair that separates at a gap with radial velocity u and transverse velocity w."""
        later = w * (2 * self.radius + gap) / (2 * self.radius + self.compared)
        radial = math.sqrt(max(u**2 + w**2 - later**2, 0.0))
        return radial / self.speed, later / self.tangential if self.tangential else math.nan


@dataclass(frozen=True)
class Result:
    """Outcome and restitutions; a stick has e_n = 0 and no e_t."""

    outcome: str
    e_n: float
    e_t: float


STUCK = Result(OUTCOMES[0], 0.0, math.nan)


@dataclass(frozen=True)
class Referee:
    """What was computed: a row a collision, and what the rows mean."""

    rows: list[dict[str, Any]]
    law: str
    version: str
    terms: list[str]
    step: float
    exact: bool
    translation: translate.Translation


def referee(
    scene: Scene, host: str, law: str, stokes: Any, angles: Any, *, gap: float | None = None, step: float | None = None
) -> Referee:
    """Collide in the host and here, over a grid of Stokes numbers and angles (rad).

    Arguments:
        gap: the host's least gap, m; default the host's own or its manual's.
        step: the host's working time step, s; default as `translate` advises.
    """
    translate.check(scene)
    grid = [(float(St), float(angle)) for angle in np.atleast_1d(angles) for St in np.atleast_1d(stokes)]
    speeds = np.array([St / scene.stokes_per_speed for St, _ in grid])
    words = translate.LAWS[host, law](scene, gap, float(np.exp(np.mean(np.log(speeds)))))
    changes = [("gap", words.gap or {}), *words.physics]
    chain = _chain(scene, changes, speeds, [angle for _, angle in grid])
    terms = ["time step", *(name for name, _ in changes), "rest"]
    dt = words.step if step is None else step
    exactly = law in exact.LAWS and not scene.particles.friction
    film = scene.liquid.film_thickness
    version, rows = "", []
    for i, (St, angle) in enumerate(grid):
        speed = float(speeds[i])
        radius = 2 * scene.reduced_radius
        compared = max(words.end, scene.rupture_gap)
        impact = Impact(speed, speed * math.tan(angle) * (1 + film / (2 * radius)), radius, compared)
        ours = [_ours(link, i, impact) for link in chain]
        times = [float(link["contact_time"][i]) for link in chain]
        longest = max(20 * film / speed, *(3 * t for t in times if t > 0), 0.0)
        collisions = [[impact.speed, impact.tangential, dt / divisor] for divisor in PARTS]
        job = {"law": law, "parameters": words.parameters, "start": film, "end": words.end, "longest": longest}
        answer = hosts.run(host, job | {"collisions": collisions})
        version = answer["version"]
        coarse, finer, finest = (_host(state, words, impact) for state in answer["found"])
        limit = _limit(law, job, scene.reduced_mass, impact) if exactly else _extrapolated(finer, finest)
        row: dict[str, Any] = {"stokes": St, "angle_deg": math.degrees(angle), "speed": speed}
        row |= {"outcome_ours": ours[0].outcome, "outcome_host": coarse.outcome, "outcome_finest": finest.outcome}
        for name in ("e_n", "e_t"):
            mine = [getattr(result, name) for result in ours]
            at_dt, smallest, last = (getattr(result, name) for result in (coarse, finest, limit))
            row |= {f"{name}_ours": mine[0], f"{name}_host": at_dt, f"{name}_limit": last}
            row |= {f"{name}: left at dt/4": smallest - last, f"{name}: time step": at_dt - last}
            row |= {f"{name}: {term}": b - a for term, a, b in zip(terms[1:-1], mine, mine[1:])}
            row |= {f"{name}: rest": last - mine[-1]}
        rows.append(row)
    return Referee(rows, law, version, terms, dt, exactly, words)


def _chain(
    scene: Scene, changes: list[tuple[str, translate.Changes]], speeds: Any, angles: Any
) -> list[dict[str, Any]]:
    """Our collisions: as the scene says, with the host's gap, and with less and less of what the host lacks."""
    done, now = [], scene
    for name, change in [("the scene", {}), *changes]:
        now = translate.changed(now, change) if change else now
        data = collide_many(now, speed=speeds, angle=angles, of=OF)
        failed = [reason for reason in data["reason"].values if reason]
        if failed:
            raise SystemExit(f"{name}: {failed[0]}")
        done.append({"end": now.rupture_gap, **{key: data[key].values for key in OF}})
    return done


def _ours(columns: dict[str, Any], i: int, impact: Impact) -> Result:
    outcome = int(columns["outcome"][i])
    if outcome == 0:
        return STUCK
    u = float(columns["restitution"][i]) * impact.speed
    w = float(columns["tangential_restitution"][i]) * impact.tangential if impact.tangential else 0.0
    return Result(OUTCOMES[outcome], *impact.restitutions(u, w, columns["end"]))


def _host(state: dict[str, Any], words: translate.Translation, impact: Impact) -> Result:
    """Of the host's last state; a pair that has not separated in time counts as stuck."""
    apart, moving = np.array(state["position"]), np.array(state["velocity"])
    if not (np.isfinite(apart).all() and np.isfinite(moving).all()):
        return Result("not a number", math.nan, math.nan)
    r = float(np.linalg.norm(apart))
    if r - 2 * impact.radius < words.end:
        return STUCK
    u, w = float(apart @ moving) / r, float(apart[0] * moving[1] - apart[1] * moving[0]) / r
    outcome = OUTCOMES[2] if state["touched"] else OUTCOMES[1] if words.at_distance else "no contact"
    return Result(outcome, *impact.restitutions(u, w, r - 2 * impact.radius))


def _limit(law: str, job: dict[str, Any], mass: float, impact: Impact) -> Result:
    """Of the host's law as differential equations."""
    pair = exact.Pair(impact.radius, mass, impact.speed, impact.tangential)
    answer = exact.collide(law, job["parameters"], pair, job["end"], job["longest"])
    if answer is None:
        return STUCK
    return Result("", *impact.restitutions(*answer, job["end"]))


def _extrapolated(finer: Result, finest: Result) -> Result:
    """From two time steps of a scheme of the first order; the finest where the outcome depends on the step."""
    if finer.outcome != finest.outcome:
        return finest
    return Result(finest.outcome, 2 * finest.e_n - finer.e_n, 2 * finest.e_t - finer.e_t)
