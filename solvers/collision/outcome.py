"""Data of one collision in SI units: outcome, events and energy ledger."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING

from ...generated.automaton import OUTCOMES, STICK
from ..errors import ComputationError
from ..model.dimensionless import Problem
from ..model.validity import NEEDS, sentences
from ..results import UNITS
from ..scene.groups import si_values
from ..scene.items import item
from ..scene.origin import Record, Result
from ..scene.scene import Scene

if TYPE_CHECKING:
    import xarray


_SHOWN = (
    "initial", "final", "normal_lubrication", "tangential_lubrication", "dry_contact", "dry_friction", "capillary",
    "attraction", "strings", "own_events", "own_terms", "residual",
)  # fmt: skip
_OPEN, _OPEN_AT_LEAST = 1e4, 1e-6  # limits of the residual: multiple of rtol, part of the largest term


def open_beyond(rtol: float) -> float:
    """Residual of a ledger over its largest term beyond which the trajectory must be wrong."""
    return max(_OPEN * rtol, _OPEN_AT_LEAST)


def absent_terms(scene: Scene) -> set[str]:
    """Terms of the ledger whose forces a scene does not have."""
    absent = {
        "attraction": scene.attraction, "dry_friction": scene.particles.friction, "strings": scene.pendulum,
        "own_events": (scene.package and scene.package.events) or None,
        "own_terms": scene.package and scene.package.terms,
    }  # fmt: skip
    return {name for name, value in absent.items() if value is None}


class Energy(Record, of="energy."):
    """The energy ledger of a collision, J; None for terms of forces, events and laws that it does not have."""

    initial: float
    final: float
    normal_lubrication: float
    tangential_lubrication: float
    capillary: float
    dry_contact: float
    strings: float
    attraction: float | None = None
    dry_friction: float | None = None
    own_events: float | None = None
    own_terms: float | None = None

    @classmethod
    def of(cls, problem: Problem, terms: Mapping[str, float]) -> Energy:
        """The ledger from its terms over m v0^2, without those of forces that the collision does not have."""
        absent = absent_terms(problem.scene) | (set() if problem.oblique else {"dry_friction"})
        energies = {name: value * problem.energy for name, value in terms.items() if name not in absent}
        return cls(**{"strings": 0.0} | energies)

    @property
    def residual(self) -> float:
        spent = self.normal_lubrication + self.tangential_lubrication + self.capillary + self.dry_contact + self.strings
        more = (self.attraction, self.dry_friction, self.own_events, self.own_terms)
        return self.initial - self.final - spent - sum(term or 0.0 for term in more)

    def check(self, rtol: float) -> None:
        """ComputationError if the residual exceeds what the tolerance explains: the trajectory must be wrong."""
        if not abs(self.residual) <= open_beyond(rtol) * self.largest:
            raise ComputationError(
                f"the energy ledger is open by {abs(self.residual) / self.largest:.1e} of its largest term",
                advice="try a smaller --rtol, or the other --engine; please report the scene",
            )

    @property
    def largest(self) -> float:
        """The largest term by magnitude, J."""
        return max(abs(value) for value in self.to_dict().values())

    def to_dict(self) -> dict[str, float]:
        return {name: value for name, value in vars(self).items() if value is not None} | {"residual": self.residual}


class Event(Record):
    """An event of a collision and its time, s since initial contact."""

    kind: str
    time: float


class Outcome(Result, kw_only=True):
    """One collision as data, in SI units and radians; of a stick the restitution is 0 and what has no value None."""

    _keys = (
        "outcome restitution tangential_restitution slip_restitution rotation contact_time smallest_gap final_spin "
        "final_rotation_rate stokes centrifugal capillary speed angle reversal certified until final_spin_partner "
        "generalised_centrifugal reynolds events energy angular_momentum_drift engine steps rtol validity units"
    )

    outcome: str = item('"stick", "stick-rotate-separate" or "bounce"')
    restitution: float
    tangential_restitution: float | None
    slip_restitution: float | None
    rotation: float | None
    contact_time: float | None
    smallest_gap: float | None
    final_spin: float | None
    final_rotation_rate: float | None
    stokes: float
    centrifugal: float | None
    capillary: float | None
    reynolds: float | None
    speed: float
    angle: float
    reversal: str | None
    certified: bool = item("True if a certificate, or the enclosure from the initial data on, proves the stick")
    until: float | None
    decided: float | None = item("when a stick was certain, s: `until`, unless another time was asked for")
    events: tuple[Event, ...]
    energy: Energy | None
    angular_momentum_drift: float | None
    engine: str
    steps: int
    rtol: float = item("relative tolerance that was asked for")
    generalised_centrifugal: float | None = item(
        "Ce_F = m omega0^2 a/F(x0), F the attraction at initial contact; None without attraction", default=None
    )
    final_spin_partner: float | None = item("spin of the [partner]; None without one", "rad/s", default=None)
    final_gap: float | None = item("gap at separation", "m", default=None)
    scene: Scene = field(repr=False, compare=False)
    trajectory: xarray.Dataset | None = item(
        "Dataset over `time`, if requested", default=None, repr=False, compare=False
    )

    @property
    def terms(self) -> dict[str, float]:
        """Terms of the ledger whose forces act in this collision, J, in the order in which they are shown; or none."""
        energy = {} if self.energy is None else self.energy.to_dict()
        absent = absent_terms(self.scene) | (set() if self.scene.bridge is not None else {"capillary"})
        return {name: energy[name] for name in _SHOWN if name in energy and name not in absent}

    @property
    def validity(self) -> tuple[str, ...]:
        """Where the collision leaves the model's range, a sentence each with the number and the limit."""
        results = {name: getattr(self, name) for name in NEEDS if self.outcome != STICK}
        numbers = {name: math.nan if results.get(name) is None else results[name] for name in NEEDS}
        values = si_values(self.scene, self.speed, self.angle) | numbers | {"outcome": OUTCOMES.index(self.outcome)}
        return tuple(sentences(self.scene, values))

    @property
    def long_contact(self) -> str:
        """That the contact is too long to be taken as instantaneous among other particles; "" of one that is not.

        At a share phi of solids by volume a particle is hit d/(6 phi V) apart in time, the pair twice as often.
        """
        if self.contact_time is None or self.scene.pendulum is not None:
            return ""
        radius, partner = 2 * self.scene.particles.reduced_radius, self.scene.partner
        length = radius + (radius if partner is None or partner.radius is None else partner.radius)
        diameters = self.contact_time * self.speed / math.cos(self.angle) / length
        if diameters <= 1:
            return ""
        turns = "" if self.scene.wall or not self.rotation else f", {abs(self.rotation) / math.tau:.3g} turns"
        return (
            f"the contact is not instantaneous: a particle of this relative speed travels {diameters:.3g} diameters "
            f"meanwhile{turns}; where solids fill {100 / (12 * diameters):.2g} % of the volume others hit the pair"
        )

    @property
    def _absent(self) -> set[str]:
        has = {
            "final_spin_partner": self.scene.pair or self.scene.wall,
            "generalised_centrifugal": self.scene.attraction is not None,
            "reynolds": self.reynolds is not None,
        }
        return {key for key, is_there in has.items() if not is_there}

    @property
    def units(self) -> dict[str, str]:
        """Units of the JSON object's values."""
        return {key: UNITS[key] for key in self._keys.split() if key in UNITS and key not in self._absent}
