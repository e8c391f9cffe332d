#!/usr/bin/env python3
"""Tetrahedra beside vtkUnstructuredGridQuadricDecimation, in one run: time, boundary and field error at equal counts.

    python volumes_check.py NEPHRITE VOLUME.vtk... [--reductions 0.5 0.75 0.9] [--repeats 3]

NEPHRITE is the program. For every volume it is built once with all its levels; VTK's filter, which gives one level a run, is
run for each reduction with the volume's first varying scalar. Levels with at most VTK's tetrahedra are taken out, and both are
held against the input by `nephrite measure`: the boundaries with a proven bracket, the field at the vertices of both. Times are
medians of `--repeats` alternating runs in the same minutes; those of nephrite are to half of the tetrahedra and to the last,
both with every level recorded, without reading and writing, as VTK's are.
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


def row(name, measured, scalar, n_tetrahedra):
    field = next((field for field in measured["fields"] if field["name"] == scalar), None)
    share = 100 / measured["bounding_diagonal"]
    kept = 100 * (measured["volume"] / measured["volume_reference"] - 1)
    worst, rms = (100 * field[key] / field["range"] for key in ("max", "rms")) if field else (float("nan"),) * 2
    print(f"    {name:9} {n_tetrahedra:8,} tetrahedra   boundary {share * measured['upper_bound']:.4f} % at most   "
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
    built, halves, alls, vtks = None, [], [], []
    for _ in range(options.repeats):
        built = run(options.program, "build", path, "-o", folder / "all.neph")
        halves.append(built["half_seconds"] or float("nan"))
        alls.append(built["fusion_seconds"])
        vtks.append(decimate(grid, scalar, 0.5)[1])
    half, whole, theirs = map(statistics.median, (halves, alls, vtks))
    n = built["tetrahedra_in"]
    print(f"{path.name}: {n:,} tetrahedra; to half: nephrite {half:.3f} s, VTK {theirs:.3f} s ({theirs / half:.2f} times); "
          f"all {built['levels']} levels, down to {100 * built['coarsest_tetrahedra'] / n:.1f} %: {whole:.3f} s; "
          f"{built['tetrahedra_per_tetrahedron_fusion']:.1f} tetrahedra a fusion (13.9 to 16.1 in the paper)")
    run(options.program, "extract", folder / "all.neph", "--level", 0, "-o", folder / "input.vtu")
    for reduction in options.reductions:
        level, seconds = decimate(grid, scalar, reduction)
        count = level.GetNumberOfCells()
        print(f"  reduction {100 * reduction:.0f} %: VTK reached {100 * (1 - count / n):.1f} % in {seconds:.3f} s")
        write(level, folder / "vtk.vtu")
        row("VTK", run(options.program, "measure", folder / "input.vtu", folder / "vtk.vtu"), scalar, count)
        taken = run(options.program, "extract", folder / "all.neph", "--tetrahedra", count, "-o", folder / "ours.vtu")
        ours = run(options.program, "measure", folder / "input.vtu", folder / "ours.vtu")
        row("nephrite", ours, scalar, taken["tetrahedra"])


if __name__ == "__main__":
    main()
