#!/usr/bin/env python3
"""Checks the levels of `levels_check --write` with PyMeshLab's Metro.

    python metro_check.py METRO.PY FOLDER... [--samples 1000000] [--seconds 120]

METRO.PY is a module with `load(path) -> (vertices, faces)` and `two_sided(reference, mesh, samples)
-> dict` with the keys `max` and `bounding_diagonal`; each FOLDER holds a `levels.json`. Metro
samples, so that what it finds is a lower bound of the distance: a level for which it finds more
than is stated is broken, unless by no more than its own noise (see NOISE). Very coarse levels take
it minutes; after `--seconds` a level is tried again with a tenth of the samples, then with a
hundredth.

Metro sometimes misses the nearest triangle and finds too much, above all on non-manifold surfaces.
Where it finds more than is stated, its samples are taken again and those beyond the stated error
are held against every triangle of the other surface, in double precision. Only what remains counts
as exceeded. Exit status 1 when any level is.
"""
import argparse
import importlib.util
import json
import multiprocessing
import pathlib
import statistics
import sys

import numpy
import pymeshlab

EXACT = 1e-6
"""Levels that state less than this part of the diagonal count as exact: they have no ratio."""

NOISE = 1e-6
"""Part of the diagonal by which Metro may be off: it finds up to 4e-7 between a surface and itself."""

EXCEEDED = "EXCEEDED"

MOST_EXACT = 2000
"""Samples, and vertices, that are held against every triangle at most."""


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


def distance_to_edge(point, start, end):
    along = end - start
    length_sq = (along**2).sum(1)
    part = ((point - start) * along).sum(1) / numpy.where(length_sq > 0, length_sq, 1)
    return numpy.linalg.norm(start + part.clip(0, 1)[:, None] * along - point, axis=1)


def exact_distance(point, triangles):
    """Distance of a point (3,) from the nearest of the triangles (m,3,3)."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = numpy.cross(b - a, c - a)
    normal_sq = (normal**2).sum(1)
    height = ((point - a) * normal).sum(1) / numpy.where(normal_sq > 0, normal_sq, 1)
    foot = point - height[:, None] * normal
    is_inside = normal_sq > 0
    for start, end in ((a, b), (b, c), (c, a)):
        is_inside &= (numpy.cross(end - start, foot - start) * normal).sum(1) >= 0
    to_edges = numpy.minimum.reduce([distance_to_edge(point, *edge) for edge in ((a, b), (b, c), (c, a))])
    return numpy.where(is_inside, numpy.minimum(to_edges, numpy.linalg.norm(foot - point, axis=1)), to_edges).min()


def exact_max(source, target, stated, samples):
    """The largest exact distance from `target` of those samples of `source` that Metro puts beyond `stated`."""
    meshes = pymeshlab.MeshSet(verbose=False)
    for vertices, faces in (source, target):
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.get_hausdorff_distance(
        sampledmesh=0, targetmesh=1, savesample=True, samplevert=False, sampleedge=True, sampleface=True,
        samplenum=samples, maxdist=pymeshlab.PercentageValue(100))
    taken = meshes.mesh(3)
    distances = taken.vertex_scalar_array()
    farthest = numpy.argsort(distances)[-MOST_EXACT:]
    triangles = target[0][target[1]]
    points = [taken.vertex_matrix()[i] for i in farthest if distances[i] > stated]
    points += [vertex for vertex in source[0][numpy.unique(source[1])][:MOST_EXACT]]
    return max((exact_distance(point, triangles) for point in points), default=0.0)


def verdict(record, reference, mesh, found, samples):
    stated, noise = record["stated"], NOISE * found["bounding_diagonal"]
    if found["max"] <= stated:
        return "holds"
    if found["max"] <= stated + noise:
        return "holds to within Metro's noise"
    exact = max(exact_max(*pair, stated, samples) for pair in ((reference, mesh), (mesh, reference)))
    return EXCEEDED if exact > stated + noise else f"holds: Metro missed a triangle, exactly {exact:.9g}"


def check_folder(given, metro, folder):
    """Yields (record of levels.json, what Metro found or None, samples taken, what that means)."""
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
        explained = found and verdict(record, references[name], mesh, found, samples)
        yield record, found, samples, explained


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
            for record, found, samples, explained in check_folder(given, metro, folder):
                name = pathlib.Path(record["mesh"]).name
                if found is None:
                    print(f"{name}: not measured in {given.seconds:g} s with {samples} samples", flush=True)
                    continue
                stated, measured = record["stated"], found["max"]
                excess = (measured - stated) / found["bounding_diagonal"]
                n_levels += 1
                n_exceeded += explained == EXCEEDED
                if stated > EXACT * found["bounding_diagonal"]:
                    ratios.append(measured / stated)
                print(f"{name:50s} {record['triangles']:8d} triangles  stated {stated:.9g}  metro {measured:.9g} "
                      f"({samples} samples)  ours {record['max']:.9g}  excess {100 * excess:+.3g} %  "
                      f"{explained}", flush=True)
        except Exception as error:  # a mesh that the other program cannot read must not hide the rest
            print(f"{folder}: skipped: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
    if ratios:
        ratios.sort()
        print(f"{n_levels} levels, {n_exceeded} exceeded; metro / stated: median {statistics.median(ratios):.3f}, "
              f"tenth percentile {ratios[len(ratios) // 10]:.3f}, least {ratios[0]:.3f}")
    return 1 if n_exceeded else 0


if __name__ == "__main__":
    sys.exit(main())
