#!/usr/bin/env python3
"""The time of a whole certified history beside the times of other systems, in one run.

    python builders_time.py NEPHRITE SPEED MESH.ply... [--repeats 3]

NEPHRITE is the program, SPEED the binary `speed` beside this script: it times nephrite's history
and meshoptimizer's chain of halvings in memory. fast-simplification and vtkDecimatePro make one
level of a tenth of the triangles. All run in turn. Prints medians over the repeats, and their ratios
to the time of the history on two threads in memory.

Needs: pip install vtk fast-simplification numpy meshio
"""
import argparse
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

import fast_simplification
import meshio
import numpy
import vtk
from vtk.util import numpy_support

REDUCTION = 0.9


def seconds(run):
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def vtk_mesh(points, triangles):
    vertices = vtk.vtkPoints()
    vertices.SetData(numpy_support.numpy_to_vtk(points, deep=1))
    cells = vtk.vtkCellArray()
    offsets = numpy.arange(0, 3 * len(triangles) + 1, 3, dtype=numpy.int64)
    cells.SetData(numpy_support.numpy_to_vtkIdTypeArray(offsets, deep=1),
                  numpy_support.numpy_to_vtkIdTypeArray(triangles.astype(numpy.int64).ravel(), deep=1))
    mesh = vtk.vtkPolyData()
    mesh.SetPoints(vertices)
    mesh.SetPolys(cells)
    return mesh


def decimate_pro(mesh):
    decimate = vtk.vtkDecimatePro()
    decimate.SetInputData(mesh)
    decimate.SetTargetReduction(REDUCTION)
    decimate.Update()


def in_memory(speed, path):
    """Seconds of meshoptimizer's chain and of nephrite's history on one thread and on two."""
    table = subprocess.run([speed, "--repeats", "1", path], capture_output=True, text=True, check=True).stdout
    row = next(line for line in table.splitlines() if pathlib.Path(path).name in line)
    return [float(found) for found in re.findall(r"([\d.]+) s ", row)][:3]


def compare(arguments, path):
    read = meshio.read(path)
    points = numpy.ascontiguousarray(read.points, dtype=numpy.float32)
    triangles = numpy.ascontiguousarray(read.cells_dict["triangle"], dtype=numpy.int32)
    mesh = vtk_mesh(points, triangles)
    times = {name: [] for name in COLUMNS}
    with tempfile.TemporaryDirectory() as folder:
        build = [arguments.nephrite, "build", path, "-o", str(pathlib.Path(folder) / "mesh.neph"), "--threads", "2"]
        for _ in range(arguments.repeats):
            chain, one, two = in_memory(arguments.speed, path)
            times["history, 2 threads"].append(two)
            times["history, 1 thread"].append(one)
            times["chain of halvings"].append(chain)
            times["from file to file"].append(seconds(lambda: subprocess.run(build, capture_output=True, check=True)))
            times["fast-simplification to 10 %"].append(
                seconds(lambda: fast_simplification.simplify(points, triangles, REDUCTION)))
            times["vtkDecimatePro to 10 %"].append(seconds(lambda: decimate_pro(mesh)))
    medians = {name: statistics.median(found) for name, found in times.items()}
    base = medians["history, 2 threads"]
    cells = [f"{medians[name]:.3f} s ({medians[name] / base:.2f})" for name in COLUMNS]
    print(f"| {pathlib.Path(path).stem} | {len(triangles):,} | " + " | ".join(cells) + " |", flush=True)


COLUMNS = ["history, 2 threads", "history, 1 thread", "from file to file", "chain of halvings", "fast-simplification to 10 %",
           "vtkDecimatePro to 10 %"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("nephrite")
    parser.add_argument("speed")
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    print("| mesh | triangles | " + " | ".join(COLUMNS) + " |")
    print("|---" * (len(COLUMNS) + 2) + "|")
    for path in arguments.meshes:
        compare(arguments, path)


if __name__ == "__main__":
    main()
