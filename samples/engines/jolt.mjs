// SPDX-License-Identifier: MIT
// A moving body of Jolt from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package jolt-physics 1.1.0. Jolt builds its own hulls from the points. Its
// tolerances are metres, and would lose points of small pieces or refuse them. So each hull is
// built with coordinates of up to 10 metres, and scaled down. Bodies much smaller than a metre also
// need a smaller mPenetrationSlop and mSpeculativeContactDistance than those of Jolt. It takes
// inertia below some 1e-6 kg m^2 for none, and uses that of a sphere: so the body gets it.
import { massOf } from './mass.mjs';

export function joltBody(Jolt, bodies, colliders, density, position, layer) {
    const unit = colliders.metres_per_unit ?? 1, mass = massOf(colliders, density);
    const turn = Jolt.Quat.prototype.sIdentity(), p = new Jolt.Vec3(0, 0, 0);
    const compound = new Jolt.StaticCompoundShapeSettings();
    for (const { points } of colliders.pieces) {
        const grow = 10 / points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
        const hull = new Jolt.ConvexHullShapeSettings();
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
    let shape = made.Get();
    if (mass) {  // Jolt's bodies turn about the centre of mass of their shape
        const at = shape.GetCenterOfMass(), [x, y, z] = mass.centre;
        p.Set(x - at.GetX(), y - at.GetY(), z - at.GetZ());
        shape = new Jolt.OffsetCenterOfMassShape(shape, p);
    }
    const settings = new Jolt.BodyCreationSettings(shape, position, turn,
                                                   Jolt.EMotionType_Dynamic, layer);
    if (mass) {
        settings.mOverrideMassProperties = Jolt.EOverrideMassProperties_CalculateInertia;
        settings.mMassPropertiesOverride.mMass = mass.mass;
    }
    const body = bodies.CreateBody(settings);
    if (mass) {
        p.Set(...mass.moments.map((x) => 1 / x));
        body.GetMotionProperties().SetInverseInertia(p, new Jolt.Quat(...mass.axes));
    }
    return body;
}
