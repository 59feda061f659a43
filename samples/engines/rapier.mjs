// SPDX-License-Identifier: MIT
// A moving body of Rapier from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package @dimforge/rapier3d-compat 0.21.0. Rapier builds its own hulls from
// the points. convexMesh(points, triangles) would take the hulls as they are, and is faster.
import { inMetres } from './colliders.mjs';

export function rapierBody(RAPIER, world, colliders, density) {
    const { parts, mass, centre, moments, axes } = inMetres(colliders, density);
    const vector = ([x, y, z, w]) => ({ x, y, z, w });
    const body = world.createRigidBody(RAPIER.RigidBodyDesc.dynamic().setAdditionalMassProperties(
        mass, vector(centre), vector(moments), vector(axes)));
    for (const { name, points } of parts) {
        const shape = RAPIER.ColliderDesc.convexHull(Float32Array.from(points));
        if (!shape) throw new Error(`Rapier refuses ${name}`);
        world.createCollider(shape.setDensity(0), body);
    }
    return body;
}
