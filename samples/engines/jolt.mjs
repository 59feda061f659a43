// SPDX-License-Identifier: MIT
// A moving body of Jolt from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package jolt-physics 1.1.0. Jolt builds its own hulls from the points. Some
// of its tolerances are metres, and would lose points of small pieces or refuse them. So each hull
// is built some 10 metres large, and scaled down. Bodies much smaller than a metre also need a
// smaller mPenetrationSlop and mSpeculativeContactDistance than those of Jolt.
export function joltBody(Jolt, colliders, density, position, layer) {
    const unit = colliders.metres_per_unit ?? 1;
    const turn = Jolt.Quat.prototype.sIdentity(), p = new Jolt.Vec3(0, 0, 0);
    const compound = new Jolt.StaticCompoundShapeSettings();
    for (const { points } of colliders.pieces) {
        const grow = 10 / points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
        const hull = new Jolt.ConvexHullShapeSettings();
        hull.mHullTolerance = 1e-5;
        for (let i = 0; i < points.length; i += 3) {
            p.Set(grow * points[i], grow * points[i + 1], grow * points[i + 2]);
            hull.mPoints.push_back(p);
        }
        p.Set(unit / grow, unit / grow, unit / grow);
        const scaled = new Jolt.ScaledShapeSettings(hull, p);
        p.Set(0, 0, 0);
        compound.AddShapeShapeSettings(p, turn, scaled, 0);
    }
    const made = compound.Create();
    if (made.HasError()) throw new Error(`${colliders.name}: ${made.GetError().c_str()}`);
    const body = new Jolt.BodyCreationSettings(made.Get(), position, turn,
                                               Jolt.EMotionType_Dynamic, layer);
    if (colliders.mass?.closed) {  // the mass of the mesh; the inertia is that of the pieces
        body.mOverrideMassProperties = Jolt.EOverrideMassProperties_CalculateInertia;
        body.mMassPropertiesOverride.mMass = density * unit ** 3 * colliders.mass.volume;
    }
    return body;
}
