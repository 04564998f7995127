r"""A user's model: one small Python file that declares laws, and the quantities that they need, over the vocabulary.

    from wetdoublet.derive.user import *

    stress = quantity("yield_stress", r"\tau_y", unit="Pa", default="10 Pa", bounds=">= 0")
    law("bridge", "mine", force=pi * R * sigma * 2 * cos(phi) + 4 * pi * a**2 * stress, source="...")

A law fills a slot of the library's (`film`, `shear`, `arm`, `glass`, `bridge`, `strings`, ...). Its functions are given
as they are in SI, or dimensionless in the slot's own arguments; `declared` reads such a file.
"""

import math
import re
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from fractions import Fraction

import sympy as sp

from ..physics.law import Law
from ..physics.references import Reference
from ..vocabulary.allowed_values import Bounds, BoundsError
from ..vocabulary.dimensions import ONE, Dimension, UnitError, dimension_of_unit
from ..vocabulary.quantities import VOCABULARY
from . import own_events
from .names import EMITTED, taken

_NAME = re.compile(r"[a-z][a-z0-9_]*")


class ModelFileError(ValueError):
    """An error in a model file: field, value, what is accepted, and the problem in words."""

    def __init__(self, name: str, value: object, accepted: str, problem: str = "is not accepted") -> None:
        super().__init__(f"{name}: {value!r} {problem}; accepted: {accepted}")
        self.field, self.value, self.accepted, self.problem = name, value, accepted, problem


@dataclass(frozen=True)
class Declared:
    """A quantity declared by a model; `over` is the monomial that makes it dimensionless (None: to be determined)."""

    symbol: sp.Symbol
    latex: str
    unit: str
    dimension: Dimension
    default: str | float | None
    bounds: Bounds
    meaning: str
    over: sp.Expr | None
    group: str

    @property
    def name(self) -> str:
        return str(self.symbol.name)


@dataclass(frozen=True)
class Intermediate:
    """A named part of an expression, declared with `let`."""

    symbol: sp.Symbol
    expression: sp.Expr
    latex: str


Source = str | Reference | tuple[Reference, ...]


@dataclass(frozen=True)
class Formula:
    """An expression of a law that has a text or publications of its own, as `Formula(..., source=...)`.

    Arguments:
        expression: in SI or dimensionless.
        doc: what it is, if not what the slot says.
        source: its origin, if not that of the law: text, or publications.
        remark: what is said after them.
    """

    expression: sp.Expr
    doc: str = ""
    source: Source = ""
    remark: str = ""


@dataclass(frozen=True)
class Proposed:
    """A law as declared in the file, without its functions, and these by name, in SI or dimensionless."""

    law: Law
    functions: Mapping[str, Formula]
    accept: tuple[str, ...]
    bibtex: str
    falls: bool


@dataclass(frozen=True)
class Criterion:
    """A rebound criterion as declared: the gap in SI at which it is met, and its group, that gap over x0."""

    name: str
    gap: sp.Expr
    group: sp.Symbol
    meaning: str
    source: str

    @property
    def word(self) -> str:
        return self.name.replace("_", " ")


@dataclass
class Declarations:
    """Everything that a file declares, in order.

    Arguments:
        taken: names of laws by slot that are the library's.
        library: the file is one of the library, whose names its emitted text has.
    """

    taken: Mapping[str, Collection[str]] = field(default_factory=dict)
    library: bool = False

    quantities: dict[str, Declared] = field(default_factory=dict)
    intermediates: dict[str, Intermediate] = field(default_factory=dict)
    laws: dict[tuple[str, str], Proposed] = field(default_factory=dict)
    events: dict[str, own_events.Proposed] = field(default_factory=dict)
    positive: list[sp.Expr] = field(default_factory=list)
    energies: list[sp.Expr] = field(default_factory=list)
    forces: list[tuple[str, sp.Expr]] = field(default_factory=list)
    criteria: dict[str, Criterion] = field(default_factory=dict)


_here = ContextVar("declarations", default=Declarations())  # noqa: B039 -- of a model file that is run directly


def declarations() -> Declarations:
    """What the file that is read has declared so far."""
    return _here.get()


@contextmanager
def collecting(taken: Mapping[str, Collection[str]] | None = None, library: bool = False) -> Iterator[Declarations]:
    """Collect the declarations made inside the block.

    Arguments:
        taken: names of laws by slot that none may have.
        library: of a file of the library.
    """
    token = _here.set(Declarations(taken or {}, library))
    try:
        yield _here.get()
    finally:
        _here.reset(token)


