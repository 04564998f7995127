"""The conditions of rules and the inequalities of stick certificates decide in the kernel as they are declared."""

import ctypes
import inspect
from collections.abc import Callable

import numpy as np
import pytest
from wetdoublet.derive.equations.automaton import arguments
from wetdoublet.derive.equations.certificates.table import CERTIFICATES
from wetdoublet.generated import automaton
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.taylor import source as text
from wetdoublet.solvers.engines.taylor.headers import headers
from wetdoublet.solvers.engines.taylor.source import resolved
from wetdoublet.solvers.host.compiler import compiler, library
from wetdoublet.solvers.host.user_cache import loaded
from wetdoublet.solvers.model.model import select_model

from ....helpers.flags import QUICK

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")

CONDITIONS = {
    name: each
    for name, each in vars(automaton).items()
    if inspect.isfunction(each) and each.__module__ == automaton.__name__
}
PROOFS = {
    proof.name: eval(f"lambda {', '.join(arguments(proof.test))}: {proof.test}", vars(automaton))
    for row in CERTIFICATES
    for proof in row.proofs
}
VALUES = [0.0, 1.0, 1e-13, 1e-9, 1e9, float("nan")]


def call(name: str, condition: Callable[..., bool]) -> str:
    """A C function that returns a condition of numbers in an array."""
    numbers = [
        f"splat(x[{k}])" if name in PROOFS and each != "margin" else f"x[{k}]"
        for k, each in enumerate(inspect.signature(condition).parameters)
    ]
    result = f"{name}({', '.join(numbers)})"
    result = f"LANE({result}, 0) != 0" if name in PROOFS else result
    return f"int call_{name}(const double *x) {{ return {result}; }}\n"


@pytest.fixture(scope="module")
def kernel() -> ctypes.CDLL:
    """The conditions as compiled."""
    choice = select_model(Scene.load("granulation"), True)
    emitted = headers(choice)
    assert emitted is not None
    calls = '#include "guards.h"\n' + "".join(call(*each) for each in (CONDITIONS | PROOFS).items())
    whole = resolved(calls, text.files(text.Variant(choice, 9, lanes=2), emitted))
    return loaded(library(whole, ("-std=gnu11", "-fPIC", "-shared", *QUICK.split())), ctypes.CDLL)


@pytest.mark.parametrize("name", CONDITIONS | PROOFS)
def test_a_condition_is_the_declared_one(kernel: ctypes.CDLL, name: str) -> None:
    """For numbers of any size, on limits, and for NaN, with which no condition holds; both answers occur."""
    condition, rng = (CONDITIONS | PROOFS)[name], np.random.default_rng(7)
    compiled = getattr(kernel, f"call_{name}")
    names, answers = list(inspect.signature(condition).parameters), set()
    for _ in range(1000):
        some = np.where(rng.random(len(names)) < 0.5, rng.choice(VALUES, len(names)), rng.normal(size=len(names)))
        numbers = [abs(value) if each in ("aspect", "margin") else value for each, value in zip(names, some.tolist())]
        expected = bool(condition(*numbers))
        assert bool(compiled((ctypes.c_double * len(names))(*numbers))) == expected, numbers
        answers.add(expected)
    assert answers == {True, False}
