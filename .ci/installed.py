"""Check an installed wheel: without a C compiler its own kernels answer, with the same digits as beside one."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

COMMAND = Path(sysconfig.get_path("scripts"), "wetdoublet")
IMPACTS = """speed [m/s],angle [deg],outcome,restitution,restitution_sd
0.2,0,stick,,
0.6,0,bounce,0.2,0.02
0.9,30,,0.4,0.02
"""
RUNS = {
    "collide.json": ("collide", "granulation", "--json"),
    "pendulum.json": ("collide", "pendulum", "--json"),
    "collide.png": ("collide", "granulation", "--plot", "collide.png"),
    "map.csv": ("map", "granulation", "--stokes", "log:0.005:0.5:100", "--angle", "0:85:100", "-o", "map.csv"),
    "sensitivity.json": ("sensitivity", "granulation", "--of", "restitution,rotation", "--json"),
    "boundary.json": ("boundary", "pendulum", "--angle", "0:60:3", "--json"),
    "fit.json": ("fit", "pendulum", "impacts.csv", "--free", "liquid.film_thickness", "--json"),
}
for preset in ("glass-beads-water", "lactose-pvp", "pellet-coating", "granulation-dry-bridge", "pendulum"):
    RUNS[f"map-{preset}.csv"] = (
        "map", preset, "--stokes", "log:0.1:10:20", "--angle", "0:60:20", "-o", f"map-{preset}.csv"
    )  # fmt: skip
    RUNS[f"fit-{preset}.json"] = ("fit", preset, "impacts.csv", "--free", "liquid.viscosity", "--json")


def answers(folder: Path, path: str) -> dict[str, bytes]:
    """What the commands write in a new folder with that PATH, an empty cache and a home that takes nothing."""
    home = folder / "home"
    home.mkdir(parents=True)
    home.chmod(0o500)
    (folder / "impacts.csv").write_text(IMPACTS)
    left_out = ("CC", "WETDOUBLET_CFLAGS", "XDG_CACHE_HOME")
    usual = {name: value for name, value in os.environ.items() if name not in left_out}
    env = usual | {"PATH": path, "HOME": str(home), "WETDOUBLET_CACHE": str(folder / "cache")}
    for file, words in RUNS.items():
        done = subprocess.run([COMMAND, *words], cwd=folder, env=env, capture_output=True, text=True, check=False)
        said = [line for line in done.stderr.splitlines() if not line.startswith("at work for ")]  # a slow machine
        if done.returncode or said:
            sys.exit(f"wetdoublet {' '.join(words)}: status {done.returncode}, said {said}")
        if not (folder / file).exists():
            (folder / file).write_text(done.stdout)
    if compiled := [each.name for each in (folder / "cache").glob("*.so")]:
        sys.exit(f"compiled, and not of the wheel: {', '.join(compiled)}")
    return {file: (folder / file).read_bytes() for file in RUNS}


with tempfile.TemporaryDirectory() as work:
    (empty := Path(work, "empty")).mkdir()
    bare = answers(Path(work, "bare"), str(empty))
    if (engine := json.loads(bare["collide.json"])["engine"]) != "taylor":
        sys.exit(f"{engine} answered, not the kernel")
    beside = [name for name in ("cc", "gcc", "clang") if shutil.which(name)]
    if beside:
        full = answers(Path(work, "full"), os.environ["PATH"])
        if differing := [file for file in RUNS if bare[file] != full[file]]:
            sys.exit(f"not the same beside a compiler: {', '.join(differing)}")
print(f"{len(RUNS)} commands without a compiler{', and the same beside ' + beside[0] if beside else ''}")
