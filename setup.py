"""The packages, found: `wetdoublet` is solvers/package, and the three folders are packages in it; and its kernels."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Distribution, find_namespace_packages, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_py import build_py
from setuptools.errors import CompileError

FOLDERS = find_namespace_packages(
    include=["derive*", "generated*", "solvers*"], exclude=["*__pycache__*", "solvers.package*", "solvers.explorer.*"]
)
ENGINES = "wetdoublet.solvers.engines"
SETS = os.environ.get("WETDOUBLET_INSTRUCTION_SETS", "" if os.name == "nt" else None)  # not tried on Windows


class BuildWithKernels(build_py):
    """Python files and compiled kernels; an editable installation compiles its kernels when they are needed.

    WETDOUBLET_INSTRUCTION_SETS names the instruction sets that they are compiled for, separated by commas, or "" for
    none. Without it that of this machine, and few kernels if it has a compiler, all values if not; on Windows none.
    """

    def run(self) -> None:
        super().run()
        if self.editable_mode or SETS == "":
            return
        folder = Path(self.build_lib, *ENGINES.split("."), "taylor", "kernels")
        command = [sys.executable, "-m", f"{ENGINES}.ship", str(folder), *(SETS.split(",") if SETS else ["--for-here"])]
        path = os.pathsep.join([self.build_lib, *filter(None, [os.environ.get("PYTHONPATH")])])
        with tempfile.TemporaryDirectory() as cache:
            env = os.environ | {"PYTHONPATH": path, "WETDOUBLET_CACHE": cache}
            done = subprocess.run(command, env=env, check=False)
        if done.returncode:
            raise CompileError('no kernels, for the reason above; WETDOUBLET_INSTRUCTION_SETS="" leaves them out')


class WithKernels(Distribution):
    """Files of one kind of machine, unless the kernels are left out."""

    def has_ext_modules(self) -> bool:
        return SETS != ""


class WheelWithKernels(bdist_wheel):
    """A wheel for one kind of machine and any Python: kernels are loaded by ctypes."""

    def get_tag(self) -> tuple[str, str, str]:
        return "py3", "none", super().get_tag()[2]


setup(
    packages=["wetdoublet", *(f"wetdoublet.{folder}" for folder in FOLDERS)],
    distclass=WithKernels,
    cmdclass={"build_py": BuildWithKernels, "bdist_wheel": WheelWithKernels},
)
