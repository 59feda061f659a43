// SPDX-License-Identifier: MIT
// The files are read by the importing child.
#include "scene_file/gltf_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene_file/compile_scene.h"
#include "support/scratch_folder.h"

namespace cdprep::scenes {
namespace {

/// A document with the meshes 0 and 1, of a triangle each.
std::string gltf_text(const std::string& nodes, const std::string& shared = "{}") {
    const std::string accessor = R"("componentType":5126,"count":3,"type":"VEC3"})";
    return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_physics_rigid_bodies"],)"
           R"("extensions":{"KHR_physics_rigid_bodies":)" +
           shared + R"(},"nodes":[)" + nodes +
           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},)"
           R"({"primitives":[{"attributes":{"POSITION":1}}]}],"accessors":[{"bufferView":0,)" +
           accessor + R"(,{"bufferView":0,"byteOffset":12,)" + accessor +
           R"(],"bufferViews":[{"buffer":0,"byteLength":48}],"buffers":[{"byteLength":48,)"
           R"("uri":"data:application/octet-stream;base64,)"
           R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"}]})";
}

GltfReading read_gltf_text(const std::string& text, const import::ImportOptions& options = {}) {
    const test::ScratchFolder folder;
    return read_gltf_scene(folder.write("a.gltf", text), options);
}

GltfReading read_nodes(const std::string& nodes, const std::string& shared = "{}",
                       const import::ImportOptions& options = {}) {
    GltfReading reading = read_gltf_text(gltf_text(nodes, shared), options);
    for (const Error& error : reading.errors) ADD_FAILURE() << error.message;
    if (!reading.assembly) throw std::runtime_error("no scene");
    return reading;
}

/// A node with members before its extension, which has `physics`.
std::string node(const std::string& members, const std::string& physics) {
    return R"({"mesh":0,)" + members + R"("extensions":{"KHR_physics_rigid_bodies":{)" + physics +
           "}}}";
}

const std::string kCollider = R"("collider":{"geometry":{"mesh":0}})";
const std::string kTrigger = R"("trigger":{"geometry":{"mesh":0}})";
const std::string kMotion = R"("motion":{},)";
const std::string kKinematic = R"("motion":{"isKinematic":true,"linearVelocity":[0,0,2],)"
                               R"("angularVelocity":[0,1,0]},)";

std::string collider_in(int filter) {
    return R"("collider":{"geometry":{"mesh":0},"collisionFilter":)" + std::to_string(filter) + "}";
}

/// Whether a finding has these words, after the name of the file.
bool has_finding(const GltfReading& reading, const std::string& words) {
    return std::ranges::any_of(reading.findings, [&](const std::string& finding) {
        return finding.find(": " + words) != std::string::npos;
    });
}

struct NamedPair {
    std::string a, b;
    Ask effects;
    auto operator<=>(const NamedPair&) const = default;
};

std::vector<NamedPair> pairs_of(const SceneFile& scene) {
    std::vector<NamedPair> pairs;
    for (const AskedPair& pair : scene.pairs) {
        pairs.push_back(
            {scene.layers[pair.asked.a], scene.layers[pair.asked.b], pair.asked.effects});
        EXPECT_EQ(pair.asked.body == Body::solid, contains(pair.asked.effects, Ask::collide));
        EXPECT_TRUE(pair.tells_begins && pair.tells_ends);
    }
    return pairs;
}

