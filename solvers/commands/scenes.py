"""Scenes and their models: listed, begun, emitted, compared, exported, compiled and cited."""

from __future__ import annotations

import json
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Annotated, Any

import click

from ..engines.settings import check_rtol
from ..errors import CheckFailed, InputError
from ..host import bounded, files
from ..host.arguments import check_name
from ..host.files import check_file, differing, write_all_in
from ..scene.scenefile import PRESETS, description, read_text, template
from .bar import Bar
from .options import Changes, Request, Written, WrittenText, group, json_text, refuse, several
from .signature import command, passed

KINDS = ("c", "casadi", "latex")
_MODELS = "library, a preset or scene file, a folder of `generate`, or MODEL.py"
OWN = Path(__file__).resolve().parents[2] / "generated"  # not imported: may be stale or broken


@command()
def scenes(new: str | None, request: Request, output: WrittenText) -> None:
    """List the presets, or print the scene NAME as TOML, ready to be saved and edited.

    With --new NAME a scene file to be filled in is written, which runs as it is.

    Options:
        [NAME] (source):
        --new NAME: Write NAME.toml, a commented scene to be filled in.
    """
    if new is not None:
        _begin(new, {"NAME": request.source, **request.options, "-o": output.file})
        return
    scene = request.optional_scene()
    if scene is None:
        width = max(map(len, PRESETS))
        output.put("\n".join(f"{name:<{width}}  {description(name)}" for name in PRESETS))
    elif request.source in PRESETS and not request.options:
        output.put(read_text(str(request.source))[0].rstrip("\n"))
    else:
        output.put(scene.to_toml().rstrip("\n"))


def _begin(name: str, others: dict[str, object]) -> None:
    """Write a scene file to be filled in, which must not be there."""
    if not name.strip():
        raise InputError("--new", name, "a name for the file NAME.toml", "is empty")
    file = check_file(name if name.endswith(".toml") else f"{name}.toml", "--new")
    accepted = "a name NAME for a file NAME.toml that is not there"
    if file.stem in PRESETS:
        raise InputError("--new", name, accepted, "is the name of a preset")
    if bounded.exists(file):
        raise InputError("--new", name, accepted, f"would overwrite {file}")
    for option in passed(**others):
        raise InputError("--new", name, "--new NAME alone", f"is given together with {option}")
    files.write(file, template(file.stem))
    click.echo(str(file))


@command()
def cite(request: Request, output: Written) -> None:
    """BibTeX of what SCENE rests on: the paper, and where each law that it uses is published.

    Example:
      wetdoublet cite granulation --set bridge.law=willett -o references.bib
    """
    scene = request.scene()

    from ..export.citations import as_bibtex, citations
    from ..scene.origin import origin

    references = citations(scene)
    record = {**origin(scene), "references": [reference.to_dict() for reference in references]}
    output.put(json_text(record, ensure_ascii=False) if output.as_json else as_bibtex(references))


@command("engines.kernels:compile_kernels")
def compile_(
    rtol: Annotated[tuple[float, ...], lambda given: [check_rtol(text) for text in given]],
    requests: Annotated[
        Any, group(several, "source", "stokes", "speed", "relative_speed", "angle", "changes", "model")
    ],
    output: Written,
    **chosen: Any,
) -> None:
    """Compile the Taylor kernels of each SCENE beforehand: for one collision, many, maps and boundaries.

    Without it the first collision of each kind waits some seconds for its kernel. Kernels depend on the terms and laws
    of a scene and not on its numbers.

    Examples:
      wetdoublet compile granulation pendulum
      wetdoublet compile my-powder.toml --rtol 1e-9 --rtol 1e-12

    Options:
        SCENE... (source):
        --rtol R: Relative tolerance, 1e-13..1e-3 [1e-9]; repeatable.
        --derivatives
    """
    scenes = [request.scene() for request in requests]

    from ..engines.kernels import compile_kernels
    from ..scene.origin import release

    with Bar("kernels") as progress:
        kernels = compile_kernels(scenes, progress=progress, **passed(rtol=rtol or None), **chosen)
    record = {
        "version": release(),
        "kernels": [kernel.to_dict() for kernel in kernels],
        "units": {"seconds": "s", "bytes": "B"},
    }
    lines = []
    for scene, members in groupby(kernels, lambda kernel: kernel.scene):
        lines += [scene or "scene", *map(str, members)]
    new = sum(not kernel.already for kernel in kernels)
    output.put("\n".join([*lines, f"{new} compiled, {len(kernels) - new} already compiled"]), record)


@command(old=_MODELS, new=_MODELS)
def diff(old: str, new: str, probe: str | None, changes: Changes, output: Written) -> None:
    """The terms in which the models A and B differ, and their effect.

    Models are `library`, presets, scene files, models, or two folders of `generate`. --set changes entries of B. Models
    are put into the scene of --scene; so is `library`. A MODEL.py is run as Python.

    Examples:
      wetdoublet diff library mine.py
      wetdoublet diff granulation granulation --set bridge.law=willett

    Options:
        A (old):
        B (new):
        --scene SCENE (probe): Scene of the comparison [granulation].
        --set (changes)
    """
    from ..export.differences import differences

    output.show(differences(old, new, changes=changes, **passed(probe=probe)))


