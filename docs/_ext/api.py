"""The API reference: a page for every public name, grouped by what one wants to do."""

from __future__ import annotations

import inspect

import wetdoublet.solvers as solvers

GROUPS = {
    "Scenes": ("Scene",),
    "Collisions": ("collide", "Collision", "collide_many", "collide_pair", "regime_map", "compile_kernels"),
    "Explorer": ("explore", "Explorer"),
    "Averages": ("collision_averages",),
    "Boundaries": ("boundary", "Boundaries", "atlas", "Atlas"),
    "Sensitivities and uncertainty": (
        "sensitivities",
        "Sensitivities",
        "gradients_many",
        "pair_gradients",
        "boundary_sensitivities",
        "BoundarySensitivities",
        "band",
    ),
    "Fits": ("fit", "Fit", "log_likelihood", "design", "Design"),
    "Errors and warnings": ("WetDoubletError", "InputError", "ComputationError", "CheckFailed", "ModelWarning"),
}
MODEL_WRITERS = ("quantity", "let", "law")


def pages() -> dict[str, str]:
    """The list of names, and a page each."""
    rest = tuple(sorted(set(solvers.__all__) - {name for names in GROUPS.values() for name in names}))
    groups = {**GROUPS, **({"More": rest} if rest else {})}
    found = {"reference/api/index.md": _index(groups)}
    for names in groups.values():
        found |= {f"reference/api/{name}.md": _page("wetdoublet", name) for name in names}
    return found | {f"reference/api/model-{name}.md": _page("wetdoublet.derive.user", name) for name in MODEL_WRITERS}


def _index(groups: dict[str, tuple[str, ...]]) -> str:
    lines = [
        "# Python API",
        "",
        "All names are in `wetdoublet`: `import wetdoublet as wd`.",
        "",
        'Plain numbers are SI and radians. Text carries its unit: `"75 deg"`.',
        "",
    ]
    for title, names in groups.items():
        lines += _listed(title, [(name, name, getattr(solvers, name)) for name in names])
    import wetdoublet.derive.user as user

    title = "For model files (`from wetdoublet.derive.user import *`)"
    lines += _listed(title, [(name, f"model-{name}", getattr(user, name)) for name in MODEL_WRITERS])
    return "\n".join(lines)


def _listed(title: str, names: list[tuple[str, str, object]]) -> list[str]:
    lines = [f"## {title}", ""]
    for name, page, value in names:
        summary = (inspect.getdoc(value) or "").partition("\n\n")[0].replace("\n", " ")
        lines += [f"[`{name}`]({page}.md)", f": {summary}", ""]
    listed = "\n".join(page for _, page, _ in names)
    return [*lines, "```{toctree}", ":hidden:", "", listed, "```", ""]


def _page(module: str, name: str) -> str:
    value = getattr(__import__(module, fromlist=[name]), name)
    if inspect.isclass(value):
        options = "\n   :members:\n   :inherited-members: BaseException, Warning, object"
        options += "\n   :exclude-members: with_traceback, add_note"
        directive = f".. autoclass:: {module}.{name}{options}"
    else:
        directive = f".. autofunction:: {module}.{name}"
    return f"# {name}\n\n```{{eval-rst}}\n{directive}\n```\n"
