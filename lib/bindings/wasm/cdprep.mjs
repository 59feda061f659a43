// SPDX-License-Identifier: MIT
// Exact queries on baked models in a browser or in node, by WebAssembly.
//
//   import { load } from "./cdprep.mjs";
//   const cdprep = await load(await (await fetch("cdprep.wasm")).arrayBuffer());
//   const arm = cdprep.open(armBytes, "arm.cdp.h5"), part = cdprep.open(partBytes);
//   arm.overlaps(part, matrix)   // Uint32Array: a triangle of each model, pair by pair
//
// A matrix has 16 numbers, column by column as in WebGL and three.js. It moves the other model into
// this one's frame. Floats are taken: a matrix that is rigid but for 1e-5 is replaced by the nearest
// rigid motion. With { exact: true } its numbers are used as they are; its last row must be 0 0 0 1.

const TOLERANCE = 1e-5;
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** A refused argument or an unreadable file. `code` is that of the C API. */
export class CdprepError extends Error {
  constructor(code, message) {
    super(message);
    this.name = "CdprepError";
    this.code = code;
  }
}

/** What the module asks of its host: nothing but an end. It reads no file and no variable. */
function host(memoryOf) {
  const none = () => 0;
  const set = (address, value) => new DataView(memoryOf()).setUint32(address, value, true);
  return {
    env: { emscripten_notify_memory_growth: none },
    wasi_snapshot_preview1: {
      proc_exit(code) { throw new Error(`cdprep.wasm ended with exit code ${code}`); },
      fd_write: () => 8, fd_read: () => 8, fd_close: none, fd_seek: () => 8,
      environ_sizes_get(count, bytes) { set(count, 0); set(bytes, 0); return 0; },
      environ_get: none,
    },
  };
}

/** Loads the module from the bytes of cdprep.wasm. */
export async function load(wasm) {
  let exports = null;
  const imports = host(() => exports.memory.buffer);
  const filled = await WebAssembly.compile(wasm);
  for (const { module, name } of WebAssembly.Module.imports(filled)) {
    imports[module] ??= {};
    imports[module][name] ??= () => { throw new Error(`cdprep.wasm called ${module}.${name}`); };
  }
  exports = (await WebAssembly.instantiate(filled, imports)).exports;
  exports._initialize?.();
  return new Cdprep(exports);
}

