// SPDX-License-Identifier: MIT
// Drops a body onto the floor z = 0 for two seconds in one engine, through the loaders of
// samples/engines. Prints what became of it as JSON. engines.py copies this beside the packages.
//
// Usage: node drop.mjs ENGINE COLLIDERS.json MODEL.mjcf X Y Z QX QY QZ QW
// where the body starts; only MuJoCo reads the MJCF file, and not the colliders.
import { readFileSync } from 'node:fs';
import { createPhysX, packaged } from './physx_engine.mjs';

const DENSITY = 1000, GRAVITY = -9.81, SECONDS = 2, STEP = 1 / 240;
const SLOP = 0.002;  // metres: of Jolt
const HALF = [50, 50, 1];  // the floor's box, in metres
const DOWN = [0, 0, -HALF[2]], UPRIGHT = [0, 0, 0, 1];

const list = (v) => [v.x, v.y, v.z];

/** The number of different points in a flat list. */
function different(flat) {
    const seen = new Set();
    for (let i = 0; i < flat.length; i += 3) seen.add(flat.subarray(i, i + 3).join(' '));
    return seen.size;
}

/** The tensor of principal moments, whose axes a quaternion x, y, z, w turns into the model. */
function tensor(moments, [x, y, z, w]) {
    const r = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
               [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
               [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]];
    const of = (i, j) => moments.reduce((sum, m, k) => sum + r[i][k] * m * r[j][k], 0);
    return [0, 1, 2].map((i) => [0, 1, 2].map((j) => of(i, j)));
}

// Each engine returns the points that it keeps, and the body's mass, centre and inertia in the
// model. It also returns how to make a step, and the state: position, quaternion and velocities.

async function jolt(colliders, start, turn) {
    const { joltBody } = await import('./jolt.mjs');
    const Jolt = await (await import('jolt-physics')).default();
    const settings = new Jolt.JoltSettings();
    const pairs = new Jolt.ObjectLayerPairFilterTable(2);
    pairs.EnableCollision(0, 1);
    const layers = new Jolt.BroadPhaseLayerInterfaceTable(2, 2);
    for (const i of [0, 1]) layers.MapObjectToBroadPhaseLayer(i, new Jolt.BroadPhaseLayer(i));
    settings.mObjectLayerPairFilter = pairs;
    settings.mBroadPhaseLayerInterface = layers;
    settings.mObjectVsBroadPhaseLayerFilter =
        new Jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 2, pairs, 2);
    const engine = new Jolt.JoltInterface(settings), system = engine.GetPhysicsSystem();
    system.SetGravity(new Jolt.Vec3(0, 0, GRAVITY));
    const physics = system.GetPhysicsSettings();  // 0.02 by default, for bodies of a metre
    physics.mPenetrationSlop = physics.mSpeculativeContactDistance = SLOP;
    system.SetPhysicsSettings(physics);
    const bodies = system.GetBodyInterface(), upright = new Jolt.Quat(...UPRIGHT);
    const floor = new Jolt.BoxShape(new Jolt.Vec3(...HALF));
    bodies.CreateAndAddBody(
        new Jolt.BodyCreationSettings(floor, new Jolt.RVec3(...DOWN), upright,
                                      Jolt.EMotionType_Static, 0),
        Jolt.EActivation_DontActivate);
    const place = new Jolt.RVec3(...start);
    const body = joltBody(Jolt, bodies, colliders, DENSITY, place, 1);
    bodies.SetPositionAndRotation(body.GetID(), place, new Jolt.Quat(...turn),
                                  Jolt.EActivation_DontActivate);
    bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
    // Jolt does not list the points of a hull, but the triangles of a shape.
    let kept = 0, shape = body.GetShape();
    if (shape.GetSubType() === Jolt.EShapeSubType_OffsetCenterOfMass) {
        shape = Jolt.castObject(shape, Jolt.OffsetCenterOfMassShape).GetInnerShape();
    }
    const compound = Jolt.castObject(shape, Jolt.StaticCompoundShape);
    const is_compound = shape.GetSubType() === Jolt.EShapeSubType_StaticCompound;
    for (let i = 0; i < (is_compound ? compound.GetNumSubShapes() : 1); ++i) {
        const hull = is_compound ? compound.GetSubShape(i).mShape : shape;
        const all = new Jolt.ShapeGetTriangles(hull, Jolt.AABox.prototype.sBiggest(),
                                               new Jolt.Vec3(0, 0, 0), upright,
                                               new Jolt.Vec3(1, 1, 1));
        const at = all.GetVerticesData() / 4;
        kept += different(Jolt.HEAPF32.subarray(at, at + all.GetVerticesSize() / 4));
    }
    const of = (v) => [v.GetX(), v.GetY(), v.GetZ()], motion = body.GetMotionProperties();
    const axes = motion.GetInertiaRotation(), q = [...of(axes), axes.GetW()];
    return {
        kept, mass: 1 / motion.GetInverseMass(), centre: of(body.GetShape().GetCenterOfMass()),
        inertia: tensor(of(motion.GetInverseInertiaDiagonal()).map((x) => 1 / x), q),
        step: () => engine.Step(STEP, 1),
        state: () => {
            const q = body.GetRotation();
            return [of(body.GetPosition()), [...of(q), q.GetW()], of(body.GetLinearVelocity()),
                    of(body.GetAngularVelocity())];
        },
    };
}

