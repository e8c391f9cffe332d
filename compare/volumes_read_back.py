#!/usr/bin/env python3
"""Levels of volumes as pyvista reads them, and how fast they come out of the file.

    python volumes_read_back.py NEPHRITE VOLUME... [--errors 10]

NEPHRITE is the program. Every volume is built and cut at `--errors` errors, spread evenly on a
logarithmic scale between the least and the largest that its levels state. Each cut is written as
VTU and read by pyvista, where every warning of VTK or Python is a failure; it must have as many
tetrahedra and vertices as the program said, all of positive volume, and every field of the input
under its name and in its type. Rates of extraction are those of `nephrite bench`, beside memcpy of
the same bytes.
"""
import argparse
import pathlib
import tempfile
import warnings

import numpy as np
import pyvista
import vtk

from volumes_check import run


def read_without_a_word(path):
    """A file as pyvista reads it; VTK's and Python's warnings are failures."""
    window = vtk.vtkStringOutputWindow()
    before = vtk.vtkOutputWindow.GetInstance()
    vtk.vtkOutputWindow.SetInstance(window)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            grid = pyvista.read(path)
    finally:
        vtk.vtkOutputWindow.SetInstance(before)
    if window.GetOutput():
        raise SystemExit(f"{path}: {window.GetOutput()}")
    return grid


def check(grid, taken, fields):
    """The faults of a level that was read back."""
    faults = []
    if (grid.n_cells, grid.n_points) != (taken["tetrahedra"], taken["vertices"]):
        faults.append(f"{grid.n_cells} cells and {grid.n_points} points")
    if not np.all(grid.celltypes == pyvista.CellType.TETRA):
        faults.append("cells of other types")
    corners = grid.points.astype(float)[grid.cells_dict[pyvista.CellType.TETRA]]
    sides = corners[:, 1:] - corners[:, :1]
    if not np.all(np.linalg.det(sides) > 0):
        faults.append("cells without a positive volume")
    found = {name: (array.dtype, array.shape[1:]) for name, array in grid.point_data.items()}
    if found != fields:
        faults.append(f"fields {found}")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("volumes", nargs="+", type=pathlib.Path)
    parser.add_argument("--errors", type=int, default=10)
    options = parser.parse_args()
    is_good = True
    for path in options.volumes:
        with tempfile.TemporaryDirectory() as folder:
            is_good &= compare(options, path, pathlib.Path(folder))
    raise SystemExit(0 if is_good else 1)


def compare(options, path, folder):
    given = pyvista.read(path)
    fields = {name: (array.dtype, array.shape[1:]) for name, array in given.point_data.items()}
    built = run(options.program, "build", path, "-o", folder / "all.neph")
    stated = [point["error"] for point in run(options.program, "info", folder / "all.neph")["curve"]]
    positive = [error for error in stated if error > 0]
    faults = []
    for error in np.geomspace(min(positive), max(positive), options.errors):
        taken = run(options.program, "extract", folder / "all.neph", "--error", error, "-o", folder / "level.vtu")
        grid = read_without_a_word(folder / "level.vtu")
        faults += [f"at {error:g}: {fault}" for fault in check(grid, taken, fields)]
        if taken["error"] > error:
            faults.append(f"at {error:g}: a level of {taken['error']:g}")
    cuts = run(options.program, "bench", folder / "all.neph")["cuts"]
    rates = ", ".join(f"{cut['tetrahedra']:,} {cut['ratio']:.2f}" for cut in cuts)
    print(f"{path.name}: {built['levels']} levels, {options.errors} errors from {min(positive):g} to {max(positive):g}, "
          f"{'no warning' if not faults else '; '.join(faults)}\n  of memcpy, by tetrahedra: {rates}", flush=True)
    return not faults


if __name__ == "__main__":
    main()
