"""Certificates that a doublet never separates, so that integration can stop once the outcome is decided."""

from __future__ import annotations

from .attraction import AttractionCertificate
from .base import Certainty, Certificate, NoCertificate, at_maximum
from .chatter import ChatterCertificate
from .choice import energy_proof, proof_for
from .circling import limit_of_circling
from .energy_barrier import Barrier, EnergyCertificate
from .film import FilmCertificate
from .orbital_momentum import OrbitalMomentumCertificate
from .pendulum import PendulumCertificate
from .spin_down import SpinDownCertificate

__all__ = [
    "AttractionCertificate",
    "Barrier",
    "Certainty",
    "Certificate",
    "ChatterCertificate",
    "EnergyCertificate",
    "FilmCertificate",
    "NoCertificate",
    "OrbitalMomentumCertificate",
    "PendulumCertificate",
    "SpinDownCertificate",
    "at_maximum",
    "energy_proof",
    "limit_of_circling",
    "proof_for",
]
