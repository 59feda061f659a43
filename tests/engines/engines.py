#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Parts of three models in the engines that they are for: a bolt, a bracket and a kettle. Each
engine must accept every part. The body that falls onto a floor must come to rest on it, within
what the engine allows. It must have the mass, the centre and the inertia of the mesh. Prints a
table: points given and kept, depth and speed after two seconds. Sizes are true, and engines build
their own hulls with their default tolerances. "unity" is PhysX with the parts that Unity gets.

Usage: engines.py native CDPREP FOLDER DROP_BULLET DROP_MUJOCO SIMULATOR_READERS
       engines.py npm CDPREP FOLDER
The second installs the packages of package.json into FOLDER; it is skipped where that fails."""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent / "pipeline"))
from colliders import lowest  # noqa: E402
from shared_models import SKIPPED, must, run  # noqa: E402

DENSITY = 1000  # kg per cubic metre
TURN = (math.sin(0.25), 0.0, 0.0, math.cos(0.25))  # bodies start tilted, by half a radian
DROP = 0.1  # metres, at the start, below the lowest point
MOST_SPEED = 0.5  # metres a second after two seconds; what is round still rolls
MOST_GAP = 0.002  # metres below a body at rest
LEAST_KEPT = 0.95  # of the points that are given
# Metres that a body at rest may be deep. Jolt: mPenetrationSlop, as drop.mjs sets it. Rapier: twice
# its allowed error. MuJoCo's contacts are soft by design. The others state nothing.
SLOP = {"Bullet 3.24": 0.001, "MuJoCo 2.2.2": 0.005, "jolt": 0.002, "physx": 0.001, "rapier": 0.002,
        "havok": 0.002, "mujoco": 0.005}
CENTRE_ERROR = 1e-5  # as a share of the distance from the origin: engines take floats
INERTIA_ERROR = 1e-4  # as a share of the largest entry
MODELS = {
    "bolt": ("mm", ["--max-error", 0.5]),
    "bracket": ("mm", ["--max-error", 0.5]),
    "kettle": ("m", ["--parts", 32]),
}
METRES = {"mm": 0.001, "m": 1}


def exported(program, source, folder, kinds, unit, limits):
    """The files that `export` writes of a baked file."""
    baked = folder / f"{source.stem}.cdp.h5"
    done = run(program, "bake", source, "-o", baked, "--unit", unit, "--structures", "hull",
               "--hull-vertices", 64, *limits)
    must(done.returncode in (0, 1), f"bake {source.name}: {done.stderr}")
    outputs = {kind: folder / f"{source.stem}_parts.{kind}" for kind in ("json", *kinds)}
    engines = {"json": ["json"], "glb": ["godot", "--no-visual"], "sdf": ["gazebo", "--no-visual"],
               "mjcf": ["mujoco", "--no-visual", "--floating"], "unity": ["unity", "--no-visual"]}
    for kind, output in outputs.items():
        written = {"mjcf": output.with_suffix(".xml"),
                   "unity": output.with_name(f"{source.stem}_unity.glb")}.get(kind, output)
        done = run(program, "export", baked, "--for", *engines[kind], "-o", written)
        must(done.returncode == 0, f"export {source.name} for {engines[kind]}: {done.stderr}")
        outputs[kind] = written
    return outputs


class Exported:
    """The colliders of a model, and the files that engines read."""

    def __init__(self, program, folder, name, kinds):
        self.name, (unit, limits) = name, MODELS[name]
        source = ROOT / f"samples/meshes/{name}.obj"
        if name == "kettle":
            source = folder / "kettle.obj"
            subprocess.run([sys.executable, HERE / "make_kettle.py", source], check=True)
        outputs = exported(program, source, folder, kinds, unit, limits)
        self.json, self.glb, self.sdf, self.unity = (
            outputs.get(kind) for kind in ("json", "glb", "sdf", "unity"))
        self.mjcf = with_floor(outputs["mjcf"], folder / f"{name}_floor.mjcf")
        self.colliders = json.loads(self.json.read_text())
        of_mesh, metres = self.colliders["mass"], METRES[unit]
        # The spout and the handle of the kettle reach into its body.
        must(of_mesh["of_solid"] == (name != "kettle"), f"{name}: {of_mesh}")
        self.mass = DENSITY * metres ** 3 * of_mesh["volume"]
        self.centre = [metres * x for x in of_mesh["centre"]]
        self.inertia = [[DENSITY * metres ** 5 * x for x in row] for row in of_mesh["inertia"]]
        self.start = [0, 0, DROP - lowest(self.colliders, TURN, (0, 0, 0))]

    def place(self):
        return [*self.start, *TURN]


def with_floor(source, target):
    """The MJCF with a floor below its body."""
    tree = xml.parse(source)
    world = tree.getroot().find("worldbody")
    world.insert(0, xml.Element("geom", type="plane", size="50 50 1"))
    tree.write(target)
    return target


def must_read(done, what):
    must(done.returncode == 0, f"{what}: exit {done.returncode}: {done.stderr}{done.stdout}")
    return json.loads(done.stdout.splitlines()[-1])


class Table:
    """The rows, and what is wrong with them."""

    def __init__(self):
        self.faults = []
        print(f"{'engine':14}{'model':9}{'parts':>7}{'given':>7}{'kept':>6}{'':>7}"
              f"{'depth mm':>10}{'speed m/s':>11}{'centre um':>11}{'inertia':>10}")

    def fault(self, condition, sentence):
        if not condition:
            self.faults.append(sentence)

    def add(self, engine, model, result):
        name = f"{engine}, {model.name}"
        depth = -lowest(model.colliders, result["quaternion"], result["position"])
        kept = result["kept"] / result["given"]
        print(f"{engine:14}{model.name:9}{result['parts']:7}{result['given']:7}"
              f"{result['kept']:6}{100 * kept:6.1f}%{1000 * depth:10.3f}{result['speed']:11.4f}"
              f"{self.weight(name, model, result)}", flush=True)
        self.fault(result["parts"] == len(model.colliders["parts"]), f"{name}: parts are lost")
        self.fault(result["is_finite"], f"{name}: a number is not finite")
        self.fault(abs(result["mass"] - model.mass) <= 1e-4 * model.mass,
                   f"{name}: {result['mass']} kg, not {model.mass}")
        self.fault(kept >= LEAST_KEPT,
                   f"{name}: keeps {result['kept']} of {result['given']}")
        self.fault(result["speed"] <= MOST_SPEED, f"{name}: {result['speed']} m/s after 2 s")
        self.fault(depth <= SLOP[engine], f"{name}: {depth} m deep")
        self.fault(-depth <= MOST_GAP, f"{name}: {-depth} m above the floor")

    def weight(self, name, model, result):
        """How far centre and inertia are from those of the mesh, where the engine tells them."""
        if "centre" not in result:
            return f"{'-':>11}{'-':>10}"
        centre = math.dist(result["centre"], model.centre)
        flat, wanted = sum(result["inertia"], []), sum(model.inertia, [])
        inertia = max(abs(x - y) for x, y in zip(flat, wanted, strict=True)) / max(wanted)
        self.fault(centre <= CENTRE_ERROR * math.hypot(*model.centre),
                   f"{name}: centre {result['centre']}, not {model.centre}")
        self.fault(inertia <= INERTIA_ERROR,
                   f"{name}: inertia {result['inertia']}, not {model.inertia}")
        return f"{1e6 * centre:11.4f}{inertia:10.1e}"

    def add_unity(self, model, result):
        """Unity cooks a mesh as it is stored. PhysX drops points of hulls smaller than 1 by an
        absolute height, so a bolt of 34 mm loses many when it is cooked in metres."""
        kept, metres = (result[k] / result["given"] for k in ("kept", "kept_in_metres"))
        print(f"{'unity':14}{model.name:9}{result['parts']:7}{result['given']:7}{result['kept']:6}"
              f"{100 * kept:6.1f}%   (cooked in metres: {result['kept_in_metres']}, "
              f"{100 * metres:.1f}%)", flush=True)
        self.fault(result["parts"] == len(model.colliders["parts"]), f"unity, {model.name}: lost")
        self.fault(kept >= LEAST_KEPT, f"unity, {model.name}: keeps {100 * kept:.1f}%")
        self.fault(metres < LEAST_KEPT,
                   f"unity, {model.name}: PhysX keeps {100 * metres:.1f}% in metres too")

    def end(self):
        for sentence in self.faults:
            print(f"FAILED: {sentence}")
        sys.exit(1 if self.faults else 0)


def native(models, bullet, mujoco, readers):
    table = Table()
    for model in models:
        table.add("Bullet 3.24", model, must_read(run(bullet, model.json, *model.place()),
                                                  "drop_bullet"))
        table.add("MuJoCo 2.2.2", model, must_read(run(mujoco, model.mjcf, *model.place()),
                                                   "drop_mujoco"))
        found = must_read(run(readers, model.sdf), f"SDFormat, {model.name}")
        must(found["is_valid"] and len(found["parts"]) == len(model.colliders["parts"]),
             f"SDFormat, {model.name}: {found}")
        must(abs(found["mass"] - model.mass) <= 1e-6 * model.mass, f"SDFormat: {found['mass']}")
        must(math.dist(found["centre"], model.centre) <= CENTRE_ERROR * math.hypot(*model.centre),
             f"SDFormat, {model.name}: centre {found['centre']}, not {model.centre}")
        print(f"{'SDFormat 12':14}{model.name:9}{len(found['parts']):7}  the inertia is valid")
    table.end()


def install(folder):
    """Installs the packages, or exits as skipped."""
    for tool in ("node", "npm"):
        if shutil.which(tool) is None:
            print(f"skipped: there is no {tool}")
            sys.exit(SKIPPED)
    for source in [*HERE.glob("*.mjs"), *(ROOT / "samples/engines").glob("*.mjs")]:
        shutil.copy(source, folder)
    wanted, there = HERE / "package.json", folder / "installed.json"
    if there.exists() and there.read_text() == wanted.read_text():
        return
    shutil.copy(wanted, folder)
    done = run("npm", "install", "--prefix", folder, "--no-audit", "--no-fund", "--ignore-scripts",
               "--fetch-retries", 1, "--fetch-timeout", 30000)
    if done.returncode != 0:
        print(f"skipped: npm cannot install the engines: {done.stderr.strip()[-500:]}")
        sys.exit(SKIPPED)
    shutil.copy(wanted, there)


def read_glb(model, folder):
    meshes = must_read(run("node", "read_glb.mjs", model.glb, cwd=folder), f"three, {model.name}")
    parts = model.colliders["parts"]
    triangles = sum(mesh["triangles"] for mesh in meshes)
    must(len(meshes) == len(parts), f"three, {model.name}: {len(meshes)} meshes")
    must(triangles == sum(len(part["triangles"]) // 3 for part in parts),
         f"three, {model.name}: {triangles} triangles")
    must(all(mesh["hits"] + mesh["flat"] == mesh["triangles"] for mesh in meshes),
         f"three-mesh-bvh, {model.name}: a ray misses: {meshes}")
    must(len({mesh["name"] for mesh in meshes}) == len(meshes), "three: two meshes with one name")
    points = sum(mesh["points"] for mesh in meshes)
    print(f"{'three':14}{model.name:9}{len(meshes):7}{points:7}{points:6}  {triangles} triangles")


def npm(models, folder):
    table = Table()
    for model in models:
        for engine in ("jolt", "physx", "rapier", "havok", "mujoco"):
            done = run("node", "drop.mjs", engine, model.json, model.mjcf, *model.place(),
                       cwd=folder)
            table.add(engine, model, must_read(done, f"{engine}, {model.name}"))
        done = run("node", "cook.mjs", model.unity, cwd=folder)
        table.add_unity(model, must_read(done, f"unity, {model.name}"))
        read_glb(model, folder)
    table.end()


def main():
    kind, program, where, *programs = sys.argv[1:]
    folder = pathlib.Path(where)
    folder.mkdir(parents=True, exist_ok=True)
    if kind == "npm":
        install(folder)
    kinds = ("mjcf", "glb", "unity") if kind == "npm" else ("mjcf", "sdf")
    models = [Exported(program, folder, name, kinds) for name in MODELS]
    if kind == "npm":
        npm(models, folder)
    else:
        native(models, *programs)


main()