TEST(GltfScene, FiltersBecomeLayers) {
    const GltfReading reading = read_nodes(
        node(R"("name":"ground",)", collider_in(0)) + "," +
            node(R"("name":"car",)", kMotion + collider_in(1)) + "," +
            node(R"("name":"van",)", kMotion + collider_in(2)) + "," +
            node(R"("name":"bird",)", kMotion + collider_in(3)) + "," +
            node(R"("name":"gate",)", R"("trigger":{"geometry":{"mesh":0},"collisionFilter":4})") +
            R"(,{"mesh":1,"name":"picture"})",
        R"({"collisionFilters":[{"collisionSystems":["land"]},)"
        R"({"collisionSystems":["cars"],"notCollideWithSystems":["birds"]},)"
        R"({"collisionSystems":["cars"],"notCollideWithSystems":["birds"]},)"
        R"({"collisionSystems":["birds"],"notCollideWithSystems":["land"]},)"
        R"({"collisionSystems":["gates"],"collideWithSystems":["cars"]}]})");
    const SceneFile& scene = reading.assembly->scene;
    EXPECT_EQ(scene.layers, (std::vector<std::string>{"colliders of land", "bodies of cars",
                                                      "bodies of birds", "triggers of gates"}));
    std::vector<std::string> names;
    std::vector<std::uint32_t> layers;
    for (const FileObject& object : scene.objects) {
        names.push_back(object.name);
        layers.push_back(object.layer);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"ground", "car", "van", "bird", "gate"}));
    EXPECT_EQ(layers, (std::vector<std::uint32_t>{0, 1, 1, 2, 3}));
    EXPECT_EQ(pairs_of(scene),
              (std::vector<NamedPair>{{"colliders of land", "bodies of cars", Ask::response},
                                      {"bodies of cars", "bodies of cars", Ask::response},
                                      {"bodies of cars", "triggers of gates", Ask::collide},
                                      {"bodies of birds", "bodies of birds", Ask::response}}));
    EXPECT_TRUE(scene.has_pairs);
    EXPECT_TRUE(has_finding(reading,
                            "ignored: a node with triangles but without a collider or "
                            "trigger (/nodes/5)."));
    ASSERT_EQ(scene.models.size(), 1u);
    EXPECT_EQ(reading.assembly->models.size(), 1u);
    EXPECT_EQ(reading.assembly->models[0][0].node, 0u);
}

TEST(GltfScene, ASurfaceMayBeColliderAndTrigger) {
    const GltfReading reading =
        read_nodes(node("", kCollider + "," + kTrigger) + "," + node("", kMotion + kCollider) +
                   "," + node("", kTrigger));
    EXPECT_EQ(
        pairs_of(reading.assembly->scene),
        (std::vector<NamedPair>{{"colliders and triggers", "colliders and triggers", Ask::collide},
                                {"colliders and triggers", "bodies", Ask::response | Ask::collide},
                                {"colliders and triggers", "triggers", Ask::collide},
                                {"bodies", "bodies", Ask::response},
                                {"bodies", "triggers", Ask::collide}}));
}

// A static or kinematic collider pushes no other one.
TEST(GltfScene, TriggersAloneNeedNoResponse) {
    const GltfReading reading =
        read_nodes(node("", kCollider) + "," + node("", kKinematic + kCollider) + "," +
                   node(R"("name":"gate",)", kTrigger));
    SceneFile scene = reading.assembly->scene;
    EXPECT_EQ(pairs_of(scene), (std::vector<NamedPair>{{"colliders", "triggers", Ask::collide}}));
    EXPECT_FALSE(scene.dynamics.gravity);
    EXPECT_EQ(scene.step_s, 1.0 / 60);
    EXPECT_EQ(scene.duration_s, 1);
    EXPECT_EQ(scene.metres_per_unit, 1);
    EXPECT_TRUE(has_finding(reading,
                            "assumed: a step is 1/60 s, and a run takes 1 s without "
                            "--frames or --until."));
    EXPECT_FALSE(has_finding(reading, "assumed: gravity"));
    EXPECT_FALSE(has_finding(reading, "friction"));
    EXPECT_TRUE(compile_scene(scene, {.objects = 3, .pairs = 1}).plan);
}

// By hand: a quarter turn about z maps x to y. The node's scale changes no velocity.
TEST(GltfScene, ABodyHasItsVelocitiesInTheWorld) {
    const std::string turned =
        R"("rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[2,3,4],)";
    const std::string motion = R"("motion":{"mass":3,"linearVelocity":[6,0,0],)"
                               R"("angularVelocity":[0,5,1]},)";
    const std::string material = R"("collider":{"geometry":{"mesh":0},"physicsMaterial":0})";
    const std::string shared = R"({"physicsMaterials":[{"dynamicFriction":0.2,)"
                               R"("staticFriction":0.2,"restitution":0.75}]})";
    for (const double unit : {1.0, 0.001}) {
        import::ImportOptions options;
        options.metres_per_unit = unit;
        const GltfReading reading = read_nodes(node(turned, motion + material), shared, options);
        const SceneFile& scene = reading.assembly->scene;
        ASSERT_EQ(scene.bodies.size(), 1u);
        EXPECT_EQ(scene.objects.at(0).body, 0u);
        EXPECT_EQ(scene.objects[0].material, (Material{.friction = 0.2, .restitution = 0.75}));
        const BodyMotion& body = scene.bodies[0];
        EXPECT_EQ(body.mass, 3);
        EXPECT_NEAR(body.velocity.x, 0, 1e-12 / unit);
        EXPECT_NEAR(body.velocity.y, 6 / unit, 1e-12 / unit);
        EXPECT_NEAR(body.velocity.z, 0, 1e-12 / unit);
        EXPECT_NEAR(body.turn.x, -5, 1e-12);
        EXPECT_NEAR(body.turn.y, 0, 1e-12);
        EXPECT_NEAR(body.turn.z, 1, 1e-12);
        ASSERT_TRUE(scene.dynamics.gravity);
        EXPECT_NEAR(scene.dynamics.gravity->y, -9.81 / unit, 1e-9);
        EXPECT_EQ(scene.dynamics.gravity->x, 0);
        EXPECT_EQ(scene.dynamics.gravity->z, 0);
        EXPECT_EQ(scene.metres_per_unit, unit);
        EXPECT_TRUE(has_finding(reading, "assumed: gravity is 9.81 m/s^2 along -y."));
        EXPECT_FALSE(has_finding(reading, "ignored"));
    }
}

