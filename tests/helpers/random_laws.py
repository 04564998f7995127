"""Laws drawn at random from a grammar, as a stranger may write them: a model file for any number."""

from random import Random

SLOTS = ("film", "bridge", "arm", "shear", "attraction")
_HEAD = '"""A law drawn at random."""\nfrom wetdoublet.derive.user import *\n\n'
_QUANTITIES = (
    'own = quantity("own", unit="1", default="0.6", bounds="> 0 and <= 2")',
    'reach = quantity("reach", unit="m", default="{reach} um", bounds="> 0")',
)
# Every law is one of the library's times a factor of the gap, and where a slot allows it of the velocity
_LAWS = {
    "film": 'law("film", "mine", resistance=6*pi*mu*a**2*u/x*(1 - x/x0)**2*({factor}))',
    "bridge": 'law("bridge", "mine", force=2*pi*R*sigma*exp(-x/x0/3)*({factor}))',
    "arm": 'law("arm", "mine", lever=2*a + x/2*({factor}), accept=("angular momentum",))',
    "shear": 'law("shear", "mine", log_factor=log(2*a/x)*({factor}), edge=2/aspect)',
    "attraction": 'law("attraction", "mine", force=(x0/x)**2*({factor}))',
}


class _Grammar:
    """Expressions of a gap, a velocity where there is one, numbers and quantities of one's own."""

    def __init__(self, random: Random, moves: bool) -> None:
        self.random, self.moves = random, moves

    def number(self) -> str:
        return f"{self.random.uniform(0.2, 2.0):.3g}"

    def atom(self) -> str:
        atoms = ["x/x0", "x/x0", "x/reach", "own", self.number()] + (["u/v0", "u/v0"] if self.moves else [])
        return self.random.choice(atoms)

    def condition(self) -> str:
        one = self.random.choice([f"x/x0 < {self.random.uniform(0.3, 0.9):.3g}", "x > reach", "x/reach <= own"])
        if self.moves and self.random.random() < 0.5:
            one = self.random.choice(["u >= 0", "u/v0 < own - 1", f"({one}) & (u < 0)"])
        return one

    def signed(self, depth: int) -> str:
        """An expression of any sign."""
        if depth == 0:
            return self.atom()
        inner = self.positive(depth - 1)
        return self.random.choice([f"({inner} - {self.number()})", f"({inner} - own*{self.atom()})", self.atom()])

    def positive(self, depth: int) -> str:
        """An expression that is not negative."""
        if depth == 0:
            return self.random.choice(["x/x0", "own", self.number(), "x/reach"])
        one, other = self.positive(depth - 1), self.positive(depth - 1)
        signed = self.signed(depth - 1)
        power = self.random.choice(["2", "0.5", "1.5", "own", "3", "0.7"])
        return self.random.choice([
            f"({one} + {other})", f"({one})*({other})", f"({one})**{power}",
            f"Abs({signed})", f"Abs({signed})**{power}", f"Max({signed}, {self.number()})", f"Max({signed}, 0)", f"Max({signed}, 0)**{power}",
            f"Min(Abs({signed}), {self.number()})", f"exp(-({one}))", f"sqrt(({signed})**2 + own)",
            f"Piecewise(({one}, {self.condition()}), ({other}, True))", f"tanh({one})", f"1/(1 + {one})",
        ])  # fmt: skip


def random_law(number: int) -> tuple[str, str]:
    """Slot and text of a model file."""
    random = Random(number)
    slot = SLOTS[number % len(SLOTS)]
    grammar = _Grammar(random, slot in ("film", "shear"))
    factor = f"{grammar.number()} + {grammar.positive(random.choice([1, 2, 2, 3]))}"
    text = _LAWS[slot].format(factor=factor)
    quantities = [
        each.format(reach=f"{random.uniform(2, 7):.2g}") for each in _QUANTITIES if each.split(" = ")[0] in text
    ]
    return slot, _HEAD + "\n".join([*quantities, text]) + "\n"
