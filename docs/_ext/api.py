"""The API reference: a page for each group of public names, by what one wants to do."""

from __future__ import annotations

import inspect
from pathlib import Path

import wetdoublet.solvers as solvers

GROUPS = {
    "Scenes": ("Scene",),
    "Collisions": ("collide", "Collision", "collide_many", "collide_pair", "regime_map", "compile_kernels"),
    "Explorer": ("explore", "Explorer"),
    "Averages": ("collision_averages",),
    "Boundaries": ("boundary", "Boundaries", "atlas", "Atlas"),
    "Sensitivities and uncertainty": (
        "sensitivities", "Sensitivities", "gradients_many", "pair_gradients", "boundary_sensitivities",
        "BoundarySensitivities", "band",
    ),
    "Fits": ("fit", "Fit", "log_likelihood", "design", "Design"),
    "Errors and warnings": ("WetDoubletError", "InputError", "ComputationError", "CheckFailed", "ModelWarning"),
}  # fmt: skip
GROUPS["More"] = tuple(sorted(set(solvers.__all__) - {name for names in GROUPS.values() for name in names}))
INDEX = """# Python API

All names are in `wetdoublet`: `import wetdoublet as wd`. Those for model files come from `wetdoublet.derive.user`.

Plain numbers are SI and radians. Text carries its unit: `"75 deg"`.
"""


def pages() -> dict[str, str]:
    """The list of groups, and a page each."""
    texts = {}
    for title, names in GROUPS.items():
        directives = "\n\n".join(_directive("wetdoublet", name) for name in names)
        texts[f"reference/api/{title.partition(' ')[0].lower()}.md"] = _page(title, directives)
    writers = "\n\n".join(_directive("wetdoublet.derive.user", name) for name in ("quantity", "let", "law", "event"))
    texts["reference/api/models.md"] = _page("For model files", writers)
    listed = "\n".join(Path(name).stem for name in texts)
    return texts | {"reference/api/index.md": f"{INDEX}\n```{{toctree}}\n{listed}\n```\n"}


def _page(title: str, directives: str) -> str:
    return f"# {title}\n\n```{{eval-rst}}\n{directives}\n```\n"


def _directive(module: str, name: str) -> str:
    if not inspect.isclass(getattr(solvers, name, None)):
        return f".. autofunction:: {module}.{name}"
    return f""".. autoclass:: {module}.{name}
   :members:
   :inherited-members: BaseException, Warning, object
   :exclude-members: with_traceback, add_note"""