TEST(GltfScene, GravityIsAgainstTheChosenAxis) {
    import::ImportOptions options;
    options.up_axis = format::UpAxis::z;
    const GltfReading reading = read_nodes(node("", kMotion + kCollider), "{}", options);
    EXPECT_EQ(reading.assembly->scene.dynamics.gravity, (Double3{0, 0, -9.81}));
    EXPECT_EQ(reading.assembly->scene.objects.at(0).material.friction, 0.6);
    EXPECT_TRUE(
        has_finding(reading, "assumed: a collider without a material has a friction of 0.6."));
    EXPECT_TRUE(has_finding(reading, "assumed: a body without a mass has the density of water."));
    EXPECT_TRUE(has_finding(reading, "assumed: gravity is 9.81 m/s^2 along -z."));
    EXPECT_FALSE(reading.assembly->scene.y_is_up);
    EXPECT_TRUE(read_nodes(node("", kMotion + kCollider), "{}", {}).assembly->scene.y_is_up);
}

TEST(GltfScene, TheColliderOfABodyMayBeBelowItsMotion) {
    const GltfReading reading =
        read_nodes(R"({"name":"car","children":[1],"extensions":{"KHR_physics_rigid_bodies":)"
                   R"({"motion":{"mass":7}}}},)" +
                   node(R"("name":"hull","translation":[0,0,1],)", kCollider) + R"(,{"mesh":0})");
    const SceneFile& scene = reading.assembly->scene;
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].name, "car/hull");
    ASSERT_EQ(scene.bodies.size(), 1u);
    EXPECT_EQ(scene.bodies[0].mass, 7);
}

// A motion below another one is a body of its own.
TEST(GltfScene, SomeBodiesAreNotTaken) {
    const std::string at = "/extensions/KHR_physics_rigid_bodies/";
    const GltfReading reading =
        read_nodes(node(R"("children":[1,2],)", kMotion + kCollider) + "," +
                   node("", kCollider + "," + kTrigger) + "," + node("", kMotion + kCollider) +
                   "," + node("", kMotion + kTrigger) +
                   R"(,{"extensions":{"KHR_physics_rigid_bodies":{"motion":{}}}},)" +
                   node(R"("children":[6],)", kMotion + kCollider) + "," + node("", kTrigger) +
                   "," + node(R"("scale":[0,0,0],)", kCollider));
    const SceneFile& scene = reading.assembly->scene;
    EXPECT_EQ(scene.bodies.size(), 2u);
    std::vector<bool> are_bodies;
    for (const FileObject& object : scene.objects) are_bodies.push_back(object.body != kNoBody);
    EXPECT_EQ(are_bodies, (std::vector<bool>{false, false, true, false, true, false}));
    EXPECT_TRUE(has_finding(reading,
                            "ignored: a body of several colliders that differ in filter or "
                            "material, or whose node is sheared, mirrored or flat; they stay where "
                            "they are (/nodes/0" +
                                at + "motion)."));
    EXPECT_TRUE(has_finding(reading,
                            "ignored: a body without a collider; its triggers stay where they are "
                            "(/nodes/3" +
                                at + "motion)."));
    EXPECT_TRUE(has_finding(
        reading, "ignored: a motion without a collider or trigger that is used (/nodes/4" + at +
                     "motion)."));
    EXPECT_TRUE(has_finding(
        reading, "ignored: a trigger that moves with a body; it stays where it is (/nodes/6" + at +
                     "trigger)."));
    EXPECT_TRUE(has_finding(
        reading,
        "ignored: a collider of scale 0, which the draft disables (/nodes/7" + at + "collider)."));
}

