// SPDX-License-Identifier: MIT
// A moving body of Havok from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package @babylonjs/havok 1.3.14. Havok builds its own hulls from the points.
// It joins points that are some millimetres apart, so hulls are built large and scaled down. It
// leaves a gap under bodies that are scaled by less than about a thousandth.
import { massOf } from './mass.mjs';

export function havokBody(havok, colliders, density) {
    const unit = colliders.metres_per_unit ?? 1, mass = massOf(colliders, density);
    const container = havok.HP_Shape_CreateContainer()[1];
    for (const piece of colliders.pieces) {
        const size = unit * piece.points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
        const scale = Math.max(size / 50, 0.002);
        const points = Float32Array.from(piece.points, (x) => unit / scale * x);
        const room = havok._malloc(points.byteLength);
        new Float32Array(havok.HEAPU8.buffer, room, points.length).set(points);
        const [code, hull] = havok.HP_Shape_CreateConvexHull(room, points.length / 3);
        havok._free(room);
        if (code !== havok.Result.RESULT_OK) throw new Error(`Havok refuses ${piece.name}`);
        havok.HP_Shape_AddChild(container, hull, [[0, 0, 0], [0, 0, 0, 1], [scale, scale, scale]]);
    }
    const body = havok.HP_Body_Create()[1];
    havok.HP_Body_SetShape(body, container);
    havok.HP_Body_SetMotionType(body, havok.MotionType.DYNAMIC);
    const ofPieces = havok.HP_Shape_BuildMassProperties(container)[1];
    havok.HP_Body_SetMassProperties(
        body, mass ? [mass.centre, mass.mass, mass.moments.map((x) => x / mass.mass), mass.axes]
                   : ofPieces);  // the inertia is for a mass of 1
    return body;
}
