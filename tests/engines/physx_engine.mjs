// SPDX-License-Identifier: MIT
// PhysX in node, for drop.mjs and cook.mjs.
import { readFileSync } from 'node:fs';

/** The bytes of a file of a package. */
export const packaged = (name) => readFileSync(new URL(`node_modules/${name}`, import.meta.url));

/** The package is built for browsers: it looks for a window, and refuses to run in node. */
export async function createPhysX() {
    const versions = Object.getOwnPropertyDescriptor(process, 'versions');
    globalThis.window = globalThis;
    Object.defineProperty(process, 'versions', { value: {}, configurable: true });
    const PhysX = await (await import('physx-js-webidl')).default(
        { wasmBinary: packaged('physx-js-webidl/physx-js-webidl.wasm') });
    Object.defineProperty(process, 'versions', versions);
    const top = PhysX.PxTopLevelFunctions.prototype, scale = new PhysX.PxTolerancesScale();
    const foundation = top.CreateFoundation(PhysX.PHYSICS_VERSION, new PhysX.PxDefaultAllocator(),
                                            new PhysX.PxDefaultErrorCallback());
    const physics = top.CreatePhysics(PhysX.PHYSICS_VERSION, foundation, scale);
    return { PhysX, physics, scale, top };
}
