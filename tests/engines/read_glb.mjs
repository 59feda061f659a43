// SPDX-License-Identifier: MIT
// Reads a GLB file by three.js, builds a BVH of three-mesh-bvh for each mesh, and prints as JSON
// what is there. A ray into the middle of each triangle must hit the mesh.
// Usage: node read_glb.mjs FILE.glb
import { readFileSync } from 'node:fs';
import { DoubleSide, Ray, Triangle, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshBVH } from 'three-mesh-bvh';

const bytes = readFileSync(process.argv[2]);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const { scene } = await new GLTFLoader().parseAsync(buffer, '');
const meshes = [];
scene.traverse((node) => {
    if (!node.isMesh) return;
    const bvh = new MeshBVH(node.geometry), count = bvh.geometry.index.count / 3;
    const position = node.geometry.attributes.position, triangle = new Triangle();
    const middle = new Vector3(), normal = new Vector3();
    let hits = 0, flat = 0;
    for (let i = 0; i < count; ++i) {
        const [a, b, c] = [0, 1, 2].map((k) => bvh.geometry.index.getX(3 * i + k));
        triangle.setFromAttributeAndIndices(position, a, b, c);
        if (triangle.getArea() === 0) { ++flat; continue; }
        triangle.getMidpoint(middle);
        triangle.getNormal(normal);
        const ray = new Ray(middle.clone().addScaledVector(normal, 1), normal.clone().negate());
        if (bvh.raycastFirst(ray, DoubleSide)) ++hits;
    }
    meshes.push({ name: node.name, points: position.count, triangles: count, hits, flat });
});
console.log(JSON.stringify(meshes));
