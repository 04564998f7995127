"""The model of a scene: its structure module with the chosen laws in their slots, as CasADi expressions."""

import math
from collections.abc import Mapping
from functools import cached_property, lru_cache, partial, reduce
from itertools import islice
from types import ModuleType
from typing import Any

import numpy as np
from casadi import SX, Function, densify, fmax, fmin, vertcat

from ...generated.assemble import Laws, symbols, vector
from ...generated.automaton import EVENTS, LEAST_SLIP, Event
from ..host import emitted
from ..host.casadi_calls import Buffered
from ..host.thread_caches import own_cache
from ..scene.groups import GAPS, law_module
from ..scene.scene import Scene
from ..scene.user_model import Package
from ..scene.user_model_declared import OwnEvent
from .key import ModelKey

# Fraction of the contact gap. Solutions stay above the contact gap; the floor keeps trial stages out of x <= 0.
_FLOOR = 0.5
_SMALLEST_GAP = 1e-12

_Function = tuple[str, str]  # of a law: slot and name
_Guards = dict[_Function, tuple[SX, ...]]


@lru_cache(maxsize=256)
def select_model(scene: Scene, oblique: bool, full: bool = False, fold: bool = False, space: bool = False) -> ModelKey:
    """The key of the smallest structure that represents the scene.

    Arguments:
        oblique: something moves sideways: the impact angle or a spin is not zero.
        full: keep the spin as a state even where angular momentum would eliminate it (for the ledger).
        fold: treat a partner that equals the sphere as such; not for derivatives along the partner's size.
        space: two spheres whose motion is not planar, each with its own spin; the lever arm is at mid-gap.
    """
    alike = fold and scene.radius_ratio == 1 and scene.mass_ratio == 1 and scene.impact.partner_spin is None
    equal = not (scene.pair or scene.wall) or alike
    partner = "" if equal or not oblique else "wall" if scene.wall else "pair"  # head-on, only a and m matter
    partner = "space" if space else partner
    friction = oblique and scene.particles.friction is not None
    free = oblique and partner in ("", "space") and scene.pendulum is None
    package = scene.package
    turned = package is not None and (  # by a declared event or term
        any(event.spins for event in package.events) or (package.terms is not None and package.terms.rotates)
    )
    reduced = free and not (full or friction or turned) and scene.law_has("arm", "balanced")
    spread = scene.law_has("film", "spread")
    words = {
        "bridge": scene.bridge is not None,
        "strings": scene.pendulum is not None,
        "attraction": scene.attraction is not None,
        "spread": spread,
        "reduced": reduced,
        "friction": friction,
        "all": friction and scene.model.contact_friction == "all",
    }
    parts = ["oblique" if oblique else "head_on", *([partner] if partner else [])]
    parts += [word for word, flag in words.items() if flag]
    laws = [(slot, scene.law_of(slot)) for slot in ("film", "glass")]
    if oblique:
        laws.append(("shear", scene.law_of("shear")))
        if not reduced and partner not in ("wall", "space"):
            laws.append(("arm", scene.model.arm))
    if scene.bridge is not None:
        laws.append(("bridge", scene.bridge.law))
    if scene.pendulum is not None:
        laws.append(("strings", scene.pendulum.law))
    if scene.attraction is not None:
        laws.append(("attraction", scene.law_of("attraction")))
    return ModelKey("_".join(parts), tuple(laws), package)


def _structure(choice: ModelKey) -> ModuleType:
    slots = tuple(slot for slot, _ in choice.laws)
    if choice.package is not None and choice.package.changes(slots):
        return choice.package.structure(choice.structure)
    return emitted.module(choice.structure)


def _law(package: Package | None, slot: str, name: str) -> Any:
    law = law_module(package, slot, name)
    return law if package is None or name in package.laws(slot) else _Narrow(law, package, slot)


class _Narrow:
    """A law of the library in a slot to which a user's model passes more arguments; these are dropped."""

    def __init__(self, law: ModuleType, package: Package, slot: str) -> None:
        self._law, self._package, self._slot = law, package, slot

    def __getattr__(self, function: str) -> Any:
        law_function, more = getattr(self._law, function), len(self._package.extra(self._slot, function))
        return (lambda *arguments: law_function(*arguments[: len(arguments) - more])) if more else law_function


