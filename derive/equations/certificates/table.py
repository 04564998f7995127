"""The stick certificates, in the order in which their margins are emitted: what equations, C and checks are made of.

Each is a module with `admits` (the structures that it covers), `definitions` (named intermediates, in order) and
`functions` (name, docstring and outputs of what is emitted).
"""

from . import approach, attraction, orbital_momentum, pendulum, spin_down

CERTIFICATES = (pendulum, attraction, approach, orbital_momentum, spin_down)
