"""The page of scenes: one HTML file that holds everything it needs."""

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

from ..engines.settings import RTOL
from ..host import files
from ..scene.scene import Scene
from ..scene.scenefile import PRESETS
from ..scene.schema import SPEEDS
from .module import BUILT, limits, module

if TYPE_CHECKING:
    from ..export.law.texts import LawSource

_SIZES = {"radius", "diameter", "reduced_radius", "mass", "density", "reduced_mass"}
_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'sha256-{script_digest}' \
'wasm-unsafe-eval' blob:; worker-src blob:; style-src 'unsafe-inline'; img-src data: blob:">
<title>wetdoublet: {name}</title><style>{style}</style></head>
<body><header><h1>{title}</h1>
<p><span>{about}</span> Turn a knob, or pick an impact in the map. Everything is computed in this page, by
wetdoublet {version}.</p></header>
<script type="application/json" id="scene">{data}</script>
<script>{script}</script></body></html>
"""
_WIDGET = """
export default {
  render({ model, el }) {
    const frame = document.createElement("iframe");
    frame.title = "Collisions of the scene";
    frame.style.cssText = "width:100%;height:900px;border:1px solid rgba(128,128,128,.35)";
    frame.srcdoc = model.get("html");
    const told = (event) => {
      if (event.source !== frame.contentWindow || !event.data?.wetdoublet) return;
      for (const name of ["address", "toml"]) model.set(name, event.data.wetdoublet[name]);
      model.save_changes();
    };
    addEventListener("message", told);
    el.append(frame);
    return () => removeEventListener("message", told);
  },
};
"""


class Explorer:
    """The page of scenes, the first of which is shown; in a notebook it shows itself.

    Arguments:
        scenes: with an impact each.

    Raises:
        InputError: a scene without an impact.

    Example:
        >>> import wetdoublet as wd
        >>> wd.explore("granulation").scene.name
        'granulation'
    """

    def __init__(self, *scenes: Scene) -> None:
        for scene in scenes:
            scene.need_impact()
        self.scenes = scenes

    @property
    def scene(self) -> Scene:
        return self.scenes[0]

    @cached_property
    def html(self) -> str:
        """The page, which loads nothing.

        Raises:
            InputError: a law that has no recurrence, or whose module is neither shipped nor can be compiled.
        """
        data = self._data()
        first = data["scenes"][0]
        return _PAGE.format(
            name=escape(first["name"]),
            title=first["title"],
            about=escape(first["about"]),
            version=version("wetdoublet"),
            style=_built("page.css"),
            script=_built("page.js"),
            script_digest=base64.b64encode(hashlib.sha256(_built("page.js").encode()).digest()).decode(),
            data=json.dumps(data, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c"),
        )

    def write(self, path: str | Path) -> None:
        """Write the page. InputError as for `html`; OSError if the file cannot be written."""
        files.write(path, self.html)

    @cached_property
    def widget(self) -> Any:
        """The page as an anywidget: `.toml` is the scene that it shows, `.address` its state; None without anywidget.

        Example:
            >>> page = wd.explore("granulation")  # doctest: +SKIP
            >>> wd.Scene.from_toml(page.widget.toml)  # doctest: +SKIP
        """
        try:
            import anywidget
            import traitlets
        except ImportError:
            return None
        values = {"html": self.html, "address": "", "toml": ""}
        traits = {name: traitlets.Unicode(value).tag(sync=True) for name, value in values.items()}
        return type("ExplorerWidget", (anywidget.AnyWidget,), {"_esm": _WIDGET, "__module__": __name__, **traits})()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        if self.widget is not None:
            return self.widget._repr_mimebundle_(**kwargs)
        return {"text/html": self._repr_html_()}

    def _repr_html_(self) -> str:
        frame = "width:100%;height:900px;border:1px solid rgba(128,128,128,.35)"
        title = escape(f"Collisions of {self.scene.name or 'the scene'}")
        return f'<iframe title="{title}" style="{frame}" srcdoc="{escape(self.html)}"></iframe>'

    def _data(self) -> dict[str, Any]:
        """What the page is told: its scenes, and their laws as modules under the digests of their bytes.

        A preset joins if its law is among those of the scenes.
        """
        modules: dict[str, bytes] = {}
        structures = {_structure(scene) for scene in self.scenes}
        presets = map(Scene.load, PRESETS)
        more = [preset for preset in presets if preset.given not in {scene.given for scene in self.scenes}]
        scenes = [_of_scene(scene, modules) for scene in self.scenes]
        scenes += [_of_scene(scene, modules) for scene in more if _structure(scene) in structures]
        return {
            "worker": _built("worker.js"),
            "modules": {
                digest: base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()
                for digest, content in modules.items()
            },
            "scenes": scenes,
        }


def _structure(scene: Scene) -> tuple[Any, ...]:
    """What the law of a scene depends on besides its numbers."""
    from ..export.law.kernels import kernels
    from ..export.law.material import material
    from ..export.law.pair_material import pair_entries

    law_kernels = kernels(scene, RTOL, _has_ledger(scene))
    entries = pair_entries(scene, material(scene, law_kernels))
    return (*(kernel.choice for kernel in law_kernels), *(entry.name for entry in entries), _has_ledger(scene))


def law_of(scene: Scene) -> tuple[LawSource, str, list[str]]:
    """The source of a scene's law, the C that follows it in its module, and the words of the limits of the model."""
    from ..export.law.texts import source, structures

    law = source(scene, ledger=_has_ledger(scene))
    material = [member for _, member, _ in structures(law.header)["law_material"]]
    return law, *limits(scene, material, [item.name for item in law.entries])


