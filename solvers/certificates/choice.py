"""Which proof holds for a model."""

from __future__ import annotations

import numpy as np

from ..model.model import Model
from .attraction import HeldProof
from .base import NoProof, Proof
from .chatter import ChatterProof
from .energy_barrier import BarrierProof
from .film import FilmProof
from .film_and_attraction import AttractedProof
from .orbital_momentum import OrbitalProof, covers
from .strings import TetherProof


def proof_for(model: Model, p: np.ndarray, rtol: float) -> Proof:
    """The certificate that holds for a model."""
    found = _first(model, p, rtol)
    if covers(model):
        return OrbitalProof(model, p, rtol, found)
    chatters = model.oblique and not model.wall and not model.strings and model.works
    return ChatterProof(model, p, rtol, found) if chatters else found


def _first(model: Model, p: np.ndarray, rtol: float) -> Proof:
    """What is asked first, or alone."""
    if model.has("tethered") and model.choice.law("arm") == "midgap" and _integrable(model):
        return TetherProof(model, p, rtol)
    turning = model.oblique and not model.wall
    if turning and _holds(model):
        return HeldProof(model, p, rtol, None if model.strings else BarrierProof(model, p, rtol))
    if turning and (model.strings or not model.works):
        return NoProof()
    if model.works and not turning and not model.strings and model.edged and _momentum(model):
        return AttractedProof(model, p, rtol)
    if model.works or model.strings:
        return BarrierProof(model, p, rtol)
    return FilmProof(model, p, rtol) if _momentum(model) else NoProof()


def energy_proof(proof: Proof) -> BarrierProof | None:
    """The proof by energy that a trajectory has, alone or beside another."""
    while isinstance(proof, HeldProof | OrbitalProof | ChatterProof):
        proof = proof.beside
    return proof if isinstance(proof, BarrierProof) else None


def _holds(model: Model) -> bool:
    """Whether attraction alone can prove a stick: the forces fall with the gap, and the arm conserves L."""
    attracting = [getattr(model.laws, slot) for slot in ("bridge", "attraction") if model.choice.law(slot)]
    falling = all(getattr(law, "FALLS", False) for law in attracting)
    return model.has("held") and falling and model.choice.law("arm") in (None, "midgap")


def _momentum(model: Model) -> bool:
    """Whether the film has a momentum integral: not if its force is not proportional to u."""
    return not any(str(symbol) in model.state for symbol in model.extra("film", "resistance"))


def _integrable(model: Model) -> bool:
    """Whether the laws say what the film takes and how far the glass criterion reaches (a user's need not)."""
    return hasattr(model.laws.film, "stopping") and hasattr(model.laws.glass, "reach")
