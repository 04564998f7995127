"""How many examples a property is tried on: the same ones in every run; WETDOUBLET_EXAMPLES=50 tries other, more ones."""

import os

from hypothesis import HealthCheck, settings

_MORE = int(os.environ.get("WETDOUBLET_EXAMPLES", "1"))
_INVALID = [HealthCheck.filter_too_much, HealthCheck.too_slow]


def examples(count: int) -> settings:
    """A property's settings for so many examples."""
    return settings(
        max_examples=count * _MORE, derandomize=_MORE == 1, deadline=None, suppress_health_check=_INVALID, database=None
    )