@command(to="one of " + ", ".join(KINDS), out="a folder to write into")
def export(to: Annotated[str, partial(check_name, choices=KINDS, label="")], out: Path, request: Request) -> None:
    """The collision law of SCENE in C, or its model as LaTeX or functions of CasADi, written into DIR.

    c: a folder with the whole collision law as NAME.c and NAME.h, C99 that needs no other library: material and impact
    in, what happens out. With a check, examples in C and Python, and a Makefile. latex: NAME.tex, Table 1
    of this model. casadi: NAME.c and NAME.h, the model's functions without an integrator, for CasADi's calling
    convention.

    Example:
      wetdoublet export granulation --to c --out law

    Options:
        --to KIND: c, casadi or latex.
        --out DIR: Folder to write into.
    """
    scene = request.scene(remark=True)
    if to == "latex":
        from ..export.equations import texts
    elif to == "c":
        from ..export.law.texts import texts
    else:
        from ..export.functions import texts
    for file in write_all_in(out, texts(scene)):
        click.echo(str(file))


@command(output="a file to write, such as explorer.html")
def explore(output: str, others: tuple[str, ...], request: Request) -> None:
    """A page for the browser, with the law of SCENE: turn the scene's knobs, see the doublet.

    It opens from disk in any browser and loads nothing. Presets with the same law may be chosen in it, and the scenes
    of --with. Knobs for the scene's numbers, a map of outcomes over two of them, the moving doublet and its curves.

    Example:
      wetdoublet explore granulation -o explorer.html

    Options:
        -o FILE (output): File to write, .html.
        --with SCENE (others): Another scene to choose from; repeatable.
    """
    check_file(output, "-o", (".html", ".htm"))
    scene = request.scene(remark=True)

    from ..explorer.page_of_scene import explore

    explore(scene, *others).write(output)
    click.echo(output)


@command()
def generate(model: str | None, out: Path | None, check: bool, template: bool, names: bool) -> None:
    """Derive the equations and emit them as CasADi functions.

    With MODEL.py, which is run as Python, its laws are derived, checked and emitted into DIR, for --model DIR of the
    other commands.

    Examples:
      wetdoublet generate --template > mine.py
      wetdoublet generate mine.py --out mine
      wetdoublet collide granulation --model mine --set custom.yield_stress="50 Pa"

    Options:
        [MODEL.py] (model):
        --out DIR: Output folder; required for a model.
        --check: Compare with the files there, byte for byte, and write nothing.
        --template: Print a model file that runs as it is.
        --names: Print the names that a model file has, with units.
    """
    if template or names:
        alone = "--template" if template else "--names"
        others = {"MODEL.py": model, "--out": out, "--check": check, "--names": names and template}
        refuse(others, f"{alone} alone: it prints and writes nothing", f"is given with {alone}")
        from ...derive import user
        from ...derive.user.names import listed
        from ...derive.user.template import TEMPLATE

        click.echo(TEMPLATE.rstrip("\n") if template else listed(vars(user)))
        return
    if model is not None:
        _model(Path(model), out, check)
        return
    accepted = "--check alone: it compares the package's own folder"
    refuse({"--out": check and out and str(out)}, accepted, "is given with --check")
    if not check and out is None and not (OWN.parent / "pyproject.toml").is_file():
        problem = f"is missing, and the emitted files of the installed package in {OWN} would be rewritten"
        raise InputError("--out", None, "--out DIR, or --check, which compares and writes nothing", problem)

    from ...derive.emit import write

    if not check:
        emitted, folder = write.emitted(), out or OWN
        written = write_all_in(folder, differing(folder, emitted))
        as_before = [f"{len(emitted) - len(written)} files as before"] * (len(emitted) > len(written))
        click.echo("\n".join([*map(str, written), *as_before]))
    elif differences := write.check():
        click.echo("\n".join(differences))
        remedy = "`wetdoublet generate` mends what differs or is missing; what is extra is to be removed by hand"
        raise CheckFailed(f"{OWN} is not what derive/ emits; {remedy}")


def _model(source: Path, folder: Path | None, check: bool) -> None:
    """Derive, check and emit a user's model, and print its description and what has changed."""
    if folder is None:
        raise InputError("--out", None, "a folder for the emitted model")
    if folder.resolve() == OWN:
        raise InputError("--out", str(folder), "a folder of its own for a model", "is the package's own folder")

    from ..host.emitted import deriving
    from ..host.user_cache import fetch, lookup
    from ..scene.user_model_source import derived_package, key_of, origin_of

    key = key_of(source.read_bytes() if source.is_file() else b"", origin_of(source, folder))
    before = lookup(key) if key and not check else None
    if before is not None and not differing(folder, emitted := json.loads(before)):
        click.echo(f"nothing has changed: the {len(emitted)} files in {folder} are what {source} gives")
        return
    with deriving():
        derived = derived_package(source, folder)
    click.echo(derived.report)
    if not derived.files:
        raise CheckFailed(f"{source}: {derived.failed}")
    new = differing(folder, derived.files)
    if check:
        if new:
            click.echo("\n".join(f"{'differs' if (folder / name).is_file() else 'missing'}: {name}" for name in new))
            remedy = f"`wetdoublet generate {source} --out {folder}` mends it"
            raise CheckFailed(f"{folder} is not what {source} gives; {remedy}")
        return
    removed = [folder / name for name in _listed(folder) - derived.files.keys()]
    rows = [("written", path) for path in write_all_in(folder, new)] + [("removed", path) for path in removed]
    for path in removed:
        path.unlink(missing_ok=True)
    if key:
        fetch(key, json.dumps(dict(derived.files)).encode)
    click.echo("\n".join(["", *(f"{word}  {path}" for word, path in rows), ""]))
    click.echo(f"{len(derived.files)} files in {folder}; use it with --model {folder}")
    click.echo(f"its effect on the map: wetdoublet diff library {folder}")


def _listed(folder: Path) -> set[str]:
    """Relative paths of the files of a package in a folder, according to its manifest; other files are not listed."""
    try:
        listed = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError):
        return set()
    inside = folder.resolve()
    return {name for name in listed if inside in (folder / name).resolve().parents}
