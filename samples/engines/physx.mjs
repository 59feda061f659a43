// SPDX-License-Identifier: MIT
// A moving body of PhysX from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package physx-js-webidl 2.7.3 (PhysX 5.6.1). PhysX cooks its own hulls from
// the points, at most 255 for each.
import { inMetres } from './colliders.mjs';

export function physxBody(PhysX, physics, colliders, density, material, filter) {
    const { parts, mass, centre, moments, axes } = inMetres(colliders, density);
    const body = physics.createRigidDynamic(new PhysX.PxTransform(PhysX.PxIDENTITYEnum.PxIdentity));
    for (const part of parts) {
        const shape = physics.createShape(hullOf(PhysX, physics, part), material, true);
        shape.setSimulationFilterData(filter);
        body.attachShape(shape);
    }
    body.setMass(mass);
    body.setMassSpaceInertiaTensor(new PhysX.PxVec3(...moments));
    body.setCMassLocalPose(new PhysX.PxTransform(new PhysX.PxVec3(...centre),
                                                 new PhysX.PxQuat(...axes)));
    return body;
}

/** By default PhysX drops points that stand out by less than 0.0007 of half the sum of a hull's
 *  sides. A half sum below 1 counts as 1, whatever PxTolerancesScale is. So smaller hulls are
 *  cooked larger, and scaled down. */
function hullOf(PhysX, physics, { name, points }) {
    const scale = Math.min(1, halfSize(points));
    const list = new PhysX.PxArray_PxVec3(points.length / 3), p = new PhysX.PxVec3();
    for (let i = 0; i < points.length; i += 3) {
        [p.x, p.y, p.z] = points.slice(i, i + 3).map((x) => x / scale);
        list.set(i / 3, p);
    }
    const hull = new PhysX.PxConvexMeshDesc();
    hull.flags = new PhysX.PxConvexFlags(PhysX.PxConvexFlagEnum.eCOMPUTE_CONVEX);
    hull.points.count = points.length / 3;
    hull.points.stride = 12;
    hull.points.data = list.begin();
    const params = new PhysX.PxCookingParams(physics.getTolerancesScale());
    const mesh = PhysX.PxTopLevelFunctions.prototype.CreateConvexMesh(params, hull);
    if (!mesh?.ptr) throw new Error(`PhysX refuses ${name}`);
    return new PhysX.PxConvexMeshGeometry(mesh, new PhysX.PxMeshScale(scale));
}

/** Half the sum of the sides of the box of points. */
function halfSize(points) {
    const sides = [0, 1, 2].map((k) => {
        const values = points.filter((_, i) => i % 3 === k);
        return Math.max(...values) - Math.min(...values);
    });
    return (sides[0] + sides[1] + sides[2]) / 2;
}
