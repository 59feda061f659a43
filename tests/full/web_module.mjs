// SPDX-License-Identifier: MIT
// What cross_answers.mjs does not ask of cdprep.wasm: other questions, and mistakes of callers.
// Usage: node web_module.mjs MODULE_FOLDER FOLDER_WITH_MODELS
import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, models] = process.argv.slice(2).map((path) => resolve(path));
const { load, CdprepError } = await import(pathToFileURL(join(folder, "cdprep.mjs")));
const wasm = await readFile(join(folder, "cdprep.wasm"));
const cdprep = await load(wasm);
const names = (await readdir(models)).filter((name) => name.endsWith(".cdp.h5"));
const bytes = await readFile(join(models, names.find((name) => !name.startsWith("damaged"))));
const model = cdprep.open(bytes), other = cdprep.open(new Uint8Array(bytes).buffer);

/** Whether a call is refused with a code and words. */
function refuses(call, code, words) {
  assert.throws(call, (error) => error instanceof CdprepError && error.code === code &&
    error.message.includes(words));
}

// The test all_files_name_one_version compares that of the package with CMake's.
const { version } = JSON.parse(await readFile(join(folder, "package.json"), "utf8"));
assert.deepEqual(cdprep.version, { version, kernels: "simd128" });

// The mesh: its corners span the box, and each ray towards a corner hits at most as far away.
const { positions, triangles } = model.mesh();
assert.equal(positions.length, 3 * model.vertexCount);
assert.equal(triangles.length, 3 * model.triangleCount);
assert(triangles.every((corner) => corner < model.vertexCount));
for (let axis = 0; axis < 3; ++axis) {
  const along = positions.filter((_, i) => i % 3 === axis);
  assert.equal(along.reduce((a, b) => Math.min(a, b)), model.box.lower[axis]);
  assert.equal(along.reduce((a, b) => Math.max(a, b)), model.box.upper[axis]);
}
const origin = model.box.lower.map((x) => x - 1);
for (let vertex = 0; vertex < model.vertexCount; vertex += Math.ceil(model.vertexCount / 50)) {
  const corner = [0, 1, 2].map((axis) => positions[3 * vertex + axis]);
  const hit = model.ray(origin, corner.map((x, axis) => x - origin[axis]));
  assert(hit !== null && hit.t <= 1 + 1e-9 && hit.triangle < model.triangleCount);
}
assert.equal(model.ray(origin, [-1, -1, -1]), null);

// Two copies in one place touch. Far apart, neither they nor their solids do.
const apart = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1000, 0, 0, 1];
assert.equal(model.collide(other), true);
assert.equal(model.distance(other).upper, 0);
assert.equal(model.collide(other, apart), false);
assert.equal(model.collide(other, apart, { solid: true }), false);
assert.equal(model.overlaps(other, apart).length, 0);
assert.equal(model.distance(other, apart, { most: 1 }), null);
assert(model.distance(other, apart).lower > 900);

// A matrix of floats is taken as the nearest rigid motion, unless it is to be exact.
const [c, s] = [Math.fround(Math.cos(0.3)), Math.fround(Math.sin(0.3))];
const floats = [c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 1000, 0, 0, 1];
assert.equal(model.collide(other, floats), false);
refuses(() => model.collide(other, floats, { exact: true }), 2, "scales or shears");

// A pose has no last row, so that of an exact matrix must be 0 0 0 1.
for (const [i, wrong] of [[3, 0.5], [7, -1e-9], [11, NaN], [15, 2], [15, 0]]) {
  const projecting = apart.map((x, k) => k === i ? wrong : x);
  for (const ask of ["collide", "overlaps", "distance"]) {
    refuses(() => model[ask](other, projecting, { exact: true }), 2, "its last row must be 0 0 0 1");
  }
}
assert.equal(model.collide(other, apart.map((x, k) => k === 3 ? -0 : x), { exact: true }), false);
refuses(() => model.collide(other, apart.map((x, i) => i < 15 ? 2 * x : x)), 2, "scales");
refuses(() => model.collide(other, [1, 2, 3]), 2, "3 numbers; 16");
refuses(() => model.collide({}), 2, "is not a model of this module");
refuses(() => model.ray([0, 0], [1, 0, 0]), 2, "3 numbers");
refuses(() => model.ray([0, 0, NaN], [1, 0, 0]), 2, "query.rays[0]");
refuses(() => cdprep.open(new Uint8Array(10), "ten.cdp.h5"), 3, "ten.cdp.h5");
const stranger = (await load(wasm)).open(bytes);
refuses(() => model.collide(stranger), 2, "is not a model of this module");
other.close();
other.close();
refuses(() => model.collide(other), 2, "closed");
console.log("wasm: the module answers and refuses as it says");
