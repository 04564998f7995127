"""The page of a scene: one HTML file that holds everything it needs."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
from functools import cached_property
from html import escape
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..host import files
from ..scene.scene import Scene
from ..scene.schema import SPEEDS

if TYPE_CHECKING:
    from ..export.law.texts import LawSource

_BUILT = Path(__file__).with_name("built")
_SIZES = {"radius", "diameter", "reduced_radius", "mass", "density", "reduced_mass"}
_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'sha256-{script_digest}' \
'wasm-unsafe-eval' blob:; worker-src blob:; style-src 'unsafe-inline'; img-src data: blob:">
<title>{title}</title><style>{style}</style></head>
<body><header><h1>{what}</h1>
<p>Scene “{name}”, {bridge}. Turn a knob, or pick an impact in the map. Everything is computed in this page, by
wetdoublet {version}.</p></header>
<script type="application/json" id="scene">{data}</script>
<script>{script}</script></body></html>
"""


class Explorer:
    """The page of a scene; in a notebook it shows itself.

    Arguments:
        scene: with an impact.

    Raises:
        InputError: a scene without an impact.

    Example:
        >>> import wetdoublet as wd
        >>> wd.explore("granulation").scene.name
        'granulation'
    """

    def __init__(self, scene: Scene) -> None:
        scene.need_impact()
        self.scene = scene

    @cached_property
    def html(self) -> str:
        """The page, which loads nothing.

        Raises:
            InputError: a law that has no recurrence, or no compiler for WebAssembly.
        """
        scene, name = self.scene, escape(self.scene.name or "scene")
        return _PAGE.format(
            title=f"wetdoublet: {name}",
            name=name,
            what="A wet sphere hits a wall" if scene.wall else "Two wet particles collide",
            bridge=f"with a liquid bridge ({escape(scene.bridge.law)})" if scene.bridge else "without a liquid bridge",
            version=version("wetdoublet"),
            style=_built("page.css"),
            script=_built("page.js"),
            script_digest=base64.b64encode(hashlib.sha256(_built("page.js").encode()).digest()).decode(),
            data=json.dumps(self._data(), ensure_ascii=False, allow_nan=False).replace("<", "\\u003c"),
        )

    def write(self, path: str | Path) -> None:
        """Write the page. InputError as for `html`; OSError if the file cannot be written."""
        files.write(path, self.html)

    def _repr_html_(self) -> str:
        frame = "width:100%;height:900px;border:1px solid rgba(128,128,128,.35)"
        title = escape(f"Collisions of {self.scene.name or 'the scene'}")
        return f'<iframe title="{title}" style="{frame}" srcdoc="{escape(self.html)}"></iframe>'

    def _data(self) -> dict[str, Any]:
        """What the page is told of the scene."""
        from ...generated.automaton import CRITERIA, OUTCOMES
        from ..engines.settings import RTOL
        from ..export.law.interface import structures
        from ..export.law.texts import source
        from ..formatting.style import FILLS
        from .knobs import knobs
        from .limits import limits
        from .module import module

        scene = self.scene
        law = source(scene)
        layout = structures(law.header)
        given = dict(scene.given)
        members = [member for _, member, _ in layout["law_material"]]
        behind, ends = limits(scene, members, [each.name for each in law.entries])
        return {
            "name": scene.name or "scene",
            "rtol": RTOL,
            "wasm": base64.b64encode(gzip.compress(module(law, behind), 9, mtime=0)).decode(),
            "worker": _built("worker.js"),
            "layout": {
                name: [[kind, member] for kind, member, _ in layout[f"law_{name}"]]
                for name in ("pair_entries", "material", "impact", "collision")
            },
            "entries": {each.name: each.value for each in law.entries},
            "knobs": knobs(scene, law.entries, law.impact),
            "speed": next(name for name in SPEEDS if name in given).partition(".")[2],
            "own_model": scene.package is not None,
            "wall": scene.wall,
            "strings": scene.pendulum is not None,
            "tables": _tables(scene, law),
            "limits": ends,
            "outcomes": list(OUTCOMES),
            "criteria": list(CRITERIA),
            "colours": list(FILLS.values()),
        }


def explore(scene: Scene | str | Path) -> Explorer:
    """Return the page of a scene, which shows itself in a notebook and is written by `.write("explorer.html")`.

    The page needs no network and no server: the scene's law runs in it as WebAssembly. It has knobs for the numbers of
    the scene (in their units), a map of outcomes over two of them, the moving doublet, and curves.

    Arguments:
        scene: a Scene, a path or a preset's name; it has an impact.

    Raises:
        InputError: a scene without an impact. To write the page needs a compiler for WebAssembly, which
            `wetdoublet[explorer]` brings.

    Example:
        >>> import wetdoublet as wd
        >>> page = wd.explore("granulation")
        >>> page.write("explorer.html")  # doctest: +SKIP
    """
    return Explorer(Scene.load(scene))


def _built(name: str) -> str:
    return (_BUILT / name).read_text(encoding="utf-8")


def _tables(scene: Scene, law: LawSource) -> list[list[str | None]]:
    """Rows of the scene's TOML: table, key, and its text; for a number of the law that number's name, and its unit."""
    rows: list[list[str | None]] = []
    members = {each.name for each in law.entries}
    kept = {name: raw for name, raw in scene.given if name.partition(".")[0] != "impact"}
    for each in law.entries:
        table, _, key = each.name.partition("_")
        if table == "partner" and scene.partner is None:
            continue  # equal to the first
        unit = "m^3" if f"{table}.{key}" == "bridge.volume" and scene.ways.volume == "absolute" else each.unit
        rows.append([table, key, None, each.name, "" if unit == "1" else unit])
    for name, raw in kept.items():
        table, _, key = name.partition(".")
        if name.replace(".", "_", 1) not in members and key not in _SIZES:
            text = "true" if raw is True else json.dumps(raw, ensure_ascii=False)
            rows.append([table, key, text, None, None])
    order = [*dict.fromkeys(name.partition(".")[0] for name in kept)]
    return sorted(rows, key=lambda row: order.index(row[0] or ""))
