"""How many examples a property is tried on: the same in every run; WETDOUBLET_EXAMPLES=50 tries 50 times as many."""

import os
from collections.abc import Sequence
from typing import TypeVar

from hypothesis import HealthCheck, Phase, settings

_Any = TypeVar("_Any")
_MORE = int(os.environ.get("WETDOUBLET_EXAMPLES", "1"))
_INVALID = [HealthCheck.filter_too_much, HealthCheck.too_slow]
_PHASES = [Phase.explicit, Phase.generate]
if "WETDOUBLET_MUTANT" not in os.environ:  # of a mutant the first example that fails is enough
    _PHASES.append(Phase.shrink)


def examples(count: int) -> settings:
    """A property's settings for so many examples."""
    return settings(
        max_examples=count * _MORE,
        derandomize=_MORE == 1,
        deadline=None,
        suppress_health_check=_INVALID,
        phases=_PHASES,
        database=None,
    )


def few(structures: Sequence[_Any], step: int = 6) -> list[_Any]:
    """A few of some structures, where what is shown depends little on them; all where more examples are tried."""
    return list(structures[:: step if _MORE == 1 else 1])
