"""Texts of all emitted files, and comparison with the package's own folder."""

from __future__ import annotations

import difflib
import hashlib
import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType

from ..equations.model import derive
from ..physics.laws import LAWS
from ..physics.structure import Structure, committed, structures
from .casadi import modules
from .casadi.assemble import ASSEMBLE
from .casadi.automaton import automaton_digest, automaton_module, provenance
from .casadi.references import references_module
from .document.automaton import DIAGRAM, automaton_page
from .document.diagram import diagram
from .shared import homes, with_shared_functions
from .taylor.automaton import automaton_header, criteria_header, effects_header, proofs_header
from .taylor.guards import guards_header

GENERATED = Path(__file__).resolve().parents[2] / "generated"
_IGNORED = ("__pycache__",)


def _package(doc: str) -> str:
    return f'# {modules.PROVENANCE}\n"""{doc}"""\n'


def sha256(text: str) -> str:
    """SHA-256 of an emitted file, as in manifests."""
    return hashlib.sha256(text.encode()).hexdigest()


@cache
def emitted(chosen: tuple[Structure, ...] | None = None) -> Mapping[str, str]:
    """Relative path -> text of every file of `generated/`, manifest included.

    Arguments:
        chosen: structures to emit; None for those in `generated/`. Others are derived on first use.
    """
    files = {
        "__init__.py": _package("Emitted CasADi modules: one per structure, laws in `laws`, groups in `scaling`."),
        "laws/__init__.py": _package("Emitted laws: `<slot>_<name>`, functions of dimensionless arguments."),
        "assemble.py": f"# {modules.PROVENANCE}\n{ASSEMBLE}",
        "scaling.py": modules.scaling_module(),
        "automaton.py": automaton_module(),
        "references.py": references_module(),
        "automaton.md": automaton_page(provenance()),
        DIAGRAM: diagram(provenance()),
        "taylor/automaton.h": automaton_header(provenance()),
        "taylor/criteria.h": criteria_header(provenance()),
        "taylor/proofs.h": proofs_header(provenance()),
        "taylor/guards.h": guards_header(provenance()),
        "taylor/effects.h": effects_header(provenance()),
        "py.typed": "",
    }
    manifest: dict[str, dict[str, object]] = {
        "laws": {},
        "structures": {},
        "scaling": {"scaling": modules.scaling_digest()},
        "automaton": {"automaton": automaton_digest()},
    }
    for slot, laws in LAWS.items():
        for law in laws.values():
            files[f"laws/{law.module}.py"] = modules.law_module(law)
            files[f"taylor/laws/{law.module}.h"] = modules.law_kernel(law)
            files[f"taylor/tangent/laws/{law.module}.h"] = modules.law_slopes(law)
            manifest["laws"][law.module] = {"slot": slot, "name": law.name, "digest": modules.law_digest(law)}
    models = [derive(structure) for structure in (committed() if chosen is None else chosen)]
    shared, headers = homes(models), {}
    for model in models:
        structure = model.structure
        files[f"{structure.name}.py"] = modules.structure_module(model, shared=shared)
        if structure in structures():
            headers[f"taylor/{structure.name}.h"] = modules.structure_kernel(model)
            headers[f"taylor/tangent/{structure.name}.h"] = modules.structure_tangent(model)
        manifest["structures"][structure.name] = modules.model_digest(model)
    files |= with_shared_functions(headers, f"/* {modules.PROVENANCE} */\n")
    manifest["files"] = {name: sha256(text) for name, text in sorted(files.items()) if name.endswith((".py", ".h"))}
    files["manifest.json"] = json.dumps(manifest, indent=1, sort_keys=True) + "\n"
    return MappingProxyType(dict(sorted(files.items())))


def check(folder: Path = GENERATED) -> list[str]:
    """Compare `folder` byte for byte with what would be emitted, without importing it.

    Returns:
        Lines: a unified diff of each file that differs, and a line for each missing or extra file; empty if identical.
    """
    expected = emitted()
    lines: list[str] = []
    for name, text in expected.items():
        path = folder / name
        if not path.is_file():
            lines.append(f"missing: {name}")
        elif (result := path.read_bytes()) != text.encode():
            shown = result.decode(errors="replace")
            lines.append(f"differs: {name}")
            lines += difflib.unified_diff(
                shown.splitlines(), text.splitlines(), f"generated/{name}", f"derived/{name}", lineterm=""
            )
    present = {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_file() and not any(part in _IGNORED for part in path.parts)
    }
    lines += [f"extra: {name}" for name in sorted(present - expected.keys())]
    return lines