/** A loaded module. Its memory grows, so that no view of it outlives a call. */
class Cdprep {
  #exports;
  constructor(exports) { this.#exports = exports; }

  /** The version of the library and its kernels. */
  get version() {
    const kernels = this.#text(this.#exports.web_version());
    const [major, minor, patch] = this.#numbers(3);
    return { version: `${major}.${minor}.${patch}`, kernels };
  }

  /** Opens the bytes of a baked file, which are copied. `name` stands in messages. */
  open(bytes, name = "model") {
    const wasm = this.#exports;
    const source = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
    const copy = this.#put(source);
    const title = this.#put(new TextEncoder().encode(`${name}\0`));
    const model = this.#address("web_open", copy, source.length, title);
    wasm.web_release(title);
    if (model === 0) {
      wasm.web_release(copy);
      throw new CdprepError(wasm.web_code(), this.#text(wasm.web_message()));
    }
    return new Model(this, model, copy);
  }

  // --- For Model alone ---------------------------------------------------------------

  /** Calls a function of the module. Throws what it refuses. */
  ask(name, ...values) {
    const answer = this.#exports[name](...values);
    if (answer < 0) throw new CdprepError(-answer, this.#text(this.#exports.web_message()));
    return answer;
  }
  /** Stores numbers for the next call; there is room for 32. */
  give(...numbers) {
    new Float64Array(this.#exports.memory.buffer, this.#address("web_numbers"), 32).set(numbers);
  }
  /** Returns a copy of what the last call stored. */
  take(count) { return this.#numbers(count); }
  pairs(count) {
    if (count === 0) return new Uint32Array();
    return new Uint32Array(this.#exports.memory.buffer, this.#address("web_pairs"), 2 * count)
      .slice();
  }
  /** Calls fill(addresses) with room for arrays of these types and lengths. Returns copies. */
  filled(kinds, fill) {
    const places = kinds.map(([Kind, length]) =>
      this.#room(Math.max(1, length) * Kind.BYTES_PER_ELEMENT));
    try {
      fill(places);
      return kinds.map(([Kind, length], i) =>
        new Kind(this.#exports.memory.buffer, places[i], length).slice());
    } finally {
      places.forEach((place) => this.#exports.web_release(place));
    }
  }
  end(model, bytes) {
    this.#exports.web_close(model);
    this.#exports.web_release(bytes);
  }

  /** Addresses come as signed numbers. */
  #address(name, ...values) { return this.#exports[name](...values) >>> 0; }
  #room(size) {
    const place = this.#address("web_allocate", size);
    if (place === 0) throw new CdprepError(5, `There is not enough memory for ${size} bytes.`);
    return place;
  }
  #put(bytes) {
    const place = this.#room(bytes.length);
    new Uint8Array(this.#exports.memory.buffer, place).set(bytes);
    return place;
  }
  #numbers(count) {
    const place = this.#address("web_numbers");
    return Array.from(new Float64Array(this.#exports.memory.buffer, place, count));
  }
  #text(address) {
    const bytes = new Uint8Array(this.#exports.memory.buffer, address >>> 0);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }
}

/** An open model. Triangles have the numbers of the imported file; lengths are model units. */
class Model {
  #cdprep;
  #model;
  #bytes;
  constructor(cdprep, model, bytes) {
    this.#cdprep = cdprep;
    this.#model = model;
    this.#bytes = bytes;
    this.#describe();
  }
  #describe() {
    this.#cdprep.ask("web_describe", this.#model);
    const facts = this.#cdprep.take(10);
    [this.triangleCount, this.vertexCount] = facts;
    this.isBalanced = facts[2] === 1;
    this.metresPerUnit = facts[3];
    this.box = { lower: facts.slice(4, 7), upper: facts.slice(7, 10) };
  }

  /** The mesh: positions, three numbers a vertex, and triangles, three vertices each. */
  mesh() {
    const [vertices, triangles] = [this.vertexCount, this.triangleCount];
    const [positions, corners] = this.#cdprep.filled(
      [[Float64Array, 3 * vertices], [Uint32Array, 3 * triangles]],
      ([p, t]) => this.#cdprep.ask("web_mesh", this.#open(), p, vertices, t, triangles));
    return { positions, triangles: corners };
  }

  /** Whether the surfaces, or with { solid: true } the solids, meet. Null: not known. */
  collide(other, matrix = IDENTITY, { solid = false, exact = false } = {}) {
    const hit = this.#with(other, matrix, exact, "web_collide", solid ? 1 : 0);
    return hit === 2 ? null : hit === 1;
  }
  /** All pairs of triangles that overlap, sorted: a triangle of this model, one of the other. */
  overlaps(other, matrix = IDENTITY, { exact = false } = {}) {
    return this.#cdprep.pairs(this.#with(other, matrix, exact, "web_overlaps"));
  }
  /** The distance, as bounds with the nearest triangles and points; null beyond `most`. */
  distance(other, matrix = IDENTITY, { most = Infinity, exact = false } = {}) {
    this.#cdprep.give(...new Array(16).fill(0), most);
    if (this.#with(other, matrix, exact, "web_distance") !== 1) return null;
    const [lower, upper, a, b, ...points] = this.#cdprep.take(10);
    return { lower, upper, triangles: [a, b], points: [points.slice(0, 3), points.slice(3)] };
  }
  /** The first triangle that a ray hits, or null. */
  ray(origin, direction, most = Infinity) {
    if (origin.length !== 3 || direction.length !== 3) {
      throw new CdprepError(2, "The origin and the direction of a ray have 3 numbers each.");
    }
    this.#cdprep.give(...origin, ...direction, most);
    if (this.#cdprep.ask("web_ray", this.#open()) !== 1) return null;
    const [t, triangle, ...point] = this.#cdprep.take(5);
    return { t, triangle, point };
  }
  close() {
    if (this.#model !== 0) this.#cdprep.end(this.#model, this.#bytes);
    this.#model = 0;
  }

  #open() {
    if (this.#model === 0) throw new CdprepError(2, "This model is closed.");
    return this.#model;
  }
  #with(other, matrix, exact, name, ...more) {
    if (!(other instanceof Model) || other.#cdprep !== this.#cdprep) {
      throw new CdprepError(2, "The other argument is not a model of this module.");
    }
    if (matrix.length !== 16) {
      throw new CdprepError(2, `The matrix has ${matrix.length} numbers; 16 are needed.`);
    }
    const models = [this.#open(), other.#open()];
    this.#cdprep.give(...matrix);
    return this.#cdprep.ask(name, ...models, exact ? 0 : TOLERANCE, ...more);
  }
}
