"""Checks: symbolic identities, numbers against bounds, engines against each other, and the paper against ours."""

from .identities import symbolic
from .report import Finding, Report
from .run import numeric, verify

__all__ = ["Finding", "Report", "numeric", "symbolic", "verify"]
