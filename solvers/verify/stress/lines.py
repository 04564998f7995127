"""Comparison of traced boundaries with a dense scan of outcomes, on scenes derived from the presets."""

import time
from collections.abc import Iterator, Sequence

import numpy as np

from ....generated.automaton import OUTCOMES
from ...boundaries.boundary import boundary
from ...boundaries.trace import SHARPEST
from ...errors import InputError
from ...many.collide_many import collide_many
from ...scene.scene import Scene
from ...scene.schema import BRIDGE_LAWS, FILM_LAWS
from .verdict import FAST, RTOL, Case, Issue, Result, Verdict, physical_reason

SPAN = (2e-3, 30.0)  # range of the Stokes number
SAMPLES = 700  # samples of a line
_ANGLES = 3  # lines of a scene
_ABOUT = 10.0  # entries are scaled by up to this factor, up or down
_ASIDE = 3e-6  # relative distance from a change at which outcomes are compared
_BY_ROSENBROCK, _SOME = 10, 24  # every so many scenes, at so many Stokes numbers of a line
_PRESETS = ("granulation", "granulation", "pendulum", "granulation-dry-bridge")
_PLAIN = {
    "particles.dry_restitution": (0.1, 1.0),
    "particles.poisson_ratio": (0.0, 0.5),
    "bridge.contact_angle": (0.0, 1.2),
}
_VOLUME, _HAMAKER = (3e-3, 1.0), (1e-20, 1e-18)
Model = dict[str, str]


def drawn(count: int, models: int, seed: int) -> Iterator[Case]:
    """Random scenes derived from the presets, with three angles each, some head-on; deterministic.

    Arguments:
        models: number of combinations of preset, laws and partner.
    """
    random = np.random.default_rng(seed)
    kinds = [_model(random) for _ in range(max(1, models))]
    drawn_so_far = tries = 0
    while drawn_so_far < count:
        kind = kinds[tries % len(kinds)]
        tries += 1
        try:
            scene = _scene(f"line-{seed}-{drawn_so_far}", kind, random)
        except InputError:
            continue  # an impossible scene, such as a film thicker than its bridge
        steep = [
            float(random.choice([0.0, random.uniform(0.0, 1.5), random.uniform(0.0, 1.55)])) for _ in range(_ANGLES)
        ]
        yield Case(scene.name, scene, "lines", angles=tuple(steep))
        drawn_so_far += 1


def _model(random: np.random.Generator) -> Model:
    def one_of(*choices: str) -> str:
        return str(random.choice(choices))

    preset = one_of(*_PRESETS)
    model = {"preset": preset, "model.glass": one_of("literal", "literal", "film-corrected")}
    model["model.tangential"] = one_of("immersed", "immersed", "film")
    if preset == "pendulum":
        return model | {"pendulum.law": one_of("exact", "small-angle")}
    if preset == "granulation":
        model["bridge.law"] = one_of(*BRIDGE_LAWS)
    model["partner"] = one_of("", "", "", "sphere", "wall")
    model["attraction"] = one_of("", "", "van der Waals")
    return model | {"model.film": one_of("finite", *FILM_LAWS)}


def _scene(name: str, model: Model, random: np.random.Generator) -> Scene:
    """A preset with scaled entries; InputError where these contradict each other."""
    preset = Scene.load(model["preset"])

    def scaled() -> float:
        return float(_ABOUT ** random.uniform(-1.0, 1.0))

    def between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    entries: dict[str, float | str] = {}
    for entry, value in preset.si:
        if isinstance(value, str) or entry.startswith("impact."):
            continue
        if entry in _PLAIN:
            entries[entry] = float(random.uniform(*_PLAIN[entry]))
        elif entry == "bridge.volume":
            entries[entry] = between(*_VOLUME)
        else:
            entries[entry] = value * scaled()
    entries |= {entry: choice for entry, choice in model.items() if "." in entry}
    if model.get("attraction"):
        entries["attraction.hamaker"] = between(*_HAMAKER)
    if model.get("partner") == "wall":
        entries["partner.wall"] = "true"
    elif model.get("partner"):
        a, m = float(entries["particles.reduced_radius"]), float(entries["particles.reduced_mass"])
        entries |= {"partner.radius": 2 * a * scaled(), "partner.mass": 2 * m * scaled()}
    return Scene(name, preset.with_entries(entries).given)


def judge_lines(case: Case) -> Verdict:
    """Trace the lines of a case and compare them with collisions."""
    issues: list[Issue] = []
    start = time.process_time()
    traced = boundary(case.scene, angle=np.array(case.angles), stokes=SPAN, rtol=RTOL)
    cpu = time.process_time() - start
    by_rosenbrock = int(case.name.rpartition("-")[2]) % _BY_ROSENBROCK == 0
    for angle, changes, failure in zip(traced.angles, traced.changes, traced.failures, strict=True):
        if failure:
            issues.append(Issue("failure", ("boundary",), failure, physical_reason(failure)))
            continue
        at = np.array([one.stokes for one in changes])
        outcomes = [changes[0].before, *(one.after for one in changes)] if changes else None
        apart = at.size < 2 or bool(np.min(np.diff(np.log(at))) > 4 * _ASIDE)  # no change lies within another's reach
        beside = np.concatenate([at * (1 - _ASIDE), at * (1 + _ASIDE)]) if apart else np.zeros(0)
        scans = [(FAST, np.concatenate([np.geomspace(*SPAN, SAMPLES), beside]))]
        if by_rosenbrock:
            scans.append(("rosenbrock", np.concatenate([np.geomspace(*SPAN, _SOME), beside])))
        for engine, stokes in scans:
            issues += _denied(case.scene, angle, at, outcomes, engine, np.clip(stokes, *SPAN))
    return Verdict(case, {"boundary": Result(cpu=cpu)}, tuple(issues), None, None)


def _denied(
    scene: Scene, angle: float, at: np.ndarray, outcomes: Sequence[str] | None, engine: str, stokes: np.ndarray
) -> list[Issue]:
    """The first collision of a line whose outcome contradicts the changes below it, as text."""
    seen = collide_many(scene, stokes=stokes, angle=angle, rtol=max(RTOL, SHARPEST), engine=engine)["outcome"].values
    if outcomes is None:
        outcomes = [OUTCOMES[max(int(seen.max()), 0)]]
    expected = np.array([OUTCOMES.index(one) for one in outcomes])[np.searchsorted(at, stokes)]
    wrong = np.flatnonzero((seen >= 0) & (seen != expected))
    if not wrong.size:
        return []
    k = wrong[0]
    text = (
        f"at {np.degrees(angle):.8g} deg, St {stokes[k]:.10g}: {OUTCOMES[seen[k]]} by {engine}, "
        f"where the traced line has {OUTCOMES[expected[k]]} ({wrong.size} of {stokes.size} such)"
    )
    return [Issue("boundary", ("boundary", engine), text)]
