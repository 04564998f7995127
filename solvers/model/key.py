"""`ModelKey`: which structure and which laws a model has."""

from __future__ import annotations

from dataclasses import dataclass

from ..scene.user_model import Package, features


@dataclass(frozen=True)
class ModelKey:
    """Identifier of a model: the structure module and the law in each slot; laws may be of a user's model."""

    structure: str
    laws: tuple[tuple[str, str], ...]
    package: Package | None = None

    def law(self, slot: str) -> str | None:
        return dict(self.laws).get(slot)

    @property
    def drifts(self) -> bool:
        """The lever arm exerts a torque on the doublet, whose angular momentum is not conserved."""
        arm = self.law("arm")
        return arm is not None and "balanced" not in features(self.package, "arm", arm)