// By hand: a quarter turn about z maps x to y, so what is at x = 5 of the node is at y = 5 beside
// it.
TEST(GltfScene, CollidersOfABodyBecomeOneObject) {
    const std::string turned =
        R"("name":"car","rotation":[0,0,0.7071067811865476,0.7071067811865476],)"
        R"("translation":[1,2,3],"children":[1,2],)";
    const GltfReading reading = read_nodes(
        node(turned, kMotion + kCollider) + "," +
        node(R"("name":"wheel","translation":[5,0,0],"scale":[2,2,2],)", kCollider) + "," +
        node(R"("name":"lamp",)", kTrigger) + "," + node(R"("name":"road",)", kCollider));
    const AssemblyScene& assembly = *reading.assembly;
    const SceneFile& scene = assembly.scene;
    ASSERT_EQ(scene.objects.size(), 3u);
    const FileObject& car = scene.objects[0];
    EXPECT_EQ(car.name, "car");
    EXPECT_NE(car.body, kNoBody);
    EXPECT_EQ(scene.objects[1].name, "car/lamp");
    EXPECT_EQ(scene.objects[2].name, "road");
    const AssemblyModel& model = assembly.models.at(car.model);
    ASSERT_EQ(model.size(), 2u);
    const import::Affine& wheel = model[1].model_from_mesh;
    EXPECT_EQ(assembly.file.nodes()[model[1].node].path, "car/wheel");
    EXPECT_NEAR(wheel[0], 2, 1e-15);
    EXPECT_NEAR(wheel[1], 0, 1e-15);
    EXPECT_NEAR(wheel[3], 5, 1e-15);
    EXPECT_NEAR(wheel[7], 0, 1e-15);
    const Pose pose = pose_of(scene, car, 0).value();
    EXPECT_NEAR(transform_point(pose, {5, 0, 0}).x, 1, 1e-14);
    EXPECT_NEAR(transform_point(pose, {5, 0, 0}).y, 7, 1e-14);
    std::vector<import::PlacedNode> nodes;
    for (const AssemblyNode& node : model) {
        nodes.push_back({&assembly.file.nodes()[node.node], node.model_from_mesh});
    }
    const auto one = assembly.file.triangles(std::span(nodes).first(1));
    const auto both = assembly.file.triangles(nodes);
    ASSERT_TRUE(one && both);
    EXPECT_EQ(both->triangles.size(), 2 * one->triangles.size());
    EXPECT_TRUE(has_finding(reading, "assumed: the colliders of a body do not overlap"));
}

/// Puts a text in the place of another that occurs once.
void replace(std::string& text, const std::string& old, const std::string& now) {
    ASSERT_NE(text.find(old), std::string::npos) << old;
    text.replace(text.find(old), old.size(), now);
}

// Every weight is (0, 0, 0, 1), read from the points. The joint moves the mesh by 7 in x, and the
// node of the mesh, at (1, 2, 3) with the body, does not.
TEST(GltfScene, ASkinPlacesAColliderOfABody) {
    std::string text = gltf_text(
        node(R"("name":"car","translation":[1,2,3],"children":[1],)", kMotion + kCollider) + "," +
        node(R"("name":"rider","skin":0,)", kCollider) +
        R"(,{"name":"bone","translation":[7,0,0]},)" + node("", kCollider));
    replace(text, R"("POSITION":0)", R"("POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3)");
    replace(text, R"("accessors":[)", R"("skins":[{"joints":[2]}],"accessors":[)");
    replace(text, R"(],"bufferViews")",
            R"(,{"componentType":5121,"count":3,"type":"VEC4","sparse":{"count":0,"indices":)"
            R"({"bufferView":0,"componentType":5121},"values":{"bufferView":0}}},)"
            R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC4"}],"bufferViews")");
    const GltfReading reading = read_gltf_text(text);
    for (const Error& error : reading.errors) ADD_FAILURE() << error.message;
    ASSERT_TRUE(reading.assembly);
    const AssemblyScene& assembly = *reading.assembly;
    const AssemblyModel& model = assembly.models.at(assembly.scene.objects[0].model);
    ASSERT_EQ(model.size(), 2u);
    const import::MeshNode& rider = assembly.file.nodes()[model[1].node];
    EXPECT_EQ(rider.path, "car/rider");
    const std::vector<import::PlacedNode> nodes = {{&rider, model[1].model_from_mesh}};
    const auto soup = assembly.file.triangles(nodes);
    ASSERT_TRUE(soup) << soup.error().message;
    EXPECT_EQ(soup->positions[0], (format::Double3{6, -2, -3})) << "seen from the car";
    EXPECT_TRUE(has_finding(reading,
                            "ignored: a skin that moves; the mesh keeps the pose of the file "
                            "(/nodes/1/skin)."));
}