async function physx(colliders, start, turn) {
    const { physxBody } = await import('./physx.mjs');
    const { PhysX, physics, scale, top } = await createPhysX();
    const description = new PhysX.PxSceneDesc(scale);
    description.gravity = new PhysX.PxVec3(0, 0, GRAVITY);
    description.cpuDispatcher = top.DefaultCpuDispatcherCreate(0);
    description.filterShader = top.DefaultFilterShader();
    const scene = physics.createScene(description), filter = new PhysX.PxFilterData(1, 1, 0, 0);
    const material = physics.createMaterial(0.5, 0.5, 0);
    const at = (p, q) => new PhysX.PxTransform(new PhysX.PxVec3(...p), new PhysX.PxQuat(...q));
    const floor = physics.createRigidStatic(at(DOWN, UPRIGHT));
    const box = physics.createShape(new PhysX.PxBoxGeometry(...HALF), material, true);
    box.setSimulationFilterData(filter);
    floor.attachShape(box);
    scene.addActor(floor);
    const body = physxBody(PhysX, physics, colliders, DENSITY, material, filter);
    body.setGlobalPose(at(start, turn), true);
    scene.addActor(body);
    let kept = 0;
    for (let i = 0; i < body.getNbShapes(); ++i) {
        const shape = PhysX.SupportFunctions.prototype.PxActor_getShape(body, i);
        const hull = PhysX.castObject(shape.getGeometry(), PhysX.PxConvexMeshGeometry);
        kept += hull.convexMesh.getNbVertices();
    }
    const centre = body.getCMassLocalPose();
    return {
        kept, mass: body.getMass(), centre: list(centre.p),
        inertia: tensor(list(body.getMassSpaceInertiaTensor()), [...list(centre.q), centre.q.w]),
        step: () => { scene.simulate(STEP); scene.fetchResults(true); },
        state: () => {
            const { p, q } = body.getGlobalPose();
            return [list(p), [...list(q), q.w], list(body.getLinearVelocity()),
                    list(body.getAngularVelocity())];
        },
    };
}

async function rapier(colliders, start, turn) {
    const { rapierBody } = await import('./rapier.mjs');
    const RAPIER = (await import('@dimforge/rapier3d-compat')).default;
    await RAPIER.init();
    const world = new RAPIER.World({ x: 0, y: 0, z: GRAVITY });
    world.timestep = STEP;
    world.createCollider(RAPIER.ColliderDesc.cuboid(...HALF).setTranslation(...DOWN));
    const body = rapierBody(RAPIER, world, colliders, DENSITY);
    body.setTranslation({ x: start[0], y: start[1], z: start[2] }, true);
    body.setRotation({ x: turn[0], y: turn[1], z: turn[2], w: turn[3] }, true);
    body.recomputeMassPropertiesFromColliders();
    let kept = 0;
    for (let i = 0; i < body.numColliders(); ++i) kept += body.collider(i).vertices().length / 3;
    const axes = body.principalInertiaLocalFrame();
    return {
        kept, mass: body.mass(), centre: list(body.localCom()),
        inertia: tensor(list(body.principalInertia()), [...list(axes), axes.w]),
        step: () => world.step(),
        state: () => [list(body.translation()), [...list(body.rotation()), body.rotation().w],
                      list(body.linvel()), list(body.angvel())],
    };
}

