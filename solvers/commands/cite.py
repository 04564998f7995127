"""`wetdoublet cite`: what to cite for a scene."""

import json

from ..scene.origin import origin
from . import options
from .signature import as_command


@as_command("BibTeX of the paper and of each law that a scene uses.")
def command(request: options.Request, output: options.Written) -> None:
    """Print BibTeX entries of what SCENE rests on: the paper, and where its laws are published.

    \b
    Example:
      wetdoublet cite granulation --set bridge.law=willett -o references.bib
    """  # noqa: D301 # click wants the character itself
    scene = request.scene()

    from ..export.citations import as_bibtex, citations

    references = citations(scene)
    if output.as_json:
        record = {**origin(scene), "references": [each.to_dict() for each in references]}
        output.put(json.dumps(record, indent=2, allow_nan=False, ensure_ascii=False))
    else:
        output.put(as_bibtex(references))
