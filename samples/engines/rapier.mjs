// SPDX-License-Identifier: MIT
// A moving body of Rapier from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package @dimforge/rapier3d-compat 0.21.0. Rapier builds its own hulls from
// the points. convexMesh(points, triangles) would take the hulls as they are, and is faster.
import { massOf } from './mass.mjs';

export function rapierBody(RAPIER, world, colliders, density) {
    const unit = colliders.metres_per_unit ?? 1, mass = massOf(colliders, density);
    const vector = ([x, y, z]) => ({ x, y, z });
    const description = RAPIER.RigidBodyDesc.dynamic();
    if (mass) {
        const [x, y, z, w] = mass.axes;
        description.setAdditionalMassProperties(mass.mass, vector(mass.centre),
                                                vector(mass.moments), { x, y, z, w });
    }
    const body = world.createRigidBody(description);
    for (const { name, points } of colliders.pieces) {
        const shape = RAPIER.ColliderDesc.convexHull(Float32Array.from(points, (x) => unit * x));
        if (!shape) throw new Error(`${colliders.name}: Rapier refuses ${name}`);
        shape.setDensity(mass ? 0 : density);
        world.createCollider(shape, body);
    }
    return body;
}
