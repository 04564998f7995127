"""Proofs that a doublet never separates, so that a trajectory can end as soon as its outcome is decided."""

from __future__ import annotations

from .attraction import HeldProof
from .base import Certainty, NoProof, Proof, at_maximum
from .chatter import ChatterProof
from .choice import energy_proof, proof_for
from .circling import comes_to
from .energy_barrier import Barrier, BarrierProof
from .film import FilmProof
from .orbital_momentum import OrbitalProof
from .strings import TetherProof

__all__ = [
    "Barrier",
    "BarrierProof",
    "Certainty",
    "ChatterProof",
    "FilmProof",
    "HeldProof",
    "NoProof",
    "OrbitalProof",
    "Proof",
    "TetherProof",
    "at_maximum",
    "comes_to",
    "energy_proof",
    "proof_for",
]
