#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h5py shows a bake as tables that a scientist understands, with the mesh in them.

Usage: opens_in_h5py.py CDPREP
"""
import json
import pathlib
import sys
import tempfile

from schemas import report_of
from shared_models import SKIPPED, bake, must, run

try:
    import h5py
    import numpy
except ImportError:
    print("skipped: no h5py")
    sys.exit(SKIPPED)

# Two groups and materials, a quad, 0.1 as text with more digits than a float has.
OBJ = """mtllib none.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 0.12345678901234
g floor
usemtl stone
f 1 4 3 2
g walls
usemtl wood
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
"""
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0.12345678901234)]


def text(attribute):
    return attribute.decode() if isinstance(attribute, bytes) else str(attribute)


def names(dataset):
    return bytes(dataset[:]).decode().split("\0")[:-1]


def triangle_set(data):
    """Each triangle by its corners' coordinates, first the least, in source order."""
    positions, triangles = data["positions_f64"][:], data["triangles"][:]
    ordered = numpy.empty_like(triangles)
    ordered[data["source_triangle"][:]] = triangles
    corners = [[tuple(positions[v]) for v in triangle] for triangle in ordered]
    return [triangle[k:] + triangle[:k] for triangle in corners
            for k in [triangle.index(min(triangle))]]


def check_frame(data):
    """The root's boxes, placed by the attributes, are that of the corners."""
    must(int(data.attrs["format_version"]) == 1, "no version")
    must(float(data.attrs["metres_per_unit"]) == 0.001, f"unit {data.attrs['metres_per_unit']}")
    must(text(data.attrs["up_axis"]) == "z", f"up axis {data.attrs['up_axis']}")
    scale = 2.0 ** -int(data.attrs["frame_exponent"])
    root = data["bvh_nodes"][0]
    used = root["lower"][0] <= root["upper"][0]
    for place, least in (("lower", numpy.min), ("upper", numpy.max)):
        box = [least(root[place][axis][used]) for axis in range(3)]
        placed = numpy.array(box) * scale + data.attrs["frame_origin"]
        must(numpy.allclose(placed, least(CORNERS, axis=0), atol=1e-6), f"{place} is {placed}")


def main():
    program = sys.argv[1]
    scratch = tempfile.TemporaryDirectory()
    folder = pathlib.Path(scratch.name)
    (folder / "tent.obj").write_text(OBJ)
    output = folder / "tent.cdp.h5"
    bake(program, folder / "tent.obj", "-o", output, "--effects", "all", "--unit", "mm",
         "--up-axis", "z")
    info = report_of("info", run(program, "info", output, "--format", "json").stdout)

    with h5py.File(output, "r") as file:
        must(list(file) == ["cdprep"], f"groups {list(file)}")
        data = file["cdprep"]
        # Empty sections have no dataset: a small model's hulls store no neighbours.
        stored = [section for section in info["sections"] if section["bytes"] > 0]
        must({section["name"] for section in stored} == set(data),
             "info and h5py list different sections")
        for section in stored:
            dataset = data[section["name"]]
            must(text(dataset.attrs["units"]) and text(dataset.attrs["description"]),
                 f"{section['name']} has no units or no description")
            must(dataset.id.get_offset() == section["offset"]
                 and dataset.id.get_storage_size() == section["bytes"]
                 and len(dataset) == section["count"], f"{section['name']} lies elsewhere")
            must(dataset.chunks is None and dataset.compression is None,
                 f"{section['name']} is not one plain run")

        must({tuple(p) for p in data["positions_f64"][:]} == set(CORNERS), "positions differ")
        # The quad is fanned from its first corner; faces keep their order.
        c = CORNERS
        faces = [[c[0], c[3], c[2]], [c[0], c[2], c[1]], [c[0], c[1], c[4]], [c[1], c[2], c[4]],
                 [c[2], c[3], c[4]], [c[3], c[0], c[4]]]
        found, wanted = triangle_set(data), [f[k:] + f[:k] for f in faces for k in [f.index(min(f))]]
        must(sorted(map(sorted, found)) == sorted(map(sorted, wanted))
             or sorted(map(sorted, found[2:])) == sorted(map(sorted, wanted[2:])),
             f"triangles differ: {found}")
        must(found[2:] == wanted[2:], f"triangles or their winding differ: {found}")
        must(list(data["source_face"][:]) == [0, 0, 1, 2, 3, 4], "faces differ")
        must(names(data["group_names"]) == ["floor", "walls"], "groups differ")
        must(names(data["material_names"]) == ["stone", "wood"], "materials differ")
        for runs in ("group_runs", "material_runs"):
            must([(r["first_triangle"], r["triangle_count"], r["name"]) for r in data[runs][:]]
                 == [(0, 2, 0), (2, 4, 1)], f"{runs} differ")

        mass = data["mass_properties"][0]  # a pyramid over a unit square
        must(abs(mass["volume"] - 0.12345678901234 / 3) < 1e-15, f"volume {mass['volume']}")
        must(numpy.allclose(mass["centre"][2], 0.12345678901234 / 4, atol=1e-15), "centre differs")
        must(mass["inertia"].shape == (6,), "inertia has another shape")
        bounds = data["bounds"][0]
        must(list(bounds["lower"]) == [0, 0, 0] and bounds["upper"][0] == 1, "bounds differ")
        must(data["bvh_nodes"].dtype["lower"].shape == (3, 8), "boxes have another shape")
        must(numpy.all(data["bvh_nodes"]["lower"][0][:, 0] <= data["bvh_nodes"]["upper"][0][:, 0]),
             "the first box is empty")
        check_frame(data)
        provenance = json.loads(bytes(data["provenance"][:]))
        must(str(folder) not in json.dumps(provenance), "the provenance knows a path")
        print(json.dumps(provenance))
    check_reindex(program, output)


def check_reindex(program, output):
    """A dataset of another type, shape or layout is named, and the file stays as it is."""
    for change, word in ((lambda d: d.astype("f4"), "type"),
                         (lambda d: d.reshape(-1), "shape"),
                         (lambda d: d[:, :2], "shape")):
        other = output.with_name("other.cdp.h5")
        other.write_bytes(output.read_bytes())
        with h5py.File(other, "r+") as file:
            data = file["cdprep/positions_f64"][:]
            del file["cdprep/positions_f64"]
            file["cdprep"].create_dataset("positions_f64", data=change(data))
        before = other.read_bytes()
        done = run(program, "reindex", other)
        must(done.returncode == 3 and f"positions_f64 has another {word}" in done.stderr,
             f"{word}: {done.returncode}, {done.stderr}")
        must(other.read_bytes() == before, "a file that is refused was changed")


main()
