// SPDX-License-Identifier: MIT
// A moving body of Rapier from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package @dimforge/rapier3d-compat 0.21.0. convexMesh() takes the triangles
// as they are, and merges only what lies in one plane. convexHull() would build hulls again.
export function rapierBody(RAPIER, world, colliders, density) {
    const unit = colliders.metres_per_unit ?? 1;
    const body = world.createRigidBody(RAPIER.RigidBodyDesc.dynamic());
    const ofPieces = colliders.pieces.reduce((sum, piece) => sum + piece.volume, 0);
    const volume = colliders.mass?.closed ? colliders.mass.volume : ofPieces;
    for (const piece of colliders.pieces) {
        const points = Float32Array.from(piece.points, (x) => unit * x);
        const shape = RAPIER.ColliderDesc.convexMesh(points, Uint32Array.from(piece.triangles));
        if (!shape) throw new Error(`${colliders.name}: Rapier refuses ${piece.name}`);
        shape.setMass(density * unit ** 3 * volume * piece.volume / ofPieces);
        world.createCollider(shape, body);
    }
    return body;
}