class _Sided:
    """A user's law on given sides of its kinks; `guards` receives those of its functions that are called without."""

    def __init__(self, slot: str, law: Any, sides: Mapping[_Function, tuple[int, ...]], guards: _Guards) -> None:
        self._slot, self._law, self._sides, self._guards = slot, law, sides, guards

    def __getattr__(self, function: str) -> Any:
        law_function, key = getattr(self._law, function), (self._slot, function)
        if key in self._sides:
            return partial(law_function, sides=self._sides[key])
        if function not in getattr(self._law, "KINKS", {}):
            return law_function

        def called(*arguments: SX) -> Any:
            self._guards[key] = getattr(self._law, f"{function}_kinks")(*arguments)
            return law_function(*arguments)

        return called


class Model:
    """A structure with its laws: expressions in shared symbols `state` and `groups`.

    Use `load`, which caches.
    """

    def __init__(self, choice: ModelKey) -> None:
        self.choice = choice
        self.structure: ModuleType = _structure(choice)
        self.laws = Laws(**{slot: _law(choice.package, slot, name) for slot, name in choice.laws})
        self.state: dict[str, SX] = symbols(self.structure.STATES)
        self.groups: dict[str, SX] = symbols(self.structure.GROUPS)
        self._functions: dict[tuple[str, int, int], Function] = {}
        self._fast: dict[tuple[str, int, int], Buffered] = {}
        self._names: dict[tuple[str, int, int], tuple[str, ...]] = {}

    @property
    def oblique(self) -> bool:
        return "orbital_momentum" in self.state or self.wall or self.space

    @property
    def wall(self) -> bool:
        return "decay" in self.state

    @property
    def space(self) -> bool:
        return "normal_x" in self.state

    @property
    def reduced(self) -> bool:
        return "orbital_momentum" in self.state and "spin" not in self.state

    @property
    def friction(self) -> bool:
        return self.has("rubbed")

    @property
    def cavitates(self) -> bool:
        """True if the film cavitates, so that it does not resist separation."""
        return hasattr(self.laws.film, "suction")

    @property
    def edged(self) -> bool:
        """True if the film ends at x = x0, and not at the bridge's rupture."""
        return not self.bridge or "film_edge" in self.names("events")

    @cached_property
    def own_events(self) -> tuple[OwnEvent, ...]:
        package = self.choice.package
        return () if package is None else package.events_in(self.choice.structure)

    @property
    def own_terms(self) -> bool:
        """True if a user's model adds terms to the equations."""
        return self.choice.package is not None and self.choice.package.terms is not None

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """Rows of all events, in order of precedence."""
        return (*EVENTS, *(event.row for event in self.own_events))

    @cached_property
    def _guards(self) -> _Guards:
        """The guards of the kinks that the forces of a user's laws have."""
        guards: _Guards = {}
        if self.choice.package is None:
            return guards
        self.structure.right_hand_side(self.guarded, self.groups, self._sided({}, guards))
        return guards

    @cached_property
    def kinks(self) -> dict[str, SX]:
        """These guards by name, each zero at a kink, in the order of a region's sides."""
        rows = ((*key, k, guard) for key, guards in self._guards.items() for k, guard in enumerate(guards))
        return {f"kink_{slot}_{function}_{k}": guard for slot, function, k, guard in rows}

    def _sided(self, sides: Mapping[_Function, tuple[int, ...]], guards: _Guards) -> Laws:
        laws: dict[str, Any] = {
            slot: _Sided(slot, getattr(self.laws, slot), sides, guards) for slot, _ in self.choice.laws
        }
        return Laws(**laws)

    @property
    def escape(self) -> str:
        """Name of the function with the energies that can separate the pair."""
        return "escape_energy" if self.wall else "energies"

    @cached_property
    def works(self) -> tuple[str, ...]:
        return tuple(
            work for work, slot in (("capillary", "bridge"), ("attraction", "attraction")) if self.choice.law(slot)
        )

    @property
    def bridge(self) -> bool:
        return self.choice.law("bridge") is not None

    @property
    def strings(self) -> bool:
        return self.choice.law("strings") is not None

    @cached_property
    def contact_gap(self) -> SX:
        """Gap at which the solids touch: the largest at which a rebound criterion is met."""
        return reduce(fmax, (self.groups[name] for name in GAPS.values()))

    @cached_property
    def guarded(self) -> dict[str, SX]:
        """The state with a positive lower limit of the gap, for rates; no effect on solutions."""
        floor = fmax(_FLOOR * fmin(self.contact_gap, 1), _SMALLEST_GAP)
        return {**self.state, "gap": fmax(self.state["gap"], floor)}

    @cached_property
    def column(self) -> SX:
        return vector(self.state)

    @cached_property
    def parameters(self) -> SX:
        return vector(self.groups)

    def __call__(
        self,
        name: str,
        state: Mapping[str, SX] | None = None,
        region: Mapping[str, int | SX] | None = None,
        sides: tuple[int, ...] = (),
    ) -> dict[str, SX]:
        """A function of the structure module as named expressions; `sides` are those of the laws' kinks, if fixed."""
        laws, more = self.laws, iter(sides)
        if sides:
            laws = self._sided({key: tuple(islice(more, len(guards))) for key, guards in self._guards.items()}, {})
        outputs: dict[str, SX] = getattr(self.structure, name)(
            self.state if state is None else state, self.groups, laws, **(region or {})
        )
        return outputs

    def extra(self, slot: str, function: str) -> list[SX]:
        """Additional arguments that a user's model passes to a slot's function: symbols of groups or states."""
        package = self.choice.package
        names = () if package is None else package.extra(slot, function)
        return [self.groups[name] if name in self.groups else self.state[name] for name in names]

    def has(self, name: str) -> bool:
        return name in self.structure.FUNCTIONS

    def function(self, name: str, film: int = 1, shear: int = 1) -> Function:
        """A function of the structure module as a CasADi Function (state, groups) -> column."""
        key = (name, film, shear)
        if key not in self._functions:
            self._functions[key] = self._built(name, film, shear)
        return self._functions[key]

    def _built(self, name: str, film: int, shear: int) -> Function:
        values = self(name, region=self._region(name, film, shear))
        column = densify(vertcat(*(SX(value) for value in values.values())))
        return Function(name, [self.column, self.parameters], [column])

    def values(self, name: str, y: np.ndarray, p: np.ndarray, film: int = 1, shear: int = 1) -> dict[str, float]:
        """A function's named values at a state (leading entries of `y`) and groups `p`."""
        numbers = self._buffered(name, film, shear)(y[: len(self.state)], p)
        return dict(zip(self.names(name, film, shear), numbers.tolist(), strict=True))

    def _buffered(self, name: str, film: int, shear: int) -> Buffered:
        key = (name, film, shear)
        if key not in self._fast:
            self._fast[key] = Buffered(self.function(*key), (0, 1))
        return self._fast[key]

    def names(self, name: str, film: int = 1, shear: int = 1) -> tuple[str, ...]:
        key = (name, film, shear)
        if key not in self._names:
            self._names[key] = tuple(self(name, region=self._region(*key)))
        return self._names[key]

    def _region(self, name: str, film: int, shear: int) -> dict[str, int]:
        return {"film": film, "shear": shear} if name in self.structure.REGIONAL else {}

    def group_values(self, groups: Mapping[str, float]) -> np.ndarray:
        return np.array([groups[name] for name in self.groups])

    def start(self, p: np.ndarray) -> np.ndarray:
        return np.array(list(self.values("start", np.zeros(len(self.state)), p).values()))


def slip_restitution(model: Model, y: np.ndarray, p: np.ndarray) -> float:
    """Relative velocity of the surfaces at the contact in a state, over that at initial contact; NaN without one."""
    if not model.oblique:
        return math.nan
    first = model.values("surface_slip", model.start(p), p)["surface_slip"]
    return math.nan if abs(first) < LEAST_SLIP else model.values("surface_slip", y, p)["surface_slip"] / first


@own_cache(None)  # never evicted, because cached expressions use the symbols of their model
def load(choice: ModelKey) -> Model:
    """The model of a key, built once per thread."""
    return Model(choice)
