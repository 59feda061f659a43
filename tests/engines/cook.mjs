// SPDX-License-Identifier: MIT
// Cooks the parts of `cdprep export --for unity` by PhysX, with its default parameters. Unity cooks
// the mesh of a part as it is stored, and scales what PhysX made of it. Prints as JSON the
// numbers of points given and kept, and of those kept if the parts are cooked in metres instead.
// Usage: node cook.mjs FILE.glb
import { readFileSync } from 'node:fs';
import { Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { createPhysX } from './physx_engine.mjs';

const { PhysX, scale } = await createPhysX();
const params = new PhysX.PxCookingParams(scale);

/** The number of points that PhysX keeps. */
function cooked(points) {
    const list = new PhysX.PxArray_PxVec3(points.length), p = new PhysX.PxVec3();
    points.forEach((point, i) => {
        [p.x, p.y, p.z] = point;
        list.set(i, p);
    });
    const hull = new PhysX.PxConvexMeshDesc();
    hull.flags = new PhysX.PxConvexFlags(PhysX.PxConvexFlagEnum.eCOMPUTE_CONVEX);
    hull.points.count = points.length;
    hull.points.stride = 12;
    hull.points.data = list.begin();
    const mesh = PhysX.PxTopLevelFunctions.prototype.CreateConvexMesh(params, hull);
    return mesh?.ptr ? mesh.getNbVertices() : 0;
}

const bytes = readFileSync(process.argv[2]);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const { scene } = await new GLTFLoader().parseAsync(buffer, '');
const sum = { parts: 0, given: 0, kept: 0, kept_in_metres: 0 };
scene.updateMatrixWorld(true);
scene.traverse((node) => {
    if (!node.isMesh) return;
    const stored = node.geometry.attributes.position, own = [], metres = [], p = new Vector3();
    for (let i = 0; i < stored.count; ++i) {
        own.push(p.fromBufferAttribute(stored, i).toArray());
        metres.push(p.applyMatrix4(node.matrixWorld).toArray());
    }
    sum.parts += 1;
    sum.given += stored.count;
    sum.kept += cooked(own);
    sum.kept_in_metres += cooked(metres);
});
console.log(JSON.stringify(sum));
process.exit(0);
