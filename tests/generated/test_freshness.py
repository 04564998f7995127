"""The committed folder is what the derivation emits, byte for byte, on the hash seed of any run; it stands alone."""

import ast
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.derive.emit.write import GENERATED, check
from wetdoublet.solvers.host.emitted import module, text

# as committed, which is as emitted by the first test: nothing is derived to collect these tests
TEXTS = {
    path.relative_to(GENERATED).as_posix(): path.read_text()
    for path in sorted(GENERATED.rglob("*"))
    if path.is_file() and "__pycache__" not in path.parts
}
MODULES = [name for name in TEXTS if name.endswith(".py")]


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of the committed folder."""
    return Path(shutil.copytree(GENERATED, tmp_path / "generated", ignore=shutil.ignore_patterns("__pycache__")))


@pytest.mark.slow
def test_committed_folder_is_fresh():
    """Nothing in generated/ differs from what would be emitted; if it does, run `wetdoublet generate`."""
    assert check() == []


@pytest.mark.slow
def test_what_differs_is_named(copy: Path):
    """An edit with a diff of its lines, another line ending, missing and extra files, also where nothing imports."""
    edited, ended, broken = (copy / name for name in ("laws/arm_midgap.py", "oblique.py", "automaton.py"))
    edited.write_text(edited.read_text().replace("return distance/2", "return distance/3"))
    ended.write_bytes(ended.read_bytes().replace(b"\n", b"\r\n"))
    broken.write_text("OUTCOMES = (\n")
    for name in ("head_on.py", "taylor/automaton.h"):
        (copy / name).unlink()
    (copy / "laws" / "bridge_wishful.py").write_text("")
    (copy / "__pycache__").mkdir()
    (copy / "__pycache__" / "oblique.pyc").write_text("")
    lines = check(copy)
    assert {line for line in lines if line.startswith(("differs", "missing", "extra"))} == {
        "differs: laws/arm_midgap.py", "differs: oblique.py", "differs: automaton.py",
        "missing: head_on.py", "missing: taylor/automaton.h", "extra: laws/bridge_wishful.py",
    }  # fmt: skip
    assert {"-    return distance/3", "+    return distance/2"} <= {*lines}


def _functions(module: str) -> dict[str, str | None]:
    """Source of every function of a module."""
    parts = ast.parse(module).body
    return {part.name: ast.get_source_segment(module, part) for part in parts if isinstance(part, ast.FunctionDef)}


def test_what_structures_share_is_emitted_once():
    """No function stands in two structures, in Python or (from eight lines) in C; an importing one has them all."""
    python = [f for name in MODULES if "/" not in name for f in _functions(TEXTS[name]).values()]
    assert len(set(python)) == len(python) > 100
    headers = [text for name, text in TEXTS.items() if name.endswith(".h") and "/laws/" not in name]
    blocks = [block.strip() for text in headers for block in text.split("\n\n") if block.count("\n") >= 8]
    functions = [
        b for b in blocks if re.match(r"(/\*(.|\n)*?\*/\n)?(static inline|INLINE|OUTLINE)", b) and b[-2:] == "\n}"
    ]
    assert len(set(functions)) == len(functions) > 100
    for name in json.loads(TEXTS["manifest.json"])["structures"]:
        emitted = module(name)
        assert all(callable(getattr(emitted, function)) for function in emitted.FUNCTIONS)
        assert set(emitted.FUNCTIONS) <= _functions(text(name)).keys()


_BLOCKED = """
import importlib, pkgutil, sys

class NoSympy:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] == "sympy":
            raise ImportError("sympy is blocked here")

sys.meta_path.insert(0, NoSympy())
count = 0
for package in ("wetdoublet.generated", "wetdoublet.solvers"):
    root = importlib.import_module(package)
    for found in pkgutil.walk_packages(root.__path__, package + "."):
        if not found.name.endswith("__main__"):
            try:
                importlib.import_module(found.name)
            except ImportError as error:
                if "wetdoublet[" not in str(error):  # an extra is not installed
                    raise
            count += 1
assert "sympy" not in sys.modules
try:
    import wetdoublet.derive.equations.model
except ImportError:
    print(count)
"""


@pytest.mark.slow
def test_generated_and_solvers_live_without_sympy():
    """Every module of generated and solvers is imported where importing sympy raises (and derive is not)."""
    done = subprocess.run([sys.executable, "-c", _BLOCKED], capture_output=True, text=True, timeout=900, check=False)
    assert done.returncode == 0, done.stderr
    roots = (GENERATED, GENERATED.parent / "solvers")
    own = [path for root in roots for path in root.rglob("*.py") if path.parent not in roots]
    assert int(done.stdout) >= len([path for path in own if path.name != "__main__.py"])


def test_generated_imports_only_casadi_and_the_standard_library():
    """An emitted module imports casadi, the standard library, and nothing of ours outside generated."""
    for name in MODULES:
        for node in ast.walk(ast.parse(TEXTS[name])):
            if isinstance(node, ast.ImportFrom) and node.level:
                assert node.level <= name.count("/") + 1, name
            elif isinstance(node, ast.Import | ast.ImportFrom):
                imported = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [str(node.module)]
                assert {each.split(".")[0] for each in imported} <= {"casadi", *sys.stdlib_module_names}, name


def test_emitted_text_is_timeless_and_placeless():
    """No dates, no times, no absolute paths, no tabs or trailing blanks, one newline at the end."""
    for name, emission in TEXTS.items():
        assert not re.search(r"\b(19|20)\d\d-\d\d|\b\d\d:\d\d\b", emission), name
        assert not re.search(r"(?<![\w)\]*/])/(home|tmp|work|usr|Users)\b|[A-Z]:\\", emission), name
        assert str(GENERATED.parent) not in emission, name
        assert "\t" not in emission, name
        assert all(line == line.rstrip() for line in emission.splitlines()), name
        assert not emission or (emission.endswith("\n") and not emission.endswith("\n\n")), name


def _digests() -> dict[str, str]:
    manifest = json.loads((GENERATED / "manifest.json").read_text())
    laws = {f"laws/{module}.py": entry["digest"] for module, entry in manifest["laws"].items()}
    return laws | {
        f"{name}.py": digest
        for part in ("structures", "scaling", "automaton")
        for name, digest in manifest[part].items()
    }


def test_the_manifest_has_the_digest_of_every_module():
    """Of each law, each structure, the scaling and the automaton, and of nothing else: it is that of the header, and
    of a structure's DIGEST.
    """
    derived = {name for name in MODULES if not name.endswith("__init__.py")}
    derived -= {"assemble.py", "references.py"}  # which hold no equations
    assert _digests().keys() == derived
    for name, digest in _digests().items():
        assert TEXTS[name].splitlines()[1].removeprefix("# ").split(" sha256 ")[1] == digest, name
        if "/" not in name and name not in ("scaling.py", "automaton.py"):
            assert digest == module(name.removesuffix(".py")).DIGEST, name
