"""The number of cores available to this process."""

import os


def usable_cores() -> int:
    """Number of cores that this process may use, which may be less than the machine's."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
