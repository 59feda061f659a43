// SPDX-License-Identifier: MIT
// A moving body of PhysX from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package physx-js-webidl 2.7.3 (PhysX 5.6.1). PhysX cooks its own hulls from
// the points, at most 255 for each. By default it drops points that stand out by less than 0.0007
// of half the sum of a hull's sides. A half sum below 1 counts as 1, whatever PxTolerancesScale is.
// So hulls smaller than 1 are cooked larger, and scaled down.
import { massOf } from './mass.mjs';

export function physxBody(PhysX, physics, colliders, density, material, filter) {
    const unit = colliders.metres_per_unit ?? 1, mass = massOf(colliders, density);
    const body = physics.createRigidDynamic(new PhysX.PxTransform(PhysX.PxIDENTITYEnum.PxIdentity));
    const params = new PhysX.PxCookingParams(physics.getTolerancesScale());
    for (const { name, points } of colliders.pieces) {
        const scale = Math.min(1, unit * halfSize(points));
        const list = new PhysX.PxArray_PxVec3(points.length / 3), p = new PhysX.PxVec3();
        for (let i = 0; i < points.length; i += 3) {
            [p.x, p.y, p.z] = points.slice(i, i + 3).map((x) => unit / scale * x);
            list.set(i / 3, p);
        }
        const hull = new PhysX.PxConvexMeshDesc();
        hull.flags = new PhysX.PxConvexFlags(PhysX.PxConvexFlagEnum.eCOMPUTE_CONVEX);
        hull.points.count = points.length / 3;
        hull.points.stride = 12;
        hull.points.data = list.begin();
        const mesh = PhysX.PxTopLevelFunctions.prototype.CreateConvexMesh(params, hull);
        if (!mesh?.ptr) throw new Error(`${colliders.name}: PhysX refuses ${name}`);
        const scaled = new PhysX.PxConvexMeshGeometry(mesh, new PhysX.PxMeshScale(scale));
        const shape = physics.createShape(scaled, material, true);
        shape.setSimulationFilterData(filter);
        body.attachShape(shape);
    }
    if (mass) {
        body.setMass(mass.mass);
        body.setMassSpaceInertiaTensor(new PhysX.PxVec3(...mass.moments));
        body.setCMassLocalPose(new PhysX.PxTransform(new PhysX.PxVec3(...mass.centre),
                                                     new PhysX.PxQuat(...mass.axes)));
    } else {
        PhysX.PxRigidBodyExt.prototype.updateMassAndInertia(body, density);
    }
    return body;
}

/** Half the sum of the sides of the box of points. */
function halfSize(points) {
    const sides = [0, 1, 2].map((k) => {
        const values = points.filter((_, i) => i % 3 === k);
        return Math.max(...values) - Math.min(...values);
    });
    return (sides[0] + sides[1] + sides[2]) / 2;
}
