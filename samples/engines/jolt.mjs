// SPDX-License-Identifier: MIT
// A moving body of Jolt from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package jolt-physics 1.1.0. Jolt builds its own hulls from the points. Bodies
// much smaller than a metre also need a smaller mPenetrationSlop and mSpeculativeContactDistance
// than those of Jolt.
import { inMetres, reachOf } from './colliders.mjs';

export function joltBody(Jolt, bodies, colliders, density, position, layer) {
    const { parts, mass, centre, moments, axes } = inMetres(colliders, density);
    const shape = shapeOf(Jolt, parts, centre), upright = new Jolt.Quat(0, 0, 0, 1);
    const settings = new Jolt.BodyCreationSettings(shape, position, upright,
                                                   Jolt.EMotionType_Dynamic, layer);
    settings.mOverrideMassProperties = Jolt.EOverrideMassProperties_CalculateInertia;
    settings.mMassPropertiesOverride.mMass = mass;
    // Jolt takes inertia below some 1e-6 kg m^2 for none, and uses that of a sphere. So the body
    // gets it.
    const body = bodies.CreateBody(settings), inverse = moments.map((x) => 1 / x);
    body.GetMotionProperties().SetInverseInertia(new Jolt.Vec3(...inverse), new Jolt.Quat(...axes));
    return body;
}

/** All parts. Jolt's bodies turn about the centre of mass of their shape, so that is moved. */
function shapeOf(Jolt, parts, centre) {
    const compound = new Jolt.StaticCompoundShapeSettings();
    for (const { points } of parts) addHull(Jolt, compound, points);
    const made = compound.Create();
    if (made.HasError()) throw new Error(`Jolt: ${made.GetError().c_str()}`);
    const at = made.Get().GetCenterOfMass(), own = [at.GetX(), at.GetY(), at.GetZ()];
    const offset = new Jolt.Vec3(...centre.map((x, axis) => x - own[axis]));
    return new Jolt.OffsetCenterOfMassShape(made.Get(), offset);
}

/** Jolt's tolerances are metres, and would lose points of small parts or refuse them. So the hull
 *  is built with coordinates of up to 10 metres, and scaled down. */
function addHull(Jolt, compound, points) {
    const scale = reachOf(points) / 10, p = new Jolt.Vec3(0, 0, 0);
    const hull = new Jolt.ConvexHullShapeSettings();
    for (let i = 0; i < points.length; i += 3) {
        p.Set(points[i] / scale, points[i + 1] / scale, points[i + 2] / scale);
        hull.mPoints.push_back(p);
    }
    const scaled = new Jolt.ScaledShapeSettings(hull, new Jolt.Vec3(scale, scale, scale));
    compound.AddShapeShapeSettings(new Jolt.Vec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), scaled, 0);
}
