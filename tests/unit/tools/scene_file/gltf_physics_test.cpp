// SPDX-License-Identifier: MIT
#include "scene_file/gltf_physics.h"

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cdprep::scenes {
namespace {

/// What was read of a document, and what was said about it.
struct PhysicsText {
    GltfPhysics physics;
    std::vector<std::string> findings;
    std::vector<std::string> errors;
};

PhysicsText read_physics(const std::string& text) {
    PhysicsText read;
    const Result<JsonFile> json = parse_json_file("a.gltf", text);
    EXPECT_TRUE(json) << text;
    if (!json) return read;
    Findings findings;
    read.physics = read_gltf_physics(*json, findings, read.errors);
    read.findings = findings.sentences("a.gltf");
    return read;
}

/// A document of one mesh. `nodes` has what the extension says of each node with that mesh.
std::string document(const std::vector<std::string>& nodes, const std::string& shared = "{}") {
    std::string text = R"({"meshes":[{},{}],"extensions":{"KHR_implicit_shapes":{"shapes":[)"
                       R"({"type":"box"}]},"KHR_physics_rigid_bodies":)" +
                       shared + R"(},"nodes":[)";
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        text += i == 0 ? "" : ",";
        text += R"({"mesh":0,"extensions":{"KHR_physics_rigid_bodies":)" + nodes[i] + "}}";
    }
    return text + "]}";
}

const std::string kOwnMesh = R"("geometry":{"mesh":0})";

std::string collider(const std::string& more = "") {
    return R"({"collider":{)" + kOwnMesh + more + "}}";
}

GltfFilter filter(std::set<std::string> systems, std::optional<std::set<std::string>> with,
                  std::optional<std::set<std::string>> without) {
    return {std::move(systems), std::move(with), std::move(without)};
}

// By hand, from the rules of the draft.
TEST(GltfFilter, FollowsTheDraft) {
    const GltfFilter any;
    const GltfFilter car = filter({"car"}, {}, {});
    const GltfFilter fast_car = filter({"car", "fast"}, {}, {});
    const GltfFilter only_cars = filter({"road"}, std::set<std::string>{"car"}, {});
    const GltfFilter no_cars = filter({"path"}, {}, std::set<std::string>{"car"});
    const GltfFilter nothing = filter({"air"}, std::set<std::string>{}, {});
    const GltfFilter shy = filter({"car"}, std::set<std::string>{"path"}, {});
    EXPECT_TRUE(accept(any, any));
    EXPECT_TRUE(accept(any, car));
    EXPECT_TRUE(accept(only_cars, car));
    EXPECT_FALSE(accept(no_cars, car));
    // All systems of the other one count, not any.
    EXPECT_FALSE(accept(only_cars, fast_car));
    EXPECT_TRUE(accept(no_cars, fast_car));
    // In no system: in no list.
    EXPECT_FALSE(accept(only_cars, any));
    EXPECT_TRUE(accept(no_cars, any));
    EXPECT_FALSE(accept(nothing, car));
    EXPECT_FALSE(accept(nothing, any));
    // Either side may refuse.
    EXPECT_FALSE(accept(only_cars, shy));
    EXPECT_FALSE(accept(no_cars, shy));
    EXPECT_FALSE(accept(only_cars, only_cars));
}

TEST(GltfFilter, TheOrderOfTheTwoIsOfNoMatter) {
    using Names = std::optional<std::set<std::string>>;
    const std::vector<std::set<std::string>> systems = {{}, {"a"}, {"b"}, {"a", "b"}};
    std::vector<Names> lists = {std::nullopt};
    for (const auto& names : systems) lists.emplace_back(names);
    std::vector<GltfFilter> filters;
    for (const auto& own : systems) {
        for (const Names& with : lists) {
            for (const Names& without : lists) filters.push_back(filter(own, with, without));
        }
    }
    std::size_t accepted = 0;
    for (const GltfFilter& a : filters) {
        for (const GltfFilter& b : filters) {
            EXPECT_EQ(accept(a, b), accept(b, a));
            accepted += accept(a, b) ? 1 : 0;
        }
    }
    EXPECT_GT(accepted, 0u);
    EXPECT_LT(accepted, filters.size() * filters.size() / 2);
}

TEST(GltfPhysics, ReadsMotionsSurfacesAndMaterials) {
    const PhysicsText read = read_physics(document(
        {R"({"motion":{"mass":2.5,"linearVelocity":[1,2,3],"angularVelocity":[0,4,0]},)"
         R"("collider":{"geometry":{"mesh":0},"physicsMaterial":1,"collisionFilter":0}})",
         R"({"motion":{"isKinematic":true,"centerOfMass":[0,1,0],"gravityFactor":0},)"
         R"("trigger":{"geometry":{"node":1},"collisionFilter":0}})",
         collider(R"(,"physicsMaterial":0)")},
        R"({"collisionFilters":[{"collisionSystems":["x"],"collideWithSystems":["y","z"]}],)"
        R"("physicsMaterials":[{},{"dynamicFriction":0.25,"staticFriction":0.25,)"
        R"("restitution":0.5,"restitutionCombine":"maximum"}]})"));
    EXPECT_EQ(read.errors, std::vector<std::string>{});
    EXPECT_EQ(read.findings, std::vector<std::string>{});
    ASSERT_EQ(read.physics.nodes.size(), 3u);
    const GltfNode& body = read.physics.nodes[0];
    ASSERT_TRUE(body.motion && body.collider);
    EXPECT_EQ(body.motion->mass, 2.5);
    EXPECT_FALSE(body.motion->is_kinematic);
    EXPECT_EQ(body.motion->velocity, (Double3{1, 2, 3}));
    EXPECT_EQ(body.motion->turn, (Double3{0, 4, 0}));
    EXPECT_EQ(body.collider->filter, filter({"x"}, std::set<std::string>{"y", "z"}, {}));
    EXPECT_EQ(body.collider->material, (Material{.friction = 0.25, .restitution = 0.5}));
    const GltfNode& gate = read.physics.nodes[1];
    ASSERT_TRUE(gate.motion && gate.trigger && !gate.collider);
    EXPECT_TRUE(gate.motion->is_kinematic);
    EXPECT_EQ(gate.motion->centre, (Double3{0, 1, 0}));
    ASSERT_TRUE(read.physics.nodes[2].collider && read.physics.nodes[2].collider->material);
    EXPECT_EQ(read.physics.nodes[2].collider->material->friction, 0.6);  // the draft's default
    EXPECT_EQ(read.physics.roots, (std::vector<std::uint32_t>{0, 1, 2}));
}

/// Whether a sentence is the only finding about a node.
void expect_finding(const std::string& node, const std::string& words, const std::string& place,
                    const std::string& shared = "{}") {
    const PhysicsText read = read_physics(document({node}, shared));
    EXPECT_EQ(read.errors, std::vector<std::string>{}) << node;
    EXPECT_EQ(read.findings,
              (std::vector<std::string>{"a.gltf: ignored: " + words + " (" + place + ")."}))
        << node;
}

TEST(GltfPhysics, ListsWhatItDoesNotTake) {
    const std::string at = "/nodes/0/extensions/KHR_physics_rigid_bodies/";
    const auto motion = [](const std::string& member) { return R"({"motion":{)" + member + "}}"; };
    expect_finding(
        motion(R"("mass":0)"),
        "an infinite mass (0); the body is kinematic instead, so gravity does not move it",
        at + "motion/mass");
    expect_finding(motion(R"("gravityFactor":0.5)"), "a gravity factor other than 1",
                   at + "motion/gravityFactor: 0.5");
    expect_finding(motion(R"("centerOfMass":[0,0,1])"),
                   "a centre of mass; that of the model is used",
                   at + "motion/centerOfMass: [0,0,1]");
    expect_finding(motion(R"("inertiaDiagonal":[1,1,1])"), "an inertia; that of the model is used",
                   at + "motion/inertiaDiagonal: [1,1,1]");
    expect_finding(motion(R"("inertiaOrientation":[0,0,0,1])"),
                   "a rotation of the inertia; that of the model is used",
                   at + "motion/inertiaOrientation: [0,0,0,1]");
    expect_finding(motion(R"("spin":1)"), "the unknown key 'spin'", at + "motion/spin");
    expect_finding(R"({"joint":{"joint":0,"connectedNode":0}})", "a joint", at + "joint",
                   R"({"physicsJoints":[{}]})");
    expect_finding(R"({"collider":{"geometry":{"mesh":0,"convexHull":true}}})",
                   "a convex hull as geometry; the mesh is used", at + "collider/geometry/mesh");
    expect_finding(R"({"collider":{"geometry":{"shape":0}}})",
                   "an implicit shape (box); the mesh of its node is used",
                   at + "collider/geometry/shape");
    expect_finding(R"({"collider":{"geometry":{"mesh":1}}})",
                   "a mesh other than the node's; the mesh of its node is used",
                   at + "collider/geometry/mesh");
    expect_finding(R"({"collider":{"shape":0}})",
                   "the shape of an older draft; the mesh of its node is used",
                   at + "collider/shape");
    expect_finding(R"({"trigger":{"nodes":[0]}})",
                   "a trigger of several nodes; each of them has its own events",
                   at + "trigger/nodes");
    const std::string shared = "/extensions/KHR_physics_rigid_bodies/physicsMaterials/0";
    expect_finding(collider(), "a static friction other than the dynamic one, which is used",
                   shared + ": 0.7 instead of 0.6",
                   R"({"physicsMaterials":[{"staticFriction":0.7}]})");
    expect_finding(collider(), "a restitution above 1; 1 is used", shared + "/restitution: 2",
                   R"({"physicsMaterials":[{"restitution":2}]})");
    expect_finding(collider(), "a friction combine mode; the geometric mean is used",
                   shared + "/frictionCombine: \"average\"",
                   R"({"physicsMaterials":[{"frictionCombine":"average"}]})");
    expect_finding(collider(), "a restitution combine mode; the larger restitution is used",
                   shared + "/restitutionCombine: \"minimum\"",
                   R"({"physicsMaterials":[{"restitutionCombine":"minimum"}]})");
}

// Node 0 has a geometry of node 1, below which only a cycle without meshes comes.
TEST(GltfPhysics, ACycleOfNodesEnds) {
    const PhysicsText read = read_physics(
        R"({"nodes":[{"mesh":0,"extensions":{"KHR_physics_rigid_bodies":{"trigger":{"geometry":)"
        R"({"node":1}}}}},{"mesh":0,"children":[2]},{"children":[3]},{"children":[2]}],)"
        R"("meshes":[{"weights":[0.5]}]})");
    EXPECT_TRUE(read.physics.nodes[0].trigger);
    EXPECT_EQ(read.findings, std::vector<std::string>{}) << "the import applies morph weights";
}

TEST(GltfPhysics, ListsEqualFindingsOnce) {
    const std::string joint = R"({"joint":{}})";
    const PhysicsText read = read_physics(document({joint, joint, joint}));
    EXPECT_EQ(read.findings,
              (std::vector<std::string>{
                  "a.gltf: ignored: a joint (/nodes/0/extensions/KHR_physics_rigid_bodies/joint "
                  "and 2 more)."}));
}

TEST(GltfPhysics, ANodeWithoutAMeshHasNoGeometry) {
    const PhysicsText read = read_physics(
        R"({"nodes":[{"skin":0,"extensions":{"KHR_physics_rigid_bodies":{"trigger":{"geometry":)"
        R"({"node":1}}}}},{"mesh":0,"children":[2]},{"mesh":0}],"meshes":[{}],)"
        R"("animations":[{"channels":[{},{}]}]})");
    EXPECT_EQ(read.errors, std::vector<std::string>{});
    EXPECT_FALSE(read.physics.nodes[0].trigger);
    const std::string at = "/nodes/0/extensions/KHR_physics_rigid_bodies/trigger/geometry/node";
    EXPECT_EQ(read.findings,
              (std::vector<std::string>{
                  "a.gltf: ignored: meshes below the node of a geometry (" + at + ").",
                  "a.gltf: ignored: a mesh other than the node's; its node has no mesh, so the "
                  "trigger is left out (" +
                      at + ").",
                  "a.gltf: ignored: an animation of a node (/animations/0/channels/0 and 1 "
                  "more)."}));
}

TEST(GltfPhysics, ReadsTheSceneThatTheFileNames) {
    const std::string nodes = R"("nodes":[{"children":[1]},{},{}])";
    EXPECT_EQ(read_physics("{" + nodes + "}").physics.roots, (std::vector<std::uint32_t>{0, 2}));
    const std::string scenes = R"(,"scenes":[{"nodes":[2]},{"nodes":[1,0]}])";
    EXPECT_EQ(read_physics("{" + nodes + scenes + "}").physics.roots,
              std::vector<std::uint32_t>{2});
    EXPECT_EQ(read_physics("{" + nodes + scenes + R"(,"scene":1})").physics.roots,
              (std::vector<std::uint32_t>{1, 0}));
}

void expect_error(const std::string& text, const std::string& place_and_words) {
    const PhysicsText read = read_physics(text);
    EXPECT_EQ(read.errors, std::vector<std::string>{"a.gltf: line 1: " + place_and_words}) << text;
}

TEST(GltfPhysics, NamesThePlaceOfMistakes) {
    const std::string at = "/nodes/0/extensions/KHR_physics_rigid_bodies/";
    expect_error(
        document({collider(R"(,"collisionFilter":3)")}, R"({"collisionFilters":[{},{},{}]})"),
        at + "collider/collisionFilter: found 3, but the last of the collision filters is number "
             "2.");
    expect_error(document({collider(R"(,"physicsMaterial":0)")}),
                 at + "collider/physicsMaterial: found 0, but the file has no physics materials.");
    expect_error(
        document({R"({"collider":{"geometry":{"shape":1}}})"}),
        at + "collider/geometry/shape: found 1, but the last of the implicit shapes is number 0.");
    expect_error(document({R"({"trigger":{"geometry":{"node":-1}}})"}),
                 at + "trigger/geometry/node: found -1; expected a whole number from 0 to "
                      "2147483648.");
    expect_error(document({R"({"trigger":{"nodes":[1]}})"}),
                 at + "trigger/nodes/0: found 1, but the last of the nodes is number 0.");
    expect_error(document({R"({"collider":{}})"}), at + "collider: the key 'geometry' is missing.");
    expect_error(document({R"({"collider":{"geometry":{"mesh":0,"node":0}}})"}),
                 at + "collider/geometry: found 2 of 'shape', 'node' and 'mesh'; expected 1.");
    expect_error(document({R"({"collider":7})"}), at + "collider: found 7; expected an object.");
    expect_error(document({R"({"motion":{"mass":-1}})"}),
                 at + "motion/mass: found -1; expected a number, 0 or more.");
    expect_error(document({R"({"motion":{"linearVelocity":[1,2]}})"}),
                 at + "motion/linearVelocity: found [1,2]; expected an array of 3 numbers.");
    expect_error(document({R"({"motion":{"isKinematic":1}})"}),
                 at + "motion/isKinematic: found 1; expected true or false.");
    expect_error(document({R"({"joint":{"connectedNode":5}})"}),
                 at + "joint/connectedNode: found 5, but the last of the nodes is number 0.");
    expect_error(document({"[]"}),
                 "/nodes/0/extensions/KHR_physics_rigid_bodies: found []; "
                 "expected an object.");
    expect_error(document({}, R"({"collisionFilters":[{"collisionSystems":"a"}]})"),
                 "/extensions/KHR_physics_rigid_bodies/collisionFilters/0/collisionSystems: found "
                 "\"a\"; expected an array.");
    expect_error(document({}, R"({"physicsMaterials":[{"frictionCombine":"mean"}]})"),
                 "/extensions/KHR_physics_rigid_bodies/physicsMaterials/0/frictionCombine: 'mean' "
                 "is not a combine mode. Choose from average, minimum, maximum or multiply.");
    expect_error("[]", "found []; expected an object.");
    expect_error(R"({"nodes":[3]})", "/nodes/0: found 3; expected an object.");
    expect_error(R"({"nodes":[{"children":[0,2]}]})",
                 "/nodes/0/children/1: found 2, but the last of the nodes is number 0.");
    expect_error(R"({"scene":1,"scenes":[{}]})",
                 "/scene: found 1, but the last of the scenes is number 0.");
}

}  // namespace
}  // namespace cdprep::scenes
