# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
"""Emitted laws: `<slot>_<name>`, functions of dimensionless arguments. `LAWS` has their names and features.

A feature is a function that not every law of the slot has, or a property.
"""

LAWS: dict[str, dict[str, tuple[str, ...]]] = (
{"film": {"finite": ("stopping", "braking"),
          "infinite": ("stopping", "braking"),
          "cavitating": ("suction", "braking"),
          "constant-volume": ("braking", "spread")},
 "shear": {"immersed": (), "film": ("rim",)},
 "arm": {"midgap": ("balanced",)},
 "glass": {"literal": ("reach",), "film-corrected": ("reach", "rim")},
 "bridge": {"mikami": ("rupture_distance",),
            "mikami-log10": ("rupture_distance",),
            "willett": ("rupture_distance",),
            "willett-simple": ("rupture_distance",),
            "rabinovich": (),
            "lambert": (),
            "soulie": ("rupture_distance",),
            "constant": ()},
 "strings": {"exact": (), "small-angle": ()},
 "attraction": {"van-der-waals": ("potential",)}}
)
