"""Certificates that a doublet never separates, so that integration can stop once the outcome is decided."""

from .base import Certainty as Certainty
from .base import Certificate as Certificate
from .base import NoCertificate as NoCertificate
from .base import at_maximum as at_maximum
from .choice import energy_proof as energy_proof
from .choice import proof_for as proof_for
from .circling import limit_of_circling as limit_of_circling
from .energy_barrier import Barrier as Barrier
from .energy_barrier import EnergyCertificate as EnergyCertificate
from .orbital_momentum import OrbitalMomentumCertificate as OrbitalMomentumCertificate
from .spin_down import SpinDownCertificate as SpinDownCertificate
