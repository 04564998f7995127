"""The kernel's headers as files: each says what it needs, none needs itself, and a compiler finds nothing amiss."""

import subprocess
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.taylor import source
from wetdoublet.solvers.engines.taylor.headers import headers, tangents
from wetdoublet.solvers.engines.taylor.source import RUNTIME, included
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.model.model import select_model

NAMES = sorted(path.name for path in RUNTIME.glob("*.h"))
MADE = ("settings.h", "layout.h", "automaton.h", "criteria.h", "effects.h", "guards.h", "proofs.h", "model.h")
# What a variant, or a header without those that use it, has no use for is not called; the compiler drops it.
WARNINGS = ("-Wall", "-Wextra", "-Werror", "-Wno-unused-function")
VARIANTS = {
    "plain": {},
    "backwards": {"gradients": True, "backward": True},
    "ledger and trajectory": {"ledger": True, "trajectory": True, "rotation": True},
}


def made(name: str) -> dict[str, str]:
    """The files of a variant of a small model beside the runtime's, for two doubles side by side."""
    choice = select_model(Scene.load("granulation"), True, full=name.startswith("ledger"))
    variant = source.Variant(choice, 9, lanes=2, **VARIANTS[name])
    own, along = headers(choice), tangents(choice)
    assert own is not None
    assert along is not None
    return source.files(variant, own + along if variant.gradients else own)


def test_no_header_needs_itself():
    """What headers include, directly or by others, is no circle, and there is nothing that none includes."""
    asked = {name: included((RUNTIME / name).read_text()) for name in NAMES}
    asked |= {name: included(text) for name, text in made("plain").items()}
    order = [*TopologicalSorter(asked).static_order()]
    assert {*order} == {*NAMES, *MADE}
    assert order[-1] == "entry.h"
    assert [name for name in NAMES if all(name not in others for others in asked.values())] == ["entry.h"]


@pytest.mark.parametrize("name", NAMES)
def test_includes_stand_outside_conditions(name: str):
    """Every `#include "..."` is at the head of its file, after its comment, so that what is put there once is there."""
    text = (RUNTIME / name).read_text()
    head = text.partition("#pragma once\n")[2]
    assert head, "included twice"
    lines = [line for line in head.splitlines() if line]
    own = [k for k, line in enumerate(lines) if line.startswith('#include "')]
    assert own == [*range(len(own))]


@pytest.mark.slow
@pytest.mark.skipif(compiler() is None, reason="no C compiler")
@pytest.mark.parametrize("variant", VARIANTS)
def test_each_header_compiles_alone(variant: str, tmp_path: Path):
    """A C file that includes nothing but one header is sound, whichever header, without a warning."""
    for name, text in made(variant).items():
        (tmp_path / name).write_text(text)
    for name in (*NAMES, *MADE):
        (tmp_path / f"{name}.c").write_text(f'#include "{name}"\n')
    found = compiler()
    assert found is not None
    command = [*found.command, "-fsyntax-only", "-std=gnu11", *WARNINGS, f"-I{RUNTIME}", f"-I{tmp_path}"]
    done = subprocess.run(
        [*command, *map(str, sorted(tmp_path.glob("*.c")))], capture_output=True, text=True, check=False
    )
    assert done.stderr == ""
    assert done.returncode == 0