def _has_ledger(scene: Scene) -> bool:
    """False with friction, whose loss the page does not show."""
    return scene.particles.friction is None


def _of_scene(scene: Scene, modules: dict[str, bytes]) -> dict[str, Any]:
    """What the page is told of a scene, whose law joins the modules."""
    from ...generated.automaton import CRITERIA, OUTCOMES
    from ..export.law.texts import structures
    from ..formatting.style import FILLS
    from .knobs import knobs

    law, behind, ends = law_of(scene)
    layout = structures(law.header)
    given = dict(scene.given)
    content = module(law, behind)
    digest = hashlib.sha256(content).hexdigest()
    modules[digest] = content
    bridge = (
        f"with a liquid bridge ({scene.bridge.law.capitalize()}'s law)" if scene.bridge else "without a liquid bridge"
    )
    return {
        "name": scene.name or "scene",
        "title": "A wet sphere hits a wall" if scene.wall else "Two wet particles collide",
        "about": f"Scene “{scene.name or 'scene'}”, {bridge}.",
        "rtol": RTOL,
        "module": digest,
        "layout": {
            name: [[kind, member] for kind, member, _ in layout[f"law_{name}"]]
            for name in ("pair_entries", "material", "impact", "collision")
        },
        "entries": {entry.name: entry.value for entry in law.entries},
        "knobs": knobs(scene, law.entries, law.impact),
        "speed": next(name for name in SPEEDS if name in given).partition(".")[2],
        "own_model": scene.package is not None,
        "wall": scene.wall,
        "strings": scene.pendulum is not None,
        "ledger": _has_ledger(scene),
        "attraction": scene.attraction is not None,
        "bridge": scene.bridge is not None,
        "tables": _tables(scene, law),
        "limits": ends,
        "outcomes": list(OUTCOMES),
        "criteria": list(CRITERIA),
        "colours": list(FILLS.values()),
    }


def explore(scene: Scene | str | Path, *others: Scene | str | Path) -> Explorer:
    """Return the page of a scene, which shows itself in a notebook and is written by `.write("explorer.html")`.

    The page needs no network and no server: the scene's law runs in it as WebAssembly. It has knobs for the numbers of
    the scene (in their units), a map of outcomes over two of them, the moving doublet, and curves.

    Presets that have the same law may be chosen in it; `others` add scenes with laws of their own.

    Arguments:
        scene: a Scene, a path or a preset's name; it has an impact.
        others: as `scene`, such as the same with another bridge law.

    Raises:
        InputError: a scene without an impact. To write the page of a law whose module does not come with the package
            needs a compiler for WebAssembly, which `wetdoublet[explorer]` brings.

    Example:
        >>> import wetdoublet as wd
        >>> page = wd.explore("granulation")
        >>> page.write("explorer.html")  # doctest: +SKIP
    """
    return Explorer(*map(Scene.load, (scene, *others)))


def _built(name: str) -> str:
    return (BUILT / name).read_text(encoding="utf-8")


def _tables(scene: Scene, law: LawSource) -> list[list[str | None]]:
    """Rows of the scene's TOML: table, key, and its text; for a number of the law that number's name, and its unit."""
    rows: list[list[str | None]] = []
    members = {entry.name for entry in law.entries}
    entries = {name: raw for name, raw in scene.given if name.partition(".")[0] != "impact"}
    for entry in law.entries:
        table, _, key = entry.name.partition("_")
        if table == "partner" and scene.partner is None:
            continue  # equal to the first
        unit = "m^3" if f"{table}.{key}" == "bridge.volume" and scene.ways.volume == "absolute" else entry.unit
        rows.append([table, key, None, entry.name, "" if unit == "1" else unit])
    for name, raw in entries.items():
        table, _, key = name.partition(".")
        if name.replace(".", "_", 1) not in members and key not in _SIZES:
            text = "true" if raw is True else json.dumps(raw, ensure_ascii=False)
            rows.append([table, key, text, None, None])
    order = [*dict.fromkeys(name.partition(".")[0] for name in entries)]
    return sorted(rows, key=lambda row: order.index(row[0] or ""))