TEST(GltfScene, ABodyThatNothingPushesStays) {
    const GltfReading reading =
        read_nodes(node("", kMotion + collider_in(0)) + "," + node("", collider_in(1)),
                   R"({"collisionFilters":[{"collisionSystems":["a"],"collideWithSystems":["b"]},)"
                   R"({"collisionSystems":["b"],"notCollideWithSystems":["a"]}]})");
    EXPECT_EQ(reading.assembly->scene.objects[0].body, kNoBody);
    EXPECT_TRUE(has_finding(reading, "ignored: a body that no collider can push"));
    EXPECT_TRUE(has_finding(reading, "assumed: nothing is computed"));
    EXPECT_TRUE(reading.assembly->scene.bodies.empty());
    EXPECT_FALSE(has_finding(reading, "assumed: gravity"));
}

// A turn whose quaternion has seven digits.
TEST(GltfScene, TellsThatTransformsWereRounded) {
    const GltfReading reading =
        read_nodes(node(R"("rotation":[0,0,0.7071068,0.7071069],)", kTrigger));
    EXPECT_GT(reading.assembly->rounding, 0);
    EXPECT_TRUE(has_finding(
        reading, "assumed: transforms were rounded to rigid ones; the largest deviation is "));
}

Pose pose_of_object(const GltfReading& reading, std::size_t number, double time_s) {
    const SceneFile& scene = reading.assembly->scene;
    return pose_of(scene, scene.objects.at(number), time_s).value();
}

// By hand: in pi/2 seconds it moves by (0, 0, pi) and turns x to -z.
TEST(GltfScene, KinematicNodesMoveSteadily) {
    const double quarter = std::numbers::pi / 2;
    const GltfReading reading =
        read_nodes(node(R"("translation":[1,0,0],)", kKinematic + kCollider));
    const Pose pose = pose_of_object(reading, 0, quarter);
    EXPECT_NEAR(pose.translation().x, 1, 1e-12);
    EXPECT_NEAR(pose.translation().z, 2 * quarter, 1e-12);
    EXPECT_NEAR(pose.rotation()[0], 0, 1e-12);
    EXPECT_NEAR(pose.rotation()[6], -1, 1e-12);
    EXPECT_TRUE(has_finding(reading,
                            "assumed: a kinematic node without a centre of mass turns "
                            "about its origin."));
    EXPECT_TRUE(reading.assembly->scene.bodies.empty());
}

// Node 1 is on the axis through the origin of node 0, and node 2 beside it.
TEST(GltfScene, WhatIsBesideTheAxisDoesNotTurn) {
    const double quarter = std::numbers::pi / 2;
    const GltfReading reading = read_nodes(node(R"("children":[1,2],)", kKinematic + kCollider) +
                                           "," + node(R"("translation":[0,3,0],)", kTrigger) + "," +
                                           node(R"("translation":[3,0,0],)", kTrigger));
    EXPECT_NEAR(pose_of_object(reading, 1, quarter).rotation()[0], 0, 1e-12);
    EXPECT_EQ(pose_of_object(reading, 1, quarter).translation().y, 3);
    EXPECT_EQ(pose_of_object(reading, 2, quarter).rotation(), Pose().rotation());
    EXPECT_NEAR(pose_of_object(reading, 2, quarter).translation().z, 2 * quarter, 1e-12);
    EXPECT_TRUE(
        has_finding(reading, "assumed: a trigger also detects the colliders of its own body."));
    EXPECT_TRUE(has_finding(reading,
                            "ignored: a rotation of a kinematic node about an axis that misses the "
                            "origin of its collider or trigger (/nodes/2/"));
}

