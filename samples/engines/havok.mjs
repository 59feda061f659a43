// SPDX-License-Identifier: MIT
// A moving body of Havok from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package @babylonjs/havok 1.3.14. Havok builds its own hulls from the points.
import { inMetres, reachOf } from './colliders.mjs';

export function havokBody(havok, colliders, density) {
    const { parts, mass, centre, moments, axes } = inMetres(colliders, density);
    const body = havok.HP_Body_Create()[1], container = havok.HP_Shape_CreateContainer()[1];
    for (const part of parts) addHull(havok, container, part);
    havok.HP_Body_SetShape(body, container);
    havok.HP_Body_SetMotionType(body, havok.MotionType.DYNAMIC);
    const inertia = moments.map((x) => x / mass);  // for a mass of 1
    havok.HP_Body_SetMassProperties(body, [centre, mass, inertia, axes]);
    return body;
}

/** Havok joins points that are some millimetres apart, so the hull is built large and scaled down.
 *  It leaves a gap under bodies that are scaled by less than about a thousandth. */
function addHull(havok, container, { name, points }) {
    const scale = Math.max(reachOf(points) / 50, 0.002);
    const room = havok._malloc(4 * points.length);
    new Float32Array(havok.HEAPU8.buffer, room, points.length).set(points.map((x) => x / scale));
    const [code, hull] = havok.HP_Shape_CreateConvexHull(room, points.length / 3);
    havok._free(room);
    if (code !== havok.Result.RESULT_OK) throw new Error(`Havok refuses ${name}`);
    havok.HP_Shape_AddChild(container, hull, [[0, 0, 0], [0, 0, 0, 1], [scale, scale, scale]]);
}
