"""Bridge laws of a cylindrical bridge of constant volume: its pressure, and the tension along its contact line."""

from ..user import Reference, V, cos, h, law, let, phi, pi, positive, sin, sqrt

RABINOVICH = Reference(
    "rabinovich2005capillary", ("Rabinovich, Y. I.", "Esayanur, M. S.", "Moudgil, B. M."),
    "Capillary forces between two spheres with a fixed volume liquid bridge: theory and experiment",
    "Langmuir", "Langmuir", "21", "10992–10997", 2005, "10.1021/la0517639",
)  # fmt: skip
LAMBERT = Reference(
    "lambert2008comparison", ("Lambert, P.", "Chau, A.", "Delchambre, A.", "Régnier, S."),
    "Comparison between two capillary forces models",
    "Langmuir", "Langmuir", "24", "3157–3163", 2008,
)  # fmt: skip

reach = let("cylinder_reach", sqrt(h**2 + 2 * V / pi))
angle = let("half_filling_angle", sqrt(positive(reach - h)))
pressure = 2 * cos(phi) * (1 - h / reach)

law(
    "bridge", "rabinovich", source=RABINOVICH,
    meaning="lambert's pressure term and the surface tension along the contact line at the half-filling angle",
    force=pressure + 2 * sin(angle) * sin(angle + phi),
)  # fmt: skip
law(
    "bridge", "lambert", source=LAMBERT, falls=True,
    meaning="energy approach with a cylindrical bridge, exact at constant volume",
    force=pressure,
)  # fmt: skip