async function havok(colliders, start, turn) {
    const { havokBody } = await import('./havok.mjs');
    const hp = await (await import('@babylonjs/havok')).default(
        { wasmBinary: packaged('@babylonjs/havok/lib/esm/HavokPhysics.wasm') });
    const world = hp.HP_World_Create()[1], floor = hp.HP_Body_Create()[1];
    hp.HP_World_SetGravity(world, [0, 0, GRAVITY]);
    hp.HP_World_SetIdealStepTime(world, STEP);
    hp.HP_Body_SetShape(floor,
                        hp.HP_Shape_CreateBox(DOWN, UPRIGHT, HALF.map((x) => 2 * x))[1]);
    hp.HP_World_AddBody(world, floor, false);
    const body = havokBody(hp, colliders, DENSITY);
    hp.HP_Body_SetQTransform(body, [start, turn]);
    hp.HP_World_AddBody(world, body, false);
    // Havok does not list the points of a hull, but the triangles that it displays.
    const geometry = hp.HP_Shape_CreateDebugDisplayGeometry(hp.HP_Body_GetShape(body)[1])[1];
    const [at, count] = hp.HP_DebugGeometry_GetInfo(geometry)[1];
    const [centre, mass, moments, axes] = hp.HP_Body_GetMassProperties(body)[1];
    return {
        kept: different(new Float32Array(hp.HEAPU8.buffer, at, 3 * count)), mass, centre,
        inertia: tensor(moments.map((x) => mass * x), axes),
        step: () => hp.HP_World_Step(world, STEP),
        state: () => [...hp.HP_Body_GetQTransform(body)[1], hp.HP_Body_GetLinearVelocity(body)[1],
                      hp.HP_Body_GetAngularVelocity(body)[1]],
    };
}

/** The MJCF file has a body with a free joint, and the floor. */
async function mujoco(colliders, start, [x, y, z, w], mjcf) {
    const mj = await (await import('@mujoco/mujoco')).default();
    const model = mj.MjModel.from_xml_string(readFileSync(mjcf, 'utf8'));
    const data = new mj.MjData(model);
    data.qpos.set([...start, w, x, y, z]);
    let kept = 0;
    for (const place of model.mesh_graphadr) kept += place < 0 ? 0 : model.mesh_graph[place];
    const [iw, ix, iy, iz] = model.body_iquat.slice(4, 8);
    return {
        centre: Array.from(model.body_ipos.slice(3, 6)),
        inertia: tensor(Array.from(model.body_inertia.slice(3, 6)), [ix, iy, iz, iw]),
        kept, given: Array.from(model.mesh_vertnum).reduce((sum, n) => sum + n, 0),
        mass: model.body_mass[1], parts: model.mesh_graphadr.length,
        steps: Math.round(SECONDS / model.opt.timestep),
        step: () => mj.mj_step(model, data),
        state: () => {
            const q = Array.from(data.qpos), v = Array.from(data.qvel);
            return [q.slice(0, 3), [...q.slice(4), q[3]], v.slice(0, 3), v.slice(3)];
        },
    };
}

async function main() {
    const [engine, file, mjcf, ...numbers] = process.argv.slice(2);
    const colliders = JSON.parse(readFileSync(file, 'utf8'));
    const start = numbers.slice(0, 3).map(Number), turn = numbers.slice(3).map(Number);
    const engines = { jolt, physx, rapier, havok, mujoco };
    const body = await engines[engine](colliders, start, turn, mjcf);
    let isFinite = true;
    for (let i = 0; i < (body.steps ?? SECONDS / STEP); ++i) {
        body.step();
        isFinite = isFinite && body.state().flat().every(Number.isFinite);
    }
    const [position, quaternion, velocity, spin] = body.state();
    const points = colliders.parts.reduce((sum, part) => sum + part.points.length / 3, 0);
    console.log(JSON.stringify({
        parts: body.parts ?? colliders.parts.length, given: body.given ?? points,
        kept: body.kept, mass: body.mass, centre: body.centre, inertia: body.inertia,
        is_finite: isFinite, position, quaternion,
        speed: Math.hypot(...velocity), spin: Math.hypot(...spin),
    }));
    process.exit(0);  // some engines leave timers behind
}

await main();
