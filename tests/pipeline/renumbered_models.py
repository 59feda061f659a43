#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Real broken models, their vertices and faces numbered anew: a baseline of the old
numbers knows every finding.

Usage: renumbered_models.py CDPREP
"""
import json
import pathlib
import random
import sys
import tempfile

from shared_models import must, run, shared_folder

# Of one triangle that occurs four times, whether the others count as copies of the same or
# of the opposite winding follows the lowest number.
FOLLOWS_NUMBERING = {"chair.off": {"CDP0204": 1, "CDP0205": 1}}


def read_obj(path):
    vertices, faces = [], []
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(" ".join(words[1:4]))
        elif words[:1] == ["f"]:
            numbers = [int(word.split("/")[0]) for word in words[1:]]
            faces.append([n - 1 if n > 0 else len(vertices) + n for n in numbers])
    return vertices, faces


def read_off(path):
    words = [word for line in path.read_text().splitlines() for word in line.split("#")[0].split()]
    must(words[0] == "OFF", f"{path} begins with {words[0]}")
    vertex_count, face_count, at = int(words[1]), int(words[2]), 4
    vertices = [" ".join(words[at + 3 * i:at + 3 * i + 3]) for i in range(vertex_count)]
    at += 3 * vertex_count
    faces = []
    for _ in range(face_count):
        size = int(words[at])
        faces.append([int(word) for word in words[at + 1:at + 1 + size]])
        at += 1 + size
    return vertices, faces


def write_obj(path, vertices, faces):
    lines = ["v " + vertex for vertex in vertices]
    lines += ["f " + " ".join(str(n + 1) for n in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def renumbered(vertices, faces):
    new = list(range(len(vertices)))
    random.shuffle(new)
    moved = [None] * len(vertices)
    for old, vertex in enumerate(vertices):
        moved[new[old]] = vertex
    faces = [[new[n] for n in face] for face in faces]
    random.shuffle(faces)
    return moved, faces


def main():
    program, hard = sys.argv[1], shared_folder() / "models/hard"
    random.seed(1)
    known = models = 0
    with tempfile.TemporaryDirectory() as scratch:
        mesh, old = pathlib.Path(scratch) / "mesh.obj", pathlib.Path(scratch) / "old.json"
        for path in sorted(hard.iterdir()):
            if path.suffix not in (".obj", ".off"):
                continue
            model = (read_obj if path.suffix == ".obj" else read_off)(path)
            write_obj(mesh, *model)
            done = run(program, "validate", mesh, "--format", "json", "--max-issues", 1_000_000,
                       "-o", old)
            must(done.returncode == 0, f"{path.name}: {done.stderr}")
            write_obj(mesh, *renumbered(*model))
            done = run(program, "validate", mesh, "--format", "json", "--baseline", old)
            report, = json.loads(done.stdout)["meshes"]
            allowed = FOLLOWS_NUMBERING.get(path.name, {})
            for finding in report["findings"]:
                must(finding["new"] <= allowed.get(finding["rule"], 0),
                     f"{path.name}: {finding['new']} of {finding['count']} {finding['name']} are "
                     f"called new, first {finding['places'][:1]}")
            known += report["known"]
            models += 1
    must(models > 10 and known > 50_000, f"only {known} findings of {models} models")
    print(f"{known} findings of {models} models are known again")


main()
