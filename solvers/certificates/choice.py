"""Choice of the certificate for a model."""

import numpy as np

from ..model.model import Model
from .attraction import AttractionCertificate, FilmAndAttractionCertificate
from .base import Certificate, NoCertificate
from .beside_events import beside_events
from .chatter import ChatterCertificate
from .energy_barrier import EnergyCertificate
from .film import FilmCertificate
from .in_space import ReboundCertificate, TumblingCertificate
from .orbital_momentum import OrbitalMomentumCertificate, covers
from .pendulum import PendulumCertificate
from .spin_down import SpinDownCertificate
from .spin_down import covers as spins_down


def proof_for(model: Model, p: np.ndarray, rtol: float) -> Certificate:
    """The certificate that applies to a model."""
    if model.own_events:
        alone = not model.strings and (not model.oblique or model.wall) and (model.edged or not model.works)
        film = FilmCertificate(model, p, rtol) if alone and _momentum(model) else None
        return beside_events(model, p, rtol, film) or NoCertificate()
    first = _first(model, p, rtol)
    if covers(model):
        return OrbitalMomentumCertificate(model, p, rtol, first)
    if model.space and isinstance(first, EnergyCertificate):
        held = TumblingCertificate(model, p, rtol, first)
        return ReboundCertificate(model, p, rtol, held) if _falling(model) else held
    chatters = model.oblique and not model.wall and not model.space and not model.strings and model.works
    return ChatterCertificate(model, p, rtol, first) if chatters else first


def _first(model: Model, p: np.ndarray, rtol: float) -> Certificate:
    """The certificate that is tried first, or alone."""
    laws = model.laws  # a user's may lack the functions that the bounds of an approach need
    integrable = hasattr(laws.film, "stopping") and hasattr(laws.glass, "reach")
    if model.has("pendulum_margins") and model.choice.law("arm") == "midgap" and integrable:
        return PendulumCertificate(model, p, rtol)
    turning = model.oblique and not model.wall
    if spins_down(model):
        return SpinDownCertificate(model, p, rtol)
    if turning and _holds(model):
        return AttractionCertificate(model, p, rtol, None if model.strings else EnergyCertificate(model, p, rtol))
    if turning and (model.strings or not model.works):
        return NoCertificate()
    if model.works and not turning and not model.strings and model.edged and _momentum(model):
        return FilmAndAttractionCertificate(model, p, rtol)
    if model.works or model.strings:
        return EnergyCertificate(model, p, rtol)
    return FilmCertificate(model, p, rtol) if _momentum(model) else NoCertificate()


def energy_proof(proof: Certificate) -> EnergyCertificate | None:
    """The energy certificate contained in `proof`, or None."""
    while proof.beside is not None:
        proof = proof.beside
    return proof if isinstance(proof, EnergyCertificate) else None


def _holds(model: Model) -> bool:
    """True if the attraction certificate applies: forces decrease with the gap and the lever arm conserves L."""
    return model.has("attraction_margins") and _falling(model) and model.choice.law("arm") in (None, "midgap")


def _falling(model: Model) -> bool:
    """True if every attraction decreases with the gap."""
    attracting = [getattr(model.laws, slot) for slot in ("bridge", "attraction") if model.choice.law(slot)]
    return all(getattr(law, "FALLS", False) for law in attracting)


def _momentum(model: Model) -> bool:
    """True if the film has a momentum integral, that is if its force is proportional to u."""
    return not any(str(symbol) in model.state for symbol in model.extra("film", "resistance"))
