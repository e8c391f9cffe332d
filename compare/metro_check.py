#!/usr/bin/env python3
"""Hold the levels that `levels_check --write` wrote against an independent measurement: PyMeshLab's Metro.

    python metro_check.py METRO.PY FOLDER... [--samples 1000000] [--seconds 120]

METRO.PY is a module with `load(path) -> (vertices, faces)` and `two_sided(reference, mesh, samples) -> dict` with the
keys `max` and `bounding_diagonal`; each FOLDER holds a `levels.json`. Metro samples, so that what it finds is a lower
bound of the distance: a level for which it finds more than is stated is broken, unless by no more than its own noise (see
NOISE). Very coarse levels take it minutes; after `--seconds` a level is tried again with a tenth of the samples, then
with a hundredth. Exit status 1 when any level is exceeded.
"""
import argparse
import importlib.util
import json
import multiprocessing
import pathlib
import statistics
import sys

EXACT = 1e-6
"""Levels that state less than this part of the diagonal count as exact: they have no ratio."""

NOISE = 1e-6
"""Part of the diagonal by which Metro may be off: it finds up to 4e-7 between a surface and itself."""


def load_module(path):
    specification = importlib.util.spec_from_file_location("metro", path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def measure_within(seconds, metro, reference, mesh, samples):
    """What Metro finds, or None when it takes longer; in a process of its own, since it cannot be interrupted."""
    receiver, sender = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.Process(target=lambda: sender.send(metro.two_sided(reference, mesh, samples)))
    process.start()
    sender.close()
    try:
        return receiver.recv() if receiver.poll(seconds) else None
    finally:
        process.kill()
        process.join()


def verdict(excess):
    if excess <= 0:
        return "holds"
    return "holds to within Metro's noise" if excess <= NOISE else "EXCEEDED"


def check_folder(given, metro, folder):
    """Yields (record of levels.json, what Metro found or None, samples taken)."""
    references = {}
    for record in json.loads((folder / "levels.json").read_text()):
        name = record["reference"]
        if name not in references:
            references[name] = metro.load(name)
        mesh = metro.load(record["mesh"])
        for samples in (given.samples, given.samples // 10, given.samples // 100):
            found = measure_within(given.seconds, metro, references[name], mesh, samples)
            if found is not None:
                break
        yield record, found, samples


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("metro", type=pathlib.Path)
    parser.add_argument("folders", type=pathlib.Path, nargs="+", metavar="FOLDER")
    parser.add_argument("--samples", type=int, default=1_000_000)
    parser.add_argument("--seconds", type=float, default=120)
    given = parser.parse_args()
    multiprocessing.set_start_method("fork")
    metro = load_module(given.metro)
    ratios, n_levels, n_exceeded = [], 0, 0
    for folder in given.folders:
        try:
            for record, found, samples in check_folder(given, metro, folder):
                name = pathlib.Path(record["mesh"]).name
                if found is None:
                    print(f"{name}: not measured in {given.seconds:g} s with {samples} samples", flush=True)
                    continue
                stated, measured = record["stated"], found["max"]
                excess = (measured - stated) / found["bounding_diagonal"]
                n_levels += 1
                n_exceeded += excess > NOISE
                if stated > EXACT * found["bounding_diagonal"]:
                    ratios.append(measured / stated)
                print(f"{name:50s} {record['triangles']:8d} triangles  stated {stated:.9g}  metro {measured:.9g} "
                      f"({samples} samples)  ours {record['max']:.9g}  excess {100 * excess:+.3g} %  "
                      f"{verdict(excess)}", flush=True)
        except Exception as error:  # a mesh that the other program cannot read must not hide the rest
            print(f"{folder}: skipped: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
    if ratios:
        ratios.sort()
        print(f"{n_levels} levels, {n_exceeded} exceeded; metro / stated: median {statistics.median(ratios):.3f}, "
              f"tenth percentile {ratios[len(ratios) // 10]:.3f}, least {ratios[0]:.3f}")
    return 1 if n_exceeded else 0


if __name__ == "__main__":
    sys.exit(main())
