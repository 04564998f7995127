"""`ModelKey`: which structure and which laws a model has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..scene.user_model import Package


@dataclass(frozen=True)
class ModelKey:
    """Identifier of a model: the structure module and the law in each slot; laws may be of a user's model."""

    structure: str
    laws: tuple[tuple[str, str], ...]
    package: Package | None = None

    def law(self, slot: str) -> str | None:
        return dict(self.laws).get(slot)
