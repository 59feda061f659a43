// SPDX-License-Identifier: MIT
// A moving body of PhysX from the JSON of `cdprep export NAME.cdp.h5 --for json`.
// Tested with the npm package physx-js-webidl 2.7.3 (PhysX 5.6.1). PhysX cooks its own hulls from
// the points, at most 255 for each. It would drop points nearer to a face than planeTolerance.
export function physxBody(PhysX, physics, colliders, density, material, filter) {
    const unit = colliders.metres_per_unit ?? 1;
    const body = physics.createRigidDynamic(new PhysX.PxTransform(PhysX.PxIDENTITYEnum.PxIdentity));
    const params = new PhysX.PxCookingParams(physics.getTolerancesScale());
    params.planeTolerance = 0;
    for (const { name, points } of colliders.pieces) {
        const list = new PhysX.PxArray_PxVec3(points.length / 3), p = new PhysX.PxVec3();
        for (let i = 0; i < points.length; i += 3) {
            [p.x, p.y, p.z] = points.slice(i, i + 3).map((x) => unit * x);
            list.set(i / 3, p);
        }
        const hull = new PhysX.PxConvexMeshDesc();
        hull.flags = new PhysX.PxConvexFlags(PhysX.PxConvexFlagEnum.eCOMPUTE_CONVEX);
        hull.points.count = points.length / 3;
        hull.points.stride = 12;
        hull.points.data = list.begin();
        const mesh = PhysX.PxTopLevelFunctions.prototype.CreateConvexMesh(params, hull);
        if (!mesh?.ptr) throw new Error(`${colliders.name}: PhysX refuses ${name}`);
        const shape = physics.createShape(new PhysX.PxConvexMeshGeometry(mesh), material, true);
        shape.setSimulationFilterData(filter);
        body.attachShape(shape);
    }
    const masses = PhysX.PxRigidBodyExt.prototype;
    if (colliders.mass?.closed) {  // of the mesh; the inertia is that of the pieces
        const centre = new PhysX.PxVec3(...colliders.mass.centre.map((x) => unit * x));
        masses.setMassAndUpdateInertia(body, density * unit ** 3 * colliders.mass.volume, centre);
    } else {
        masses.updateMassAndInertia(body, density);
    }
    return body;
}
