# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 78bfb53e20678b26d8151529924a920f90ec47b44fc2119f83e152eb709d0cb4
"""bridge law `willett`: fit to Young-Laplace solutions over h/(2 sqrt V), full form.

Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000).
"""

from __future__ import annotations

from typing import Any

from casadi import exp, log, sqrt


VALIDITY: dict[str, tuple[float | None, float | None]] = {
    "volume": (None, 0.1),
    "contact_angle": (None, 0.8726646259971648),
    "separation": (None, None),
}
VALIDITY_SOURCE = "Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000)"


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 158
    """
    log_volume = log(volume)
    log_scaled_gap = log(gap_over_radius/(2*sqrt(volume)))
    f1 = (
        - 1.1466*contact_angle**2
        + 0.050832*contact_angle
        + log_volume**3*(-0.00029076*contact_angle**2 - 0.0003505*contact_angle - 0.0005)
        + log_volume**2*(-0.01255*contact_angle**2 - 0.0036456*contact_angle - 0.012101)
        + log_volume*(-0.149*contact_angle**2 - 0.000411*contact_angle - 0.1119)
        - 0.44507
    )
    f2 = (
        - 1.2918*contact_angle**2
        - 0.57473*contact_angle
        + log_volume**2*(-0.01137*contact_angle**2 - 0.0068988*contact_angle - 0.0013375)
        + log_volume*(-0.22574*contact_angle**2 - 0.1201*contact_angle - 0.0668)
        + 1.9222
    )
    f3 = (
        - 0.23566*contact_angle**2
        - 0.01396*contact_angle
        + log_volume**3*(0.001318*contact_angle - 0.00053*contact_angle**2 + 0.0008585)
        + log_volume**2*(0.02238*contact_angle - 0.009853*contact_angle**2 + 0.02232)
        + log_volume*(0.092*contact_angle - 0.06418*contact_angle**2 + 0.198)
        + 1.268
    )
    f4 = (
        - 0.34742*contact_angle**2
        + 0.073776*contact_angle
        + log_volume**2*(0.004456*contact_angle - 0.006257*contact_angle**2 + 0.0018574)
        + log_volume*(0.04543*contact_angle - 0.09056*contact_angle**2 + 0.03345)
        - 0.010703
    )
    return 2*exp(f1 - f2*exp(f3*log_scaled_gap + f4*log_scaled_gap**2))


def rupture_distance(volume: Any, contact_angle: Any) -> Any:
    """Rupture distance over R that goes with this law.

    Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000).

    Total operations: 9
    """
    return (contact_angle/2 + 1)*(0.1*volume**(2/3) + volume**(1/3))
