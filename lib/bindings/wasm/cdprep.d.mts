// SPDX-License-Identifier: MIT

/** Three numbers. */
export type Point = [number, number, number];
/** 16 numbers, column by column as in WebGL. */
export type Matrix = ArrayLike<number>;

/** A refused argument or an unreadable file. */
export class CdprepError extends Error {
  /** That of the C API: 2 for an argument, 3 for a file, 5 for memory, 6 for an internal error. */
  readonly code: number;
}

export interface Distance {
  /** Bounds of the exact distance, in model units. */
  lower: number;
  upper: number;
  /** A triangle of each model, and their nearest points, in the frame of the first model. */
  triangles: [number, number];
  points: [Point, Point];
}

export interface RayHit {
  /** In lengths of the direction. */
  t: number;
  triangle: number;
  point: Point;
}

export interface Model {
  readonly triangleCount: number;
  readonly vertexCount: number;
  /** true: solid queries have exact answers. */
  readonly isBalanced: boolean;
  /** 0: not known. */
  readonly metresPerUnit: number;
  readonly box: { lower: Point; upper: Point };
  mesh(): { positions: Float64Array; triangles: Uint32Array };
  collide(other: Model, matrix?: Matrix, options?: { solid?: boolean; exact?: boolean }): boolean | null;
  overlaps(other: Model, matrix?: Matrix, options?: { exact?: boolean }): Uint32Array;
  distance(other: Model, matrix?: Matrix, options?: { most?: number; exact?: boolean }): Distance | null;
  ray(origin: Point, direction: Point, most?: number): RayHit | null;
  /** Frees the memory. The model answers nothing afterwards. */
  close(): void;
}

export interface Cdprep {
  readonly version: { version: string; kernels: string };
  open(bytes: ArrayBuffer | Uint8Array, name?: string): Model;
}

/** Loads the module from the bytes of cdprep.wasm. */
export function load(wasm: BufferSource): Promise<Cdprep>;
