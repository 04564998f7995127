"""Laws with many roots: what sympy is asked to factor stays small, at the same slopes."""

import pytest
import sympy as sp
from wetdoublet.derive.emit.taylor.law_slopes import slope_program
from wetdoublet.derive.physics.law import LawFunction
from wetdoublet.derive.physics.scaling import as_product

GAP = sp.Symbol("gap", positive=True)


@pytest.mark.parametrize("count", [3, 30])
def test_a_law_with_many_roots(count: int, monkeypatch: pytest.MonkeyPatch):
    """Up to seven are factored: sympy takes hours for thirty. The form that costs least has the value of the slope."""
    widest, factor = 0, sp.factor

    def watched(expression: sp.Expr) -> sp.Expr:
        nonlocal widest
        widest = max(widest, len({part for part in expression.atoms(sp.Pow) if part.exp == sp.Rational(1, 2)}))
        assert widest <= 7
        return factor(expression)

    monkeypatch.setattr(sp, "factor", watched)
    law = sp.Add(*(sp.sqrt(1 + k * GAP) for k in range(1, count + 1))) / (1 + GAP) ** 2
    _, _, program, results = slope_program(LawFunction("force", (GAP,), law, ""), (GAP,))
    assert isinstance(results[GAP], str)
    assert program.cost < 40 * count
    assert widest == (3 if count == 3 else 0)
    here = {GAP: sp.Rational(1, 3)}
    assert as_product(law.diff(GAP)).subs(here).n() == pytest.approx(law.diff(GAP).subs(here).n(), rel=1e-14)