def quantity(
    name: str,
    latex: str = "",
    *,
    unit: str | None = None,
    default: str | float | None = None,
    bounds: str = "> 0",
    meaning: str = "",
    over: sp.Expr | None = None,
    group: str = "",
) -> sp.Symbol:
    """Declare a quantity of the model; scenes give its value in their `[custom]` table.

    Arguments:
        name: its name in scene files and in emitted code.
        latex: its symbol in print; by default the name, upright.
        unit: coherent SI, as "Pa", "N/m", "kg m^2/s"; "1", the default, for a plain number. One that is
            declared before may stand as an exponent, as in "Pa s^index".
        default: value with unit for scenes that give none, as "10 Pa"; None: scenes must give one.
        bounds: allowed values, in `unit`: ">", ">=", "<" or "<=" and a number, two of them joined by "and", or
            "0 to 1", which includes its ends.
        over: quantities that make it dimensionless: quantity/over is a group; determined if not given.
        group: name of that group; by default NAME_number.

    Raises:
        ModelFileError: names the wrong argument and what is accepted.
    """
    model = declarations()
    group = group or f"{name}_number"
    numbers = {item.name: item.symbol for item in model.quantities.values() if item.dimension == ONE}
    if unit is None and _is_unit(latex):
        accepted = f'unit="{latex}", or unit="1" beside it for a plain number that has this symbol in print'
        raise ModelFileError(f"{name}.latex", latex, accepted, "is a unit, where the symbol in print stands")
    unit = "1" if unit is None else unit
    try:
        dimension, limits = dimension_of_unit(unit, numbers), Bounds.read(bounds)
    except UnitError as error:
        raise ModelFileError(f"{name}.unit", unit, 'coherent SI, as "Pa", "N/m", "kg m^2/s", "1"', str(error)) from None
    except BoundsError:
        raise ModelFileError(f"{name}.bounds", bounds, '"> 0", ">= 0", "0 to 1", "> 0 and <= 5"') from None
    check_name("quantity", name, model, in_functions=dimension == ONE)
    check_name(f"{name}.group", group, model)
    if over is not None and not isinstance(over, sp.Expr):
        raise ModelFileError(f"{name}.over", over, "an expression of the vocabulary, as mu*v0/x0")
    sign = {"positive": True} if limits.positive else {"nonnegative": True} if limits.not_negative else {"real": True}
    symbol = sp.Symbol(name, **sign)
    upright = rf"\mathrm{{{name.replace('_', ' ')}}}".replace(" ", r"\ ")
    printed, meaning = latex or upright, meaning or name.replace("_", " ")
    model.quantities[name] = Declared(symbol, printed, unit, dimension, default, limits, meaning, over, group)
    return symbol


def _is_unit(text: str) -> bool:
    try:
        dimension_of_unit(text)
    except UnitError:
        return False
    return True


def let(name: str, expression: object, latex: str = "") -> sp.Symbol:
    """Name a part of an expression; the name is kept in print, and in emitted code unless it means something there."""
    model = declarations()
    means = {} if model.library else taken()
    written = f"{name}_" if isinstance(name, str) and name in means.keys() - VOCABULARY.keys() else name
    check_name("let", written, model)
    value = read_expression(name, expression)
    claimed = value.xreplace({claim: sp.Dummy(positive=True) for claim in model.positive})
    sign = next((kind for kind in ("positive", "nonnegative") if getattr(claimed, f"is_{kind}")), "real")
    symbol = sp.Symbol(written, **{sign: True})
    upright = rf"\mathrm{{{name}}}".replace("_", r"\_")
    model.intermediates[written] = Intermediate(symbol, value, latex or upright)
    return symbol


def positive(expression: object) -> sp.Expr:
    """The expression, claimed to be positive wherever a law of the file is used: no guard is put where it vanishes.

    It is dimensionless, in the arguments of the slot.
    """
    model = declarations()
    model.positive.append(read_expression("positive", expression))
    return model.positive[-1]


def unfolded(expression: sp.Expr, model: Declarations) -> sp.Expr:
    """The expression with every `let` substituted."""
    for definition in reversed(model.intermediates.values()):
        expression = expression.xreplace({definition.symbol: definition.expression})
    return expression


def check_texts(label: str, **texts: object) -> None:
    """ModelFileError for what is no text, or would end a comment in C, by name."""
    for what, text in texts.items():
        if not isinstance(text, str) or "*/" in text:
            raise ModelFileError(f"{label}.{what}", text, "text without */")


def check_name(what: str, name: object, model: Declarations, in_functions: bool = True) -> None:
    """ModelFileError for a name that is declared already, or means something where it is written."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ModelFileError(what, name, "a name of small letters, digits and underscores")
    declared = {*model.quantities, *model.intermediates, *(other.group for other in model.quantities.values())}
    declared |= {word for other in model.events for word in (other, own_events.MARK + other)}
    declared |= {word for other in model.criteria for word in (other, f"{other}_gap")}
    of_library = VOCABULARY.get(name)
    local = what == "let" and of_library is not None and not own_events.may_use(of_library.symbol)  # in no law
    meaning = "" if local or model.library else taken().get(name, "")
    if name in declared or (meaning and (in_functions or meaning != EMITTED)):
        problem = "is taken already" + (f": it is {meaning}" if meaning else "")
        raise ModelFileError(what, name, "a name that is not taken", problem)


def read_expression(label: str, value: object) -> sp.Expr:
    """A sympy expression with every decimal as an exact rational."""
    try:
        result = sp.sympify(value)
    except (sp.SympifyError, TypeError, AttributeError):
        raise ModelFileError(label, value, "a sympy expression") from None
    if not isinstance(result, sp.Expr) or isinstance(value, str):
        raise ModelFileError(label, value, "a sympy expression")
    return result.xreplace({number: _exact(number) for number in result.atoms(sp.Float)})


def _exact(number: sp.Float) -> sp.Rational:
    """The decimal or fraction that was meant, where rounding explains the rest: 1/3, and 0.6 for 1.5*0.4."""
    value = float(number)
    near = Fraction(value).limit_denominator(1000)
    return sp.Rational(near) if abs(float(near) - value) <= 2 * math.ulp(value) else sp.Rational(str(value))


def latex_names(model: Declarations, groups: Mapping[str, str]) -> dict[str, str]:
    """LaTeX of every name that a model adds to the vocabulary."""
    names = {item.name: item.latex for item in model.quantities.values()}
    names |= {item.symbol.name: item.latex for item in model.intermediates.values()}
    names |= {item.mark.name: rf"1_{{\mathrm{{{item.word}}}}}".replace(" ", r"\ ") for item in model.events.values()}
    return names | dict(groups)