TEST(GltfScene, AMirroredNodeHasNoVelocities) {
    const GltfReading reading = read_nodes(node(R"("scale":[-1,1,1],)", kKinematic + kCollider));
    EXPECT_FALSE(reading.assembly->scene.motions.at(0).moves());
    EXPECT_TRUE(has_finding(
        reading, "ignored: velocities of a node that is sheared, mirrored or flat (/nodes/0/"));
}

// Node 1 is used twice.
TEST(GltfScene, ModelsOfNodesThatAreLeftOutAreDropped) {
    const GltfReading reading = read_nodes(R"({"mesh":1,"children":[1]},)" + node("", kTrigger) +
                                           R"(,{"translation":[5,0,0],"children":[1,3]},)" +
                                           R"({"mesh":1,"extensions":{"KHR_physics_rigid_bodies":)"
                                           R"({"collider":{"geometry":{"node":3}}}}})");
    const AssemblyScene& assembly = *reading.assembly;
    const SceneFile& scene = assembly.scene;
    ASSERT_EQ(scene.objects.size(), 3u);
    ASSERT_EQ(scene.models.size(), 2u);
    ASSERT_EQ(assembly.models.size(), 2u);
    EXPECT_EQ(scene.objects[0].model, 0u);
    EXPECT_EQ(scene.objects[1].model, 0u);
    EXPECT_EQ(scene.objects[2].model, 1u);
    EXPECT_EQ(assembly.file.nodes()[assembly.models[0][0].node].path, "node_0/node_1");
    EXPECT_EQ(pose_of_object(reading, 1, 0).translation(), (Double3{5, 0, 0}));
}

std::string uint_bytes(std::size_t number) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> 8 * i & 0xff);
    return bytes;
}

TEST(GltfScene, ReadsABinaryFile) {
    std::string json = gltf_text(node("", kCollider) + "," + node("", kTrigger));
    while (json.size() % 4 != 0) json += ' ';
    const std::string bytes = "glTF" + uint_bytes(2) + uint_bytes(20 + json.size()) +
                              uint_bytes(json.size()) + "JSON" + json;
    const test::ScratchFolder folder;
    const GltfReading reading = read_gltf_scene(folder.write("a.glb", bytes), {});
    ASSERT_TRUE(reading.assembly);
    EXPECT_EQ(reading.assembly->scene.text, json);
    EXPECT_EQ(reading.assembly->scene.pairs.size(), 1u);
}

void expect_refusal(const std::string& nodes, const std::string& words,
                    const std::string& shared = "{}") {
    const GltfReading reading = read_gltf_text(gltf_text(nodes, shared));
    EXPECT_FALSE(reading.assembly);
    ASSERT_EQ(reading.errors.size(), 1u);
    EXPECT_EQ(reading.errors[0].code, ErrorCode::unreadable);
    EXPECT_NE(reading.errors[0].message.find(words), std::string::npos)
        << reading.errors[0].message;
}

TEST(GltfScene, RefusesWhatIsNoScene) {
    expect_refusal(R"({"mesh":0})",
                   "a.gltf: no node has triangles and a collider or trigger of "
                   "KHR_physics_rigid_bodies, so there is nothing to compute.");
    expect_refusal(node("", R"("collider":{"geometry":{"mesh":2}})"),
                   "a.gltf: line 1: /nodes/0/extensions/KHR_physics_rigid_bodies/collider/"
                   "geometry/mesh: found 2, but the last of the meshes is number 1.");
    expect_refusal(node(R"("children":[0],)", kCollider), "a.gltf");
    std::string nodes, filters;
    for (int i = 0; i < 33; ++i) {
        const std::string comma = i == 0 ? "" : ",";
        nodes += comma + node("", collider_in(i));
        filters += comma + R"({"collisionSystems":["s)" + std::to_string(i) + R"("]})";
    }
    expect_refusal(nodes,
                   "its bodies, other colliders and triggers have 33 different collision filters; "
                   "at most 32 are possible, because each is a layer.",
                   R"({"collisionFilters":[)" + filters + "]}");
    const test::ScratchFolder folder;
    const GltfReading missing = read_gltf_scene(folder.path() / "none.glb", {});
    EXPECT_FALSE(missing.assembly);
    EXPECT_EQ(missing.errors.size(), 1u);
}

}  // namespace
}  // namespace cdprep::scenes
