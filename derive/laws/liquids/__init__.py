"""Films of liquids whose viscosity depends on the shear rate: one model file a law, over the formulas of `generalised`.

A scene says which by `liquid.law`. Each is read as a user's model file is, because its quantities are those of its law.
"""

from pathlib import Path


def file_of(law: str) -> Path:
    """The model file of a law of liquids."""
    return Path(__file__).with_name(f"{law.replace('-', '_')}.py")
