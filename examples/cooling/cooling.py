"""A freely cooling gas of wet spheres: exports the law of a scene, compiles the event loop with it, runs and draws it.

python cooling.py [--spheres 5000] [--share 0.02] [--speed 4] [--collisions 100] [--out DIR]
python cooling.py --agglomerates [--contacts 4000] [--seed 1] [--out DIR]    spheres of two sizes that agglomerate
"""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

HERE = Path(__file__).resolve().parent
SCENE = "granulation"  # of equal spheres; cooling.c includes granulation.h
INK = {"single": "#b5c4d6", "rotate": "#3b6ea5", "bounce": "#c9762f", "doublet": "#1d1d1d"}


def exported(folder: Path) -> Path:
    """The folder, with the exported law."""
    export = [sys.executable, "-m", "wetdoublet.solvers", "export", SCENE, "--to", "c", "--out", str(folder)]
    subprocess.run(export, check=True, stdout=subprocess.DEVNULL)
    return folder


def build(folder: Path, optimise: str = "-O2", loop: str = "cooling") -> Path:
    """Compile a loop with the law that is exported to a folder; returns the program."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    sources = [str(HERE / f"{loop}.c"), str(folder / f"{SCENE}.c")]
    program = folder / loop
    subprocess.run(
        [*compiler, "-std=c99", optimise, "-ffp-contract=off", f"-I{folder}", *sources, "-o", str(program), "-lm"],
        check=True,
    )
    return program


def simulate(
    program: Path, spheres: int, share: float, speed: float, collisions: float
) -> tuple[np.ndarray, np.ndarray]:
    """Run the gas; returns its rows and the positions in the snapshots, as records with the names of the columns."""
    arguments = [str(program), *map(str, (spheres, share, speed, collisions))]
    folder = program.parent
    with (folder / "rows.csv").open("w") as file:
        subprocess.run(arguments, check=True, stdout=file, cwd=folder)
    rows, snapshots = (
        np.genfromtxt(folder / name, delimiter=",", names=True) for name in ("rows.csv", "snapshots.csv")
    )
    return rows, snapshots


def agglomerate(program: Path, contacts: int, seed: int, spheres: int = 300) -> tuple[np.ndarray, str]:
    """Run the gas of two sizes at 1.5 m/s in a fifth of the volume, with water; returns its rows and the sizes."""
    arguments = [str(program), *map(str, (spheres, 0.2, 1.5, 1e-3, contacts, seed))]
    text = subprocess.run(arguments, check=True, capture_output=True, text=True).stdout
    *lines, sizes = text.splitlines()
    return np.genfromtxt(lines, delimiter=",", names=True), sizes.removeprefix("# ")


def draw_cooling(rows: np.ndarray, path: Path) -> None:
    """Granular temperature and what becomes of the spheres, over time."""
    rows = rows[rows["single"] > rows["single"][0] / 100]
    milliseconds = 1e3 * rows["time"]
    figure, (above, below) = plt.subplots(2, 1, figsize=(6.4, 5.6), sharex=True, layout="constrained")
    above.loglog(milliseconds[1:], rows["temperature"][1:], label="velocities", color=INK["rotate"])
    above.loglog(milliseconds[1:], rows["spin_temperature"][1:], label="spins", color=INK["bounce"])
    above.set_ylabel("granular temperature (m²/s²)")
    above.legend(title="of the single spheres", frameon=False)
    below.semilogx(
        milliseconds, 1 - rows["single"] / rows["single"][0], label="spheres in doublets", color=INK["doublet"]
    )
    count = rows["stick"] + rows["rotate"] + rows["bounce"]
    marks = np.unique(
        np.searchsorted(count, np.arange(0, count[-1], 300))
    )  # rows between which some 300 collisions lie
    total = np.diff(count[marks])
    middle = np.sqrt(milliseconds[marks[1:]] * np.maximum(milliseconds[marks[:-1]], milliseconds[1]))
    for name, words in (("stick", "stick"), ("rotate", "stick, rotate, separate"), ("bounce", "bounce")):
        ink, style = (INK["doublet"], ":") if name == "stick" else (INK[name], "-")
        below.semilogx(middle, np.diff(rows[name][marks]) / total, style, label=f"collisions: {words}", color=ink)
    below.set_ylim(0, 1)
    below.set_xlabel("time (ms)")
    below.set_ylabel("share")
    below.legend(frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_strip(snapshots: np.ndarray, path: Path) -> None:
    """A slice of the box at the beginning, when each quarter of the spheres has stuck, and at the end."""
    numbers = np.unique(snapshots["number"])
    figure, places = plt.subplots(1, numbers.size, figsize=(2.2 * numbers.size, 2.7), layout="constrained")
    for place, number in zip(places, numbers, strict=True):
        here = snapshots[snapshots["number"] == number]
        here = here[here["z"] < 1 / 8]
        kinds = np.select(
            [here["stuck"] == 1, here["outcome"] == 1, here["outcome"] == 2], ["doublet", "rotate", "bounce"], "single"
        )
        for kind, ink in INK.items():
            own = here[kinds == kind]
            place.scatter(own["x"], own["y"], s=4, color=ink, linewidths=0, label=kind)
        place.set(aspect="equal", xticks=[], yticks=[], xlim=(0, 1), ylim=(0, 1))
        time = here["time"][0]
        place.set_title(f"{1e3 * time:.3g} ms" if time < 1 else f"{time:.3g} s", fontsize=9)
    names = ("no collision yet", "last: stuck, rotated, separated", "last: bounced", "in a doublet")
    handles = places[0].get_legend_handles_labels()[0]
    figure.legend(handles, names, loc="outside lower center", ncols=4, frameon=False, markerscale=2.5, fontsize=8)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> None:
    """Run the gas that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spheres", type=int, default=5000)
    parser.add_argument("--share", type=float, default=0.02, help="of the volume that is spheres")
    parser.add_argument("--speed", type=float, default=4.0, help="m/s, of every component at the beginning")
    parser.add_argument("--collisions", type=float, default=100.0, help="of a sphere, at most")
    parser.add_argument("--agglomerates", action="store_true", help="spheres of two sizes, by the forces of contacts")
    parser.add_argument("--contacts", type=int, default=4000, help="with --agglomerates: contacts begun")
    parser.add_argument("--seed", type=int, default=1, help="with --agglomerates: of the velocities and spins")
    parser.add_argument("--out", type=Path, default=Path("cooling"))
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    if given.agglomerates:
        rows, sizes = agglomerate(build(exported(given.out.resolve()), loop="agglomerates"), given.contacts, given.seed)
        last = rows[-1]
        print(f"{last['contacts_begun']:.0f} contacts begun, {last['rotate'] + last['bounce']:.0f} ended; ", end="")
        print(f"{last['agglomerates']:.0f} agglomerates, the largest of {last['largest']:.0f}; {sizes}")
        off = max(rows["momentum"].max(), rows["angular_momentum"].max())
        print(f"momentum and angular momentum are kept to {off:.1e} of their size")
        return
    program = build(exported(given.out.resolve()))
    rows, snapshots = simulate(program, given.spheres, given.share, given.speed, given.collisions)
    draw_cooling(rows, given.out / "cooling.png")
    draw_strip(snapshots, given.out / "strip.png")
    last, mass = rows[-1], rows["energy"][0] / (1.5 * given.spheres * given.speed**2)
    total = last["stick"] + last["rotate"] + last["bounce"] + last["undecided"]
    print(f"{total:.0f} collisions in {1e3 * last['time']:.4g} ms: {last['stick']:.0f} stick, ", end="")
    print(f"{last['rotate']:.0f} rotate and separate, {last['bounce']:.0f} bounce, {last['undecided']:.0f} undecided")
    drift = max(np.ptp(rows[f"momentum_{axis}"]) for axis in "xyz")
    print(f"momentum changes by {drift:.1e} kg m/s; a sphere has some {given.speed * mass:.1e} kg m/s at the beginning")


if __name__ == "__main__":
    main()
