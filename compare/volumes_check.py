#!/usr/bin/env python3
"""Tetrahedra beside vtkUnstructuredGridQuadricDecimation, in one run: time, boundary and field
error at equal counts.

    python volumes_check.py NEPHRITE VOLUME.vtk... [--reductions 0.5 0.75 0.9] [--repeats 3]

NEPHRITE is the program. For every volume it is built with all its levels, once with all its fields
and once with the one field that VTK's filter weighs and keeps: the first varying scalar. That
filter gives one level a run and is run for each reduction. Levels with at most its tetrahedra are
taken out, and all are held against the input by `nephrite measure`: the boundaries with a proven
bracket, the field at the vertices of both. Times are medians of `--repeats` alternating runs in the
same minutes; those of nephrite are to half of the tetrahedra and to the last, both with every level
recorded, without reading and writing, as VTK's are.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

import vtk


def run(program, *words):
    """One command's JSON."""
    done = subprocess.run([program, *map(str, words), "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def read(path):
    reader = vtk.vtkUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.ReadAllScalarsOn()
    reader.ReadAllVectorsOn()
    reader.Update()
    return reader.GetOutput()


def first_varying(grid):
    """Name of the first scalar that is not one number everywhere."""
    data = grid.GetPointData()
    for index in range(data.GetNumberOfArrays()):
        array = data.GetArray(index)
        low, high = array.GetRange()
        if array.GetNumberOfComponents() == 1 and high > low:
            return array.GetName()
    return None


def decimate(grid, scalar, reduction):
    """VTK's level and its seconds."""
    grid.GetPointData().SetActiveScalars(scalar)
    decimation = vtk.vtkUnstructuredGridQuadricDecimation()
    decimation.SetInputData(grid)
    decimation.SetScalarsName(scalar)
    decimation.SetTargetReduction(reduction)
    start = time.perf_counter()
    decimation.Update()
    seconds = time.perf_counter() - start
    level = decimation.GetOutput()
    # The filter gives its one field no name.
    if level.GetPointData().GetNumberOfArrays():
        level.GetPointData().GetArray(0).SetName(scalar)
    return level, seconds


def write(grid, path):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.Write()


def only(grid, scalar):
    """The grid with one of its fields."""
    one = vtk.vtkUnstructuredGrid()
    one.CopyStructure(grid)
    one.GetPointData().AddArray(grid.GetPointData().GetArray(scalar))
    return one


def row(name, measured, scalar, n_tetrahedra):
    field = next((field for field in measured["fields"] if field["name"] == scalar), None)
    share = 100 / measured["bounding_diagonal"]
    kept = 100 * (measured["volume"] / measured["volume_reference"] - 1)
    worst, rms = (100 * field[key] / field["range"] for key in ("max", "rms")) if field else (float("nan"),) * 2
    print(f"    {name:10} {n_tetrahedra:8,} tetrahedra   boundary {share * measured['upper_bound']:.4f} % at most   "
          f"{scalar} max {worst:.2f} %, rms {rms:.3f} % of its range   volume {kept:+.4f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("volumes", nargs="+", type=pathlib.Path)
    parser.add_argument("--reductions", nargs="+", type=float, default=[0.5, 0.75, 0.9])
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    for path in options.volumes:
        with tempfile.TemporaryDirectory() as folder:
            compare(options, path, pathlib.Path(folder))


def compare(options, path, folder):
    grid = read(path)
    scalar = first_varying(grid)
    write(only(grid, scalar), folder / "one.vtu")
    inputs = {"all fields": path, "one field": folder / "one.vtu"}
    built, halves, wholes, vtks = {}, {name: [] for name in inputs}, {name: [] for name in inputs}, []
    for _ in range(options.repeats):
        for name, file in inputs.items():
            built[name] = run(options.program, "build", file, "-o", folder / f"{name}.neph")
            halves[name].append(built[name]["half_seconds"] or float("nan"))
            wholes[name].append(built[name]["fusion_seconds"])
        vtks.append(decimate(grid, scalar, 0.5)[1])
    theirs = statistics.median(vtks)
    n = built["all fields"]["tetrahedra_in"]
    print(f"{path.name}: {n:,} tetrahedra; to half VTK {theirs:.3f} s")
    for name, build in built.items():
        half, whole = statistics.median(halves[name]), statistics.median(wholes[name])
        print(f"  {name}: to half {half:.3f} s, VTK takes {theirs / half:.2f} times that; all {build['levels']} levels, "
              f"down to {100 * build['coarsest_tetrahedra'] / n:.1f} %: {whole:.3f} s")
    run(options.program, "extract", folder / "all fields.neph", "--level", 0, "-o", folder / "input.vtu")
    for reduction in options.reductions:
        level, seconds = decimate(grid, scalar, reduction)
        count = level.GetNumberOfCells()
        print(f"  reduction {100 * reduction:.0f} %: VTK reached {100 * (1 - count / n):.1f} % in {seconds:.3f} s")
        write(level, folder / "vtk.vtu")
        row("VTK", run(options.program, "measure", folder / "input.vtu", folder / "vtk.vtu"), scalar, count)
        for name in inputs:
            taken = run(options.program, "extract", folder / f"{name}.neph", "--tetrahedra", count, "-o", folder / "ours.vtu")
            ours = run(options.program, "measure", folder / "input.vtu", folder / "ours.vtu")
            row(name, ours, scalar, taken["tetrahedra"])


if __name__ == "__main__":
    main()
