"""The packages, found: `wetdoublet` is solvers/package, and the three folders are packages in it."""

from setuptools import find_namespace_packages, setup

FOLDERS = find_namespace_packages(
    include=["derive*", "generated*", "solvers*"], exclude=["*__pycache__*", "solvers.package*"]
)

setup(packages=["wetdoublet", *(f"wetdoublet.{folder}" for folder in FOLDERS)])
