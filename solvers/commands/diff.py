"""`wetdoublet diff`: differences between two models, in their equations and in a few collisions."""

from ..errors import InputError
from . import options
from .signature import as_command


@as_command("The terms in which two models differ, and their effect.", probe={"default": "granulation"})
def command(
    one: str | None, other: str | None, probe: str, changes: options.Changes, output: options.WrittenText
) -> None:
    """Compare A and B: `library`, presets, scene files, models, or two folders of `generate`.

    --set changes entries of B. Models are put into the scene of --scene; so is `library`. A MODEL.py is run as Python.

    \b
    Example:
      wetdoublet diff library mine.py
      wetdoublet diff granulation granulation --set bridge.law=willett

    Options:
        A (one):
        B (other):
        --scene SCENE (probe): Scene of the comparison [granulation].
    """  # noqa: D301 # click wants the character itself
    if one is None or other is None:
        accepted = "library, a preset or scene file, a folder of `generate`, or MODEL.py"
        raise InputError("A" if one is None else "B", None, accepted)

    from ..export.differences import differences
    from ..export.text import as_text

    output.put(as_text(differences(one, other, probe, changes)))
