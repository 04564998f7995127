"""`wetdoublet verify`: symbolic identities of the derivation, and numerical checks against bounds."""

from .identities import symbolic
from .report import Finding, Report
from .run import numeric, verify

__all__ = ["Finding", "Report", "numeric", "symbolic", "verify"]
