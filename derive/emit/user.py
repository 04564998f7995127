"""A user's model as a package of emitted files: laws, the structures they change, groups, and a manifest.

The manifest has a digest of every file. `model.py` is the model file itself, from which the rest can be derived again.
"""

import json
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

from ..equations.model import derive
from ..physics.structure import Structure, structures
from ..physics.terms import Terms
from ..user.declarations import Criterion
from ..user.own_events import OwnEvent
from ..user.structures import UserModel
from ..vocabulary.quantities import VOCABULARY
from .casadi.modules import features, groups_module, law_module, structure_module
from .casadi.references import of_law
from .provenance import PROVENANCE, Own, digest, law_digest, model_digest
from .write import sha256

FORMAT = 1
SOURCE = "model.py"
_DOC = (
    "The dimensionless groups that this model adds, from SI quantities.\n\nSame interface as the library's `scaling`."
)


def package(
    model: UserModel,
    source: str,
    library: str,
    conserves: Iterable[str],
    words: Iterable[str],
    origin: str = "",
    table: str = "",
) -> dict[str, str]:
    """Relative path -> text of every file of a model's package, manifest included.

    Arguments:
        conserves, words: what its checks say of the model.
        source: text of the model file.
        library: digest of the library's own equations, which the model extends.
        origin: path of the model file as seen from the package.
        table: of a law of the library, the scene's table that has its quantities.
    """
    names = own_names(model)
    files = {SOURCE: source}
    laws = []
    for law in model.laws:
        path = f"laws/{law.module}.py"
        files[path] = law_module(law)
        laws.append({
            "slot": law.slot, "name": law.name, "file": path, "digest": law_digest(law), "meaning": law.meaning,
            "features": features(law), "source": law.source,
            "references": {use: [asdict(entry) for entry in publications] for use, publications in of_law(law).items()},
            "bibtex": model.declarations.laws[law.slot, law.name].bibtex,
        })  # fmt: skip
    changed = {key.split(".")[0] for key in model.extra}
    digests: dict[str, str] = {}
    # declared events and terms change every structure, derived where a scene needs it
    for structure in structures() if changed and not model.terms else ():
        if not changed & set(derive(structure).slots):
            continue
        extended = model.derived(structure)
        files[f"{structure.name}.py"] = structure_module(extended, names)
        digests[structure.name] = model_digest(extended)
    definitions = {group.symbol: group.definition for group in model.groups if group.symbol != group.quantity.symbol}
    definitions |= model.gaps
    scaling = ""
    if definitions:
        scaling = digest(*(term for pair in definitions.items() for term in pair))
        files["scaling.py"] = groups_module(definitions, names, scaling, _DOC)
    file = Path(origin).name or f"{model.name}.py"
    own = PROVENANCE.partition(" from ")[0] + f" from {file}. Do not edit: change {file} and run `wetdoublet generate`."
    files = {path: text if path == SOURCE else text.replace(PROVENANCE, own, 1) for path, text in files.items()}
    manifest = {
        "kind": "wetdoublet model", "format": FORMAT, "name": model.name, "meaning": model.meaning, "origin": origin,
        "library": library, "laws": laws, **({"table": table} if table else {}),
        **({"events": [_event(event) for event in model.events]} if model.events else {}),
        **({"criteria": [_criterion(criterion) for criterion in model.criteria]} if model.criteria else {}),
        **({"terms": _terms(model.terms)} if model.terms else {}),
        "structures": digests, "scaling": scaling,
        "extra": {key: [symbol.name for symbol in extra] for key, extra in model.extra.items()},
        "quantities": [_quantity(model, name) for name in model.declarations.quantities],
        "conserves": list(conserves), "words": list(words),
        "files": {name: sha256(text) for name, text in sorted(files.items())},
    }  # fmt: skip
    files["manifest.json"] = json.dumps(manifest, indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    return dict(sorted(files.items()))


def own_names(model: UserModel) -> Own:
    """(unit, meaning) of the vocabulary and of the model's declarations, by name."""
    return {
        **{name: (quantity.unit, quantity.meaning) for name, quantity in VOCABULARY.items()},
        **{quantity.name: (quantity.unit, quantity.meaning) for quantity in model.declarations.quantities.values()},
        **{
            g.symbol.name: ("1", f"{g.quantity.meaning}, over {g.over}")
            for g in model.groups
            if g.definition != g.symbol
        },
        **{criterion.group.name: ("1", f"{criterion.meaning}, over x0") for criterion in model.criteria},
        **{e.mark.name: ("1", f"1 before the event {e.proposed.word}, 0 after it") for e in model.events},
    }


def _event(event: OwnEvent) -> dict[str, object]:
    """A row of the automaton, and what the certificates may know of the event."""
    reach = event.reach(Structure(True, True, False))
    return {
        **asdict(event.proposed.row),
        **{name: getattr(event, name) for name in ("takes", "harmless", "rotates", "turns", "spins")},
        "mark": event.mark.name, "meaning": event.proposed.meaning, "source": event.proposed.source,
        "reach": asdict(reach) if reach.is_known else None,
    }  # fmt: skip


def _criterion(criterion: Criterion) -> dict[str, str]:
    texts = {"meaning": criterion.meaning, "source": criterion.source}
    return {"word": criterion.word, "group": criterion.group.name, **texts}


def _terms(terms: Terms) -> dict[str, bool]:
    """What a scene must not have beside the terms, and what the certificates may know of them."""
    return {name: getattr(terms, name) for name in ("rotates", "drives", "admits_barrier")}


def _quantity(model: UserModel, name: str) -> dict[str, object]:
    item = model.declarations.quantities[name]
    group = next(group for group in model.groups if group.quantity.name == name)
    return {
        "name": name, "symbol": item.latex, "unit": item.unit, "default": item.default, "bounds": item.bounds.to_json(),
        "meaning": item.meaning, "group": group.symbol.name, "over": str(group.over),
    }  # fmt: skip
