"""`wetdoublet cite`: what to cite for a scene."""

from __future__ import annotations

import json

import click

from ..scene.origin import origin
from . import options


@click.command("cite", short_help="BibTeX of the paper and of each law that a scene uses.")
@options.scene_argument
@options.of_scene
@options.as_json
@options.output
@options.debug
def command(
    request: options.SceneRequest,
    as_json: bool,
    output: str | None,
) -> None:
    """Print BibTeX entries of what SCENE rests on: the paper, and where its laws are published.

    \b
    Example:
      wetdoublet cite granulation --set bridge.law=willett -o references.bib
    """  # noqa: D301 # click wants the character itself
    file = options.check_file(output, "-o")
    scene = request.scene()

    from ..export.citations import as_bibtex, citations

    found = citations(scene)
    if as_json:
        told = {**origin(scene), "references": [each.to_dict() for each in found]}
        options.put(json.dumps(told, indent=2, allow_nan=False, ensure_ascii=False), file)
    else:
        options.put(as_bibtex(found), file)
