#!/usr/bin/env bash
# uvw 0.7.0: VTK files of grains, written in a `with` block, and vectors that belong to the whole file
#
# Guess: one column of a table of grains is as good as any array; an error inside the block `with UnstructuredGrid(...)`
#   ends the program as in each other block. Field data may have any shape, as the documentation has it: a wall's
#   position and normal beside the grains.
# What happens: with a column of a table no file is written, and the program goes on behind the block without a word;
#   where a run before had a file of that name, it stays. In a series of three steps the one in the middle is the old
#   one. So it is with each error inside the block, also of the user's own lines, and with the table of times,
#   `ParaViewData`. With a vector in the field data VTK reads the file as one of no grains at all; with a number per
#   row it reads it.
# Why: an array that is not contiguous cannot be encoded, and the end of the block returns True, which says that the
#   error is dealt with. The number of rows is written as that of all numbers, 6 for two vectors, which VTK believes
#   for field data only.
# Why it matters here: a film of a collision whose steps come from two runs looks like one. Call `write()` without the
#   block, copy columns, and write a vector as three field data of their own.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'uvw==0.7.0' 'numpy==2.4.6' \
    'vtk==9.7.2'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version
from pathlib import Path

import numpy as np
from uvw import DataArray, ParaViewData, UnstructuredGrid
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

VERTEX = 1  # a cell of one point
centres = np.array([[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [5e-3, 0.0, 0.0]])
cells = {VERTEX: np.arange(len(centres))[:, None]}


def read(name):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def series(tables):
    """Steps 0 to 2, each with the speeds in the last column of a table, or in an array of their own."""
    for step, table in enumerate(tables):
        with UnstructuredGrid(f"{step}.vtu", centres, cells) as grid:
            speeds = table[:, 1] if step == 1 else table[:, 1].copy()
            grid.addPointData(DataArray(speeds, [0], "speed"))


print("uvw", version("uvw"), "with VTK", version("vtk"))
series([np.ones((3, 2))] * 3)
first = [Path(f"{step}.vtu").exists() for step in range(3)]
print("steps written, where the second has a column:", first)
assert first == [True, False, True], "changed: a column"
with UnstructuredGrid("1.vtu", centres, cells) as grid:
    grid.addPointData(DataArray(np.ones(3), [0], "speed"))
series([np.full((3, 2), 2.0)] * 3)
found = [float(vtk_to_numpy(read(f"{step}.vtu").GetPointData().GetArray("speed"))[0]) for step in range(3)]
print("speeds of 1 m/s, then written again as 2 m/s:", found)
assert found == [2, 1, 2], "changed: the old file"
with ParaViewData("times.pvd") as table:
    table.addFile("0.vtu", timestep=[0.0][1])
print("table of times with a wrong index of the user's: written", Path("times.pvd").exists())
assert not Path("times.pvd").exists(), "changed: an error in the table"
raised = False
grid = UnstructuredGrid("plain.vtu", centres, cells)
try:
    grid.addPointData(DataArray(np.ones((3, 2))[:, 1], [0], "speed"))
except BufferError as error:
    raised = True
    print("without the block:", error)
assert raised, "changed: without the block"

wall = np.array([[0.0, 0.0, -1e-3], [0.0, 0.0, 1.0]])  # position and normal
print("field data          rows written  grains read")
for name, data, rows, count in (
    ("none", None, "-", 3),
    ("two numbers", wall[:, 2].copy(), "2", 3),
    ("two vectors", wall, "6", 0),
):
    grid = UnstructuredGrid("field.vtu", centres, cells)
    written = "-"
    if data is not None:
        array = DataArray(data, [0], "wall")
        written = array.attributes["NumberOfTuples"]
        grid.addFieldData(array)
    grid.write()
    grains = read("field.vtu").GetNumberOfPoints()
    print(f"{name:18s} {written:>13s} {grains:12d}")
    assert written == rows and grains == count, "changed: field data"
grid = UnstructuredGrid("point.vtu", centres, cells)
grid.addPointData(DataArray(centres, [0], "velocity"))
grid.write()
assert (vtk_to_numpy(read("point.vtu").GetPointData().GetArray("velocity")) == centres).all(), "vectors of grains"
PY
