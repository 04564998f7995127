"""The library's functions by CasADi's engines, for scenes that few tests have: no kernel is compiled for them."""

from functools import partial

from wetdoublet import solvers

collide = partial(solvers.collide, engine="cvodes")
sensitivities = partial(solvers.sensitivities, engine="rosenbrock")
