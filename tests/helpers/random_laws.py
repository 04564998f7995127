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
            f"Abs({signed})", f"Abs({signed})**{power}", f"Max({signed}, {self.number()})",
            f"Max({signed}, 0)", f"Max({signed}, 0)**{power}",
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


# Terms, criteria and events beside a law: each line may need quantities, whose defaults suit the granulation preset
_OWN = {
    "pull": 'pull = quantity("pull", unit="N", default="{0:.3g} N", bounds="> -1")',
    "drag": 'drag = quantity("drag", unit="kg/s", default="{1:.3g} kg/s", bounds=">= 0")',
    "added": 'added = quantity("added", unit="kg", default="{2:.3g} kg", bounds=">= 0")',
    "torque": 'torque = quantity("torque", unit="N m", default="{3:.3g} N m", bounds="> -1")',
    "layer": 'layer = quantity("layer", unit="m", default="{4:.3g} um", bounds=">= 0")',
    "strength": 'strength = quantity("strength", unit="1", default="{5:.3g}", bounds="> -10 and < 10")',
}
_TERMS = (
    "energy(pull*x0*({smooth}))", "energy(strength*m*v0**2/10*({smooth}))", "energy(added*u**2/2*({smooth}))",
    "energy(added*R**2*omega**2/2)", "energy(added*R**2*xi**2*({smooth}))", "energy(torque*(1 - cos(beta))*({smooth}))",
    "energy(pull*r*cos(beta + {number}))", "energy(torque*beta**2/2)",
    'force_on("gap", -drag*u*({smooth}))', 'force_on("gap", pull*({smooth}))', 'force_on("gap", -drag*u**3/v0**2)',
    'force_on("gap", strength*m*v0**2/x0/20*({smooth}))', 'force_on("gap", added*R*omega**2)',
    'force_on("rotation", -torque*tanh(omega*x0/v0))', 'force_on("rotation", torque*({smooth}))',
    'force_on("rotation", -drag*R**2*omega)', 'force_on("spin", -drag*R**2*xi)',
    'force_on("spin", drag*R**2*(omega - xi))\nforce_on("rotation", drag*R**2*(xi - omega))',
)  # fmt: skip
_BAD_TERMS = (
    'force_on("gap", -drag*Abs(u))', 'force_on("gap", pull*t*v0/x0)', "energy(added*u*omega*R)", "energy(pull*u)",
    'force_on("angle", torque)', 'force_on("rotation", pull)', "energy(added*u**4/v0**2)", "energy(pull*Max(x, layer))",
    'criterion("soft", gap=x/2)', 'criterion("soft", gap=torque)', 'criterion("glass", gap=layer)',
)  # fmt: skip
_SMOOTH = (
    "1", "x/x0", "exp(-x/x0)", "1/(1 + x/x0)", "(x/x0)**2", "sqrt(1 + x/x0)", "2 + cos(3*x/x0)", "(x/x0)**0.5",
    "log(2 + x/x0)", "atan(x/x0)",
)  # fmt: skip
_EVENTS = (
    'event("late", guard=x/x0 - {number}*u/v0, where="opening", jump={{u: u*{part}}})',
    'event("deep", guard=x - x0*{part}, where="closing", jump={{omega: omega*{part}, xi: xi*{part}}})',
)


def random_model(number: int) -> str:
    """Text of a model file with terms, and perhaps a law, a criterion and an event; one in eight cannot be."""
    random = Random(number)
    fill = {
        "smooth": random.choice(_SMOOTH), "number": f"{random.uniform(0.1, 1.5):.3g}",
        "part": f"{random.uniform(0.3, 0.95):.3g}",
    }  # fmt: skip
    lines = [each.format(**fill) for each in random.sample(_TERMS, random.choice([1, 1, 2, 3]))]
    if random.random() < 0.3:
        lines.append('criterion("soft", gap=layer)')
    if random.random() < 0.15:
        lines.append(random.choice(_EVENTS).format(**fill))
    if random.random() < 0.125:
        lines.append(random.choice(_BAD_TERMS))
    text = "\n".join(lines)
    if random.random() < 0.4:
        text += "\n" + random_law(number)[1].removeprefix(_HEAD)
    sizes = [
        random.choice([-1, 1]) * 10 ** random.uniform(-8, -5.5), 10 ** random.uniform(-8, -5.5),
        10 ** random.uniform(-10, -8.3), random.choice([-1, 1]) * 10 ** random.uniform(-12, -9.5),
        random.uniform(0.3, 5), random.choice([-1, 1]) * random.uniform(0.05, 2),
    ]  # fmt: skip
    needed = [line.format(*sizes) for name, line in _OWN.items() if name in text.replace("layer)", "layer)")]
    return _HEAD + "\n".join([*needed, text]) + "\n"
