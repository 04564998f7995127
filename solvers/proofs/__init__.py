"""Proofs that a doublet never separates, so that a flight can end as soon as its outcome is decided."""

from __future__ import annotations

from .barrier import Barrier, BarrierProof
from .base import NoProof, Proof
from .chatter import ChatterProof
from .choice import energy_proof, proof_for
from .circling import comes_to
from .film import FilmProof
from .held import HeldProof
from .orbital import OrbitalProof
from .tethered import TetherProof

__all__ = [
    "Barrier",
    "BarrierProof",
    "ChatterProof",
    "FilmProof",
    "HeldProof",
    "NoProof",
    "OrbitalProof",
    "Proof",
    "TetherProof",
    "comes_to",
    "energy_proof",
    "proof_for",
]
