"""How far results of a collision may lie apart that differ by rounding, steps or the tolerance."""

import math
from collections.abc import Iterable

from hypothesis import assume
from wetdoublet.solvers import Collision, ComputationError, Scene, collide

RESULTS = ("restitution", "tangential_restitution", "rotation", "contact_time", "final_spin", "final_rotation_rate")
_NEAR = 1e-7  # relative change of the speed


def decided(scene: Scene, **options: object) -> Collision:
    """The collision; an undecided one is no example, and its reason is one of the engine's."""
    try:
        return collide(scene, **options)  # type: ignore[arg-type]
    except ComputationError as error:
        assert "have not decided" in str(error) or "rounding" in str(error), error
        assume(False)
        raise


def values(collision: Collision, names: Iterable[str] = RESULTS) -> dict[str, float]:
    """The results that the outcome defines."""
    shown = {name: getattr(collision, name) for name in names}
    return {name: float(value) for name, value in shown.items() if value is not None}


class Conditioned:
    """A collision at a tight tolerance, and what becomes of its results where the speed changes by 1e-7.

    A scene whose outcome changes with that is no example.
    """

    def __init__(self, scene: Scene, rtol: float = 1e-11) -> None:
        self.collision = decided(scene, rtol=rtol)
        speed = self.collision.speed
        beside = [decided(scene, speed=speed * factor, rtol=rtol) for factor in (1 - _NEAR, 1 + _NEAR)]
        assume(all(other.outcome == self.collision.outcome for other in beside))
        first, second = (values(other) for other in beside)
        self.slopes = {name: abs(first[name] - second[name]) / (2 * _NEAR) for name in first}  # by d ln v0

    def agree(self, other: Collision, relative: float, names: Iterable[str] = RESULTS, scale: float = 1.0) -> None:
        """Assert that outcome and results are the same, but for this relative error times their conditioning."""
        assert other.outcome == self.collision.outcome
        found = values(other, names)
        for name, value in values(self.collision, names).items():
            allowed = relative * scale * (abs(value) + self.slopes.get(name, 0.0))
            assert math.isclose(found[name], value, rel_tol=0.0, abs_tol=allowed + 1e-300), (name, found[name], value)
