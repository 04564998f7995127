"""A hundred wet spheres in a turning drum, in LAMMPS by the compiled pair style; the wall is LAMMPS's own, and dry.

    python drum.py LAMMPS_PYTHON [FOLDER]    draws drum.png into FOLDER (here), prints agglomerates and costs

LAMMPS_PYTHON has `lammps` and numpy; this one has `wetdoublet` and matplotlib.
"""

import json
import os
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from plugin import built, started

RADIUS, DENSITY, DRUM, LENGTH, TURNS = 1e-3, 2500.0, 8e-3, 8.4e-3, 4.5  # m, kg/m^3, m, m, turns a second
STEP, STEPS, FRAMES, COUNT = 1e-5, 600, 100, 100  # s; between two frames
WALL = "granular hooke 1000 0.02 tangential linear_history 285 1.0 0.5"  # N/m, N s/m; friction 0.5
WET = f"pair_style wet/drum {0.3 * RADIUS}\npair_coeff * *"
DRY = "pair_style granular\npair_coeff * * hooke 1000 0.02 tangential linear_history 285 1.0 0.5"


def drum(pairs: str, turns: float = TURNS) -> str:
    """The script: spheres above each other in a drum along y, periodic there."""
    grid = [
        (x, y, z) for z in (-4.0, -1.8, 0.4, 2.6, 4.8) for y in (1.0, 3.1, 5.2, 7.3) for x in np.arange(-5.25, 6, 2.1)
    ]
    sites = [site for site in grid if np.hypot(site[0], site[2]) < 6.8]
    rng = np.random.default_rng(1)
    places = np.array(sites[:COUNT]) * RADIUS
    speeds = rng.normal(0.0, 0.05, places.shape)
    lines = [f"create_atoms 1 single {x!r} {y!r} {z!r}" for x, y, z in places.tolist()]
    moves = [f"velocity one{k} set {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(speeds.tolist(), 1)]
    groups = [f"group one{k} id {k}\n{move}\ngroup one{k} delete" for k, move in enumerate(moves, 1)]
    return "\n".join(
        [
            "boundary f p f",
            f"region all block {-1.1 * DRUM} {1.1 * DRUM} 0 {LENGTH} {-1.1 * DRUM} {1.1 * DRUM}",
            f"neighbor {0.5 * RADIUS} bin\ncreate_box 1 all",
            *lines,
            f"set type 1 diameter {2 * RADIUS} density {DENSITY}",
            *groups,
            f"variable turned equal 2*PI*{turns}*step*dt",
            f"region drum cylinder y 0 0 {DRUM} INF INF rotate v_turned 0 0 0 0 1 0",
            f"{pairs}\ncomm_modify vel yes\nfix moves all nve/sphere\nfix falls all gravity 9.81 vector 0 0 -1",
            f"fix wall all wall/gran/region {WALL} region drum\ntimestep {STEP}",
        ]
    )


def agglomerates(pairs: NDArray[np.int64]) -> NDArray[np.int64]:
    """For each sphere the smallest index in its agglomerate, of pairs that a bridge holds."""
    label = np.arange(COUNT)
    for _ in range(COUNT):
        before = label.copy()
        for i, j in pairs:
            label[[i, j]] = min(label[i], label[j])
        if np.array_equal(label, before):
            break
    return label


def turned(plugin: Path) -> dict[str, Any]:
    """Positions and agglomerates of each frame."""
    tallies = "compute wet all pair wet/drum\nthermo_style custom step c_wet[1] c_wet[2] c_wet[3]\n"
    tallies += "compute gap all pair/local p1\ncompute ends all property/local patom1 patom2\n"
    host = started(plugin, f"{drum(WET)}\n{tallies}thermo {STEPS}")
    frames: dict[str, Any] = {"x": [], "label": []}
    for _ in range(FRAMES):
        host.command(f"run {STEPS} post no")
        gaps = host.numpy.extract_compute("gap", 2, 1).ravel()
        ends = host.numpy.extract_compute("ends", 2, 2)[gaps >= 0].astype(int) - 1
        order = np.argsort(host.numpy.extract_atom("id")[:COUNT])
        frames["x"].append(host.numpy.extract_atom("x")[:COUNT][order].tolist())
        frames["label"].append(agglomerates(ends).tolist())
    contacts, separated, bounced = host.numpy.extract_compute("wet", 0, 1)[:3]
    host.close()
    return {**frames, "contacts": contacts, "separations": separated, "bounces": bounced}


def costs(plugin: Path, folder: Path) -> dict[str, list[float]]:
    """CPU time in the pair style, ns a step and ns a step and contact: wet, and LAMMPS's own granular; medians.

    A slow drum, of as many contacts wet as dry. The CPU time of a run by the pair style's share in it, run after run in
    turn, so that a busy machine matters little.
    """
    log, hosts = folder / "log", {}
    spans: dict[str, list[list[float]]] = {"wet": [], "granular": []}
    touching = "compute near all contact/atom\ncompute touch all reduce sum c_near\nvariable touching equal 0.5*c_touch"
    for name, pairs, contacts in (("wet", WET, "c_wet[1]"), ("granular", DRY, "v_touching")):
        counted = "compute wet all pair wet/drum" if name == "wet" else touching
        hosts[name] = started(plugin, f"{drum(pairs, 0.5)}\n{counted}\nthermo_style custom step {contacts}\nthermo 50")
        hosts[name].command("run 8000 post no")
    for _ in range(5):
        for name, host in hosts.items():
            start = time.process_time()
            host.commands_string(f"log {log}\nrun 1000\nlog none")
            spent = (time.process_time() - start) / 1000 * 1e9
            lines = [line.split() for line in log.read_text().splitlines()]
            spent *= next(float(line[-1]) for line in lines if line[:2] == ["Pair", "|"]) / 100
            number = np.mean([float(line[1]) for line in lines if len(line) == 2 and line[0].isdigit()])
            spans[name].append([spent, float(spent / number), float(number)])
    return {name: np.median(rows, axis=0).tolist() for name, rows in spans.items()}


def draw(record: dict[str, Any], path: Path) -> None:
    """The drum with the most and with the fewest agglomerates, by colours, and their number and size over time."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.patches import Circle

    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2), width_ratios=(1, 1, 1.3), constrained_layout=True)
    every = STEP * STEPS
    counts = [np.count_nonzero(np.bincount(label) > 1) for label in record["label"]]
    for axis, frame in zip(axes, (int(np.argmax(counts)), int(np.argmin(counts))), strict=False):
        x, label = 1e3 * np.array(record["x"][frame]), np.array(record["label"][frame])
        largest = np.argsort(-np.bincount(label, minlength=COUNT), kind="stable")
        for i in np.argsort(-x[:, 1]):  # those behind first
            rank = int(np.flatnonzero(largest == label[i])[0])
            alone = np.count_nonzero(label == label[i]) == 1
            colour = "white" if alone else f"C{rank % 10}"
            axis.add_patch(Circle((x[i, 0], x[i, 2]), 1e3 * RADIUS, facecolor=colour, edgecolor="black", linewidth=0.6))
        axis.add_patch(Circle((0, 0), 1e3 * DRUM, fill=False, linewidth=2))
        axis.set(xlim=(-8.5, 8.5), ylim=(-8.5, 8.5), aspect="equal", xlabel="mm", title=f"{(frame + 1) * every:.3f} s")
    sizes = [np.bincount(np.bincount(label, minlength=COUNT), minlength=COUNT + 1) for label in record["label"]]
    times = every * np.arange(1, FRAMES + 1)
    axes[2].plot(times, [size[2:].sum() for size in sizes], label="agglomerates")
    axes[2].plot(times, [size[1] for size in sizes], label="single spheres")
    axes[2].plot(times, [np.flatnonzero(size).max() for size in sizes], label="spheres in the largest")
    axes[2].set(xlabel="time, s", ylim=(0, COUNT))
    axes[2].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
    figure.savefig(path, dpi=110)


def main() -> None:
    """In LAMMPS's Python its part; else export, run it, print and draw."""
    if "DRUM_FOLDER" in os.environ:
        folder = Path(os.environ["DRUM_FOLDER"])
        plugin = built(folder, "drum")
        record = {**turned(plugin), "costs": costs(plugin, folder)}
        (folder / "found.json").write_text(json.dumps(record))
        return
    with tempfile.TemporaryDirectory() as name:
        scene = Path(__file__).with_name("drum.toml")
        command = [sys.executable, "-m", "wetdoublet", "export", str(scene), "--to", "c", "--out", name]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        subprocess.run([*shlex.split(sys.argv[1]), __file__], check=True, env={**os.environ, "DRUM_FOLDER": name})
        record = json.loads((Path(name) / "found.json").read_text())
    draw(record, Path(sys.argv[2] if len(sys.argv) > 2 else Path(__file__).parent) / "drum.png")
    sizes = [np.bincount(label) for label in record["label"]]
    print(f"{record['bounces']:.0f} bounces and {record['separations']:.0f} separations without a rebound")
    for k in range(0, FRAMES, FRAMES // 10):
        size = sizes[k]
        print(f"{(k + 1) * STEP * STEPS:.3f} s: {np.count_nonzero(size > 1)} agglomerates, the largest of {size.max()}")
    for pairs, (step, contact, number) in record["costs"].items():
        print(f"{pairs}: {step:.0f} ns a step, {contact:.0f} ns a contact at {number:.0f} contacts")


if __name__ == "__main__":
    main()
