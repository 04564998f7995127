"""Flow curves: what rheometers export, the law that is found, and its intervals."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.fitting.flow_curve import flow_curve

ROWS = "0.1{c}5.5{c}0.55\n1{c}5{c}5\n10{c}4{c}40\n100{c}2{c}200"
WRITTEN = {
    "brackets": "shear rate [1/s],viscosity [Pa s],stress [Pa]\n" + ROWS.format(c=","),
    "TRIOS": "[step]\nFlow sweep - 1\nShear rate\tViscosity\tStress\n1/s\tPa.s\tPa\n" + ROWS.format(c="\t"),
    "RheoCompass": "Test:\tprobe\nInterval data:\tPoint No.\tShear Rate\tViscosity\tShear Stress\n"
    "\t\t[1/s]\t[mPa·s]\t[Pa]\n"
    + "\n".join(f"\t{k}\t{g}\t{e}\t{t}" for k, (g, e, t) in enumerate(
        [("0,1", "5500", "0,55"), ("1", "5000", "5"), ("10", "4000", "40"), ("100", "2000", "200")])),
    "RheoWin": "GP in 1/s;Eta in Pas;Tau in Pa\n" + ROWS.format(c=";").replace(".", ","),
    "stress alone": "Scherrate (s⁻¹);Schubspannung (Pa)\n0,1;0,55\n1;5\n10;40\n100;200",
    "remarks": "shear rate [1/min],viscosity [Pa s]\n6,5.5  # first\n60,5\n600,4 # of, three\n6000,2",
    "unsorted, cP": "γ̇ [s^-1],η [cP]\n100,2000\n1,5000\n0.1,5500\n10,4000",
}  # fmt: skip


@pytest.mark.parametrize("kind", WRITTEN)
def test_what_rheometers_export(kind: str, tmp_path: Path):
    path = tmp_path / "curve.csv"
    path.write_bytes(WRITTEN[kind].encode("utf-16" if kind == "RheoCompass" else "utf-8"))
    fitted = flow_curve(path)
    assert fitted.rate == pytest.approx([0.1, 1, 10, 100])
    assert fitted.viscosity == pytest.approx([5.5, 5, 4, 2])
    assert "4 points are too few for all parameters of cross, carreau, herschel-bulkley" in str(fitted)


@pytest.mark.parametrize(
    ("text", "says"),
    [("shear rate,viscosity\n1,2\n2,3\n3,4", "no unit"), ("speed [m/s],viscosity [Pa s]\n1,2", "no line that names"),
     ("shear rate [1/s],viscosity [Pa s]\n1,2\n2,-3\n3,4", "> 0"),
     ("shear rate [1/s],viscosity [m]\n1,2\n2,3\n3,4", "a length"),
     ("shear rate [1/s],viscosity [Pa s]\n1,2\n2,3", "three rates"),
     ("shear rate [Hz],viscosity [Pa s]\n1,2\n2,3\n3,4", "speed of rotation"),
     ("shear rate [rpm],viscosity [Pa s]\n1,2\n2,3\n3,4", "speed of rotation"),
     ("shear rate [1/s],viscosity [Pa s],stress [Pa]\n1,2,2\n2,3,6000\n3,4,12", "6 Pa, to 5%"),
     ("shear rate [1/s],viscosity [Pa s],stress [kPa]\n1,2,2\n2,3,6\n3,4,12", "contradicts the viscosity")],
)  # fmt: skip
def test_what_is_refused(text: str, says: str, tmp_path: Path):
    (tmp_path / "curve.csv").write_text(text)
    with pytest.raises(InputError, match=says):
        flow_curve(tmp_path / "curve.csv")


def test_ramps_that_differ_are_mentioned():
    """Up and down, or down and up, by a fifth; not a difference within the scatter, nor one ramp."""
    up = np.geomspace(0.1, 100, 12)
    rates, viscosity = np.concatenate([up, up[-2::-1]]), np.concatenate([up**-0.4, 0.8 * up[-2::-1] ** -0.4])
    (remark,) = flow_curve((rates, viscosity)).remarks
    assert "on the way down the viscosity is 0.8" in remark
    (remark,) = flow_curve(
        (np.concatenate([up[::-1], up[1:]]), np.concatenate([up[::-1] ** -0.4, 0.8 * up[1:] ** -0.4]))
    ).remarks
    assert "on the way up the viscosity is 0.8" in remark
    assert flow_curve((rates, rates**-0.4 * (1 + 0.01 * np.cos(rates)))).remarks == ()
    assert flow_curve((up, up**-0.4)).remarks == ()


RATES = np.geomspace(0.1, 1000, 40)


def known(law: str, random: np.random.Generator) -> tuple[np.ndarray, dict[str, float]]:
    """A liquid of a law, whose features lie within the rates, and its entries."""
    index, viscosity, time = random.uniform(0.2, 0.7), 10 ** random.uniform(-1, 2), 10 ** random.uniform(-1, 0.5)
    entries = {"viscosity": viscosity}
    if law == "newtonian":
        return np.full(RATES.shape, viscosity), entries
    entries["flow_index"] = index
    power = viscosity * (RATES / 10) ** (index - 1)
    if law == "power-law":
        return power, entries
    if law == "herschel-bulkley":
        entries["yield_stress"] = viscosity * 10 * 10 ** random.uniform(-0.5, 0.5)
        return entries["yield_stress"] / RATES + power, entries
    entries["relaxation_time"] = time
    last = viscosity * 10 ** random.uniform(-2.0, -1.5) if random.uniform() < 0.5 else 0.0
    if last:
        entries["infinite_shear_viscosity"] = last
    thinning = (
        1 / (1 + (time * RATES) ** (1 - index)) if law == "cross" else (1 + (time * RATES) ** 2) ** ((index - 1) / 2)
    )
    return last + (viscosity - last) * thinning, entries


LAWS = ("newtonian", "power-law", "cross", "carreau", "herschel-bulkley")


def found(numbers: Iterable[int], seed: int) -> tuple[int, list[float]]:
    """How many laws of known liquids with 3 % noise are found, and deviations of entries over those that are told.

    An interval tells 1.96 standard deviations to either side of an entry's logarithm.
    """
    random, laws, deviations = np.random.default_rng(seed), 0, []
    for number in numbers:
        law = LAWS[number % len(LAWS)]
        viscosity, entries = known(law, random)
        fitted = flow_curve((RATES, viscosity * np.exp(0.03 * random.normal(size=RATES.size))))
        laws += fitted.law == law
        if fitted.law == law and fitted.parameters.keys() == entries.keys():
            for name, value in entries.items():
                each = fitted.parameters[name]
                end = each.high if value > each.value else each.low
                deviations += [1.96 * np.log(value / each.value) / abs(np.log(end / each.value))] if end else []
    return laws, deviations


def test_a_law_is_found_and_pasted(tmp_path: Path):
    """The table that is printed is read as a scene, whose collision says that it shears faster than was measured."""
    laws, _ = found((3, 4), 7)
    assert laws == 2
    fitted = flow_curve((RATES, np.full(RATES.shape, 2.0) * np.exp(0.01 * np.cos(40 * np.log(RATES)))))
    assert fitted.law == "newtonian"
    scene = Scene.load("granulation").with_entries(fitted.entries)
    assert 'measured_to = "1000 1/s"' in fitted.to_toml()
    assert any("liquid.measured_to" in line for line in collide(scene, stokes=0.1).validity)
    slow = scene.with_entries({"liquid.measured_to": "1e9 1/s"})
    assert not any("liquid.measured_to" in line for line in collide(slow, stokes=0.1).validity)


@pytest.mark.slow
def test_laws_and_intervals_of_eight_liquids():
    """Eight flow curves with 3 % noise: the law of nearly all, and errors as large as the intervals say."""
    laws, deviations = found(range(8), 1)
    assert laws >= 7
    size = len(deviations)
    assert size >= 16
    assert np.mean(np.square(deviations)) == pytest.approx(1.0, abs=2.5 * np.sqrt(2 / size))
    assert abs(np.mean(deviations)) <= 2.5 / np.sqrt(size)
