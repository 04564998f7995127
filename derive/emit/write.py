"""Texts of all emitted files, and comparison with the package's own folder."""

import difflib
import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path, PurePosixPath
from types import MappingProxyType

from ..equations.model import Model, derive
from ..laws import LAWS
from ..physics.structure import Structure, committed, structures
from .casadi import modules
from .casadi.assemble import ASSEMBLE
from .casadi.automaton import automaton_digest, automaton_module, provenance
from .casadi.modules import function_lines
from .casadi.printer import Printer
from .casadi.references import references_module
from .interval import header as interval
from .provenance import PROVENANCE, law_digest, model_digest
from .taylor.automaton import automaton_header, criteria_header, effects_header, proofs_header
from .taylor.guards import guards_header
from .taylor.header import structure_header
from .taylor.law_header import law_header
from .taylor.law_slopes import slopes_header
from .taylor.tangent import tangent_header

_ENCLOSED = ("film_finite", "glass_literal", "shear_immersed", "bridge_mikami")  # the others on first use
GENERATED = Path(__file__).resolve().parents[2] / "generated"


def _package(doc: str) -> str:
    return f'# {PROVENANCE}\n"""{doc}"""\n'


def sha256(text: str) -> str:
    """SHA-256 of an emitted file, as in manifests."""
    return hashlib.sha256(text.encode()).hexdigest()


@cache
def emitted(chosen: tuple[Structure, ...] | None = None) -> Mapping[str, str]:
    """Relative path -> text of every file of `generated/`, manifest included.

    Arguments:
        chosen: structures to emit; None for those in `generated/`. Others are derived on first use.
    """
    named = {slot: {law.name: modules.features(law) for law in laws.values()} for slot, laws in LAWS.items()}
    files = {
        "__init__.py": _package("Emitted CasADi modules: one per structure, laws in `laws`, groups in `scaling`."),
        "laws/__init__.py": _package("Emitted laws: `<slot>_<name>`, functions of dimensionless arguments."),
        "laws.json": json.dumps(named, indent=1) + "\n",
        "assemble.py": f"# {PROVENANCE}\n{ASSEMBLE}",
        "scaling.py": modules.scaling_module(),
        "automaton.py": automaton_module(),
        "references.py": references_module(),
        "taylor/automaton.h": automaton_header(provenance()),
        "taylor/criteria.h": criteria_header(provenance()),
        "taylor/proofs.h": proofs_header(),
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
            if law.module in _ENCLOSED:
                files[f"interval/laws/{law.module}.h"] = interval.law_header(law)
            files[f"laws/{law.module}.py"] = modules.law_module(law)
            files[f"taylor/laws/{law.module}.h"] = law_header(law)
            files[f"taylor/tangent/laws/{law.module}.h"] = slopes_header(law)
            manifest["laws"][law.module] = {"slot": slot, "name": law.name, "digest": law_digest(law)}
    models = [derive(structure) for structure in (committed() if chosen is None else chosen)]
    shared, headers = homes(models), {}
    for model in models:
        structure = model.structure
        files[f"{structure.name}.py"] = modules.structure_module(model, shared=shared)
        if (structure in structures() and structure.reduced) or structure.name == "oblique_pair_bridge":
            files[f"interval/{structure.name}.h"] = interval.structure_header(model)
        if structure in structures():
            headers[f"taylor/{structure.name}.h"] = structure_header(model)
            headers[f"taylor/tangent/{structure.name}.h"] = tangent_header(model)
        manifest["structures"][structure.name] = model_digest(model)
    files |= with_shared_functions(headers, f"/* {PROVENANCE} */\n")
    manifest["files"] = {
        name: sha256(text) for name, text in sorted(files.items()) if name.endswith((".py", ".h", ".json"))
    }
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
            old, titles = result.decode(errors="replace").splitlines(), (f"generated/{name}", f"derived/{name}")
            lines += [f"differs: {name}", *difflib.unified_diff(old, text.splitlines(), *titles, lineterm="")]
    files = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    present = {path.relative_to(folder).as_posix() for path in files}
    lines += [f"extra: {name}" for name in sorted(present - expected.keys())]
    return lines


_LEAST = 8  # lines of a C function that is worth a file of its own
_C_FUNCTION = re.compile(
    r"(?:/\*.*?\*/\n)?(?:static inline|INLINE|OUTLINE) [^;{]*?(\w+)\([^;{]*\)\n\{\n.*\n\}", re.DOTALL
)


def homes(models: Iterable[Model]) -> dict[str, str]:
    """Text of every Python function of several structures -> name of the first one, which defines it."""
    first: dict[str, str] = {}
    for model in models:
        for function in (candidate for candidate in model.functions if not candidate.certificate):
            first.setdefault("\n".join(function_lines(model, function.name, Printer())), model.structure.name)
    return first


def with_shared_functions(headers: Mapping[str, str], provenance: str) -> dict[str, str]:
    """C headers whose common functions are included from `taylor/shared/`, and the files there.

    Arguments:
        headers: texts by path; functions are set apart by blank lines.
        provenance: the first line of a file.
    """
    users: dict[str, list[str]] = {}
    for path, text in headers.items():
        for block in text.rstrip("\n").split("\n\n"):
            if block.count("\n") + 1 >= _LEAST:
                users.setdefault(block, []).append(path)
    files = dict(headers)
    for block, paths in users.items():
        if len(paths) > 1 and (function := _C_FUNCTION.fullmatch(block)):
            name = f"shared/{function[1]}_{PurePosixPath(paths[0]).stem}.h"
            files[f"taylor/{name}"] = f"{provenance}{block}\n"
            for path in paths:
                files[path] = files[path].replace(f"\n{block}\n", f'\n#include "{name}"\n')
    return files
