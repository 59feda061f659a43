// SPDX-License-Identifier: MIT
#include "scene_file/read_scene.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "support/scratch_folder.h"

namespace cdprep::scenes {
namespace {

/// A folder with two files that scenes name. The reader does not open them.
class Folder {
public:
    Folder() {
        folder_.write("crate.obj", std::string_view());
        folder_.write("gate.obj", std::string_view());
    }
    [[nodiscard]] SceneReading read(const std::string& text) const {
        return parse_scene("s.json", text, folder_.path());
    }
    [[nodiscard]] SceneFile scene(const std::string& text) const {
        SceneReading reading = read(text);
        for (const std::string& error : reading.errors) ADD_FAILURE() << error;
        return reading.scene.value_or(SceneFile{});
    }

private:
    test::ScratchFolder folder_;
};

/// A scene with one object, whose members are given on line 4, and one pair, on line 3.
std::string one_object(const std::string& object, const std::string& pair = R"("effects": [])") {
    return "{\"cdprep_scene\": 1, \"layers\": [\"crates\", \"gates\"],\n\"pairs\": [\n"
           "{\"layers\": [\"crates\", \"gates\"], " +
           pair + "}], \"objects\": [\n{\"name\": \"c\", \"model\": \"crate.obj\", " +
           "\"layer\": \"crates\"" + object + "}]}";
}

TEST(ReadScene, ReadsAWholeFile) {
    const Folder folder;
    const SceneFile scene = folder.scene(R"({
        "$schema": "scene.schema.json",
        "cdprep_scene": 1,
        "metres_per_unit": 0.001,
        "step_s": 0.25,
        "duration_s": 2,
        "limits": {"pairs": 100},
        "layers": ["crates", "gates"],
        "pairs": [
            {"layers": ["gates", "crates"], "effects": ["collide", "within"], "tolerance": 2,
             "body": "solid", "overlap": "proper", "events": ["begins"]},
            {"layers": ["gates", "gates"], "effects": ["distance"], "max_distance": 3,
             "max_error": 0.25}
        ],
        "objects": [
            {"name": "gate", "model": "gate.obj", "layer": "gates",
             "pose": {"matrix": [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7]]}},
            {"name": "crate", "model": "crate.obj", "layer": "crates", "motion": "fixed",
             "instances": {"counts": [2, 1, 2], "spacing": [10, 0, -5]}},
            {"name": "last", "model": "./crate.obj", "layer": "crates",
             "motion": {"path": [{"time_s": 0, "pose": {}},
                                 {"time_s": 1, "pose": {"translation": [1, 2, 3],
                                                        "quaternion": [0, 0, 0, 2]}}]}}
        ]})");
    EXPECT_EQ(scene.name, "s.json");
    EXPECT_EQ(scene.metres_per_unit, 0.001);
    EXPECT_EQ(scene.step_s, 0.25);
    EXPECT_EQ(scene.duration_s, 2);
    EXPECT_EQ(scene.most_pairs, 100u);
    EXPECT_EQ(scene.layers, (std::vector<std::string>{"crates", "gates"}));

    ASSERT_EQ(scene.pairs.size(), 2u);
    const AskedPair& first = scene.pairs[0];
    EXPECT_EQ(first.asked.a, 1u);
    EXPECT_EQ(first.asked.b, 0u);
    EXPECT_EQ(first.asked.effects, Ask::collide | Ask::within);
    EXPECT_EQ(first.asked.tolerance, 2);
    EXPECT_EQ(first.asked.body, Body::solid);
    EXPECT_EQ(first.asked.overlap, Overlap::proper);
    EXPECT_TRUE(first.tells_begins);
    EXPECT_FALSE(first.tells_ends);
    EXPECT_EQ(scene.pairs[1].asked.max_distance, 3);
    EXPECT_EQ(scene.pairs[1].asked.max_error, 0.25);
    EXPECT_EQ(first.asked.max_error, 0);
    EXPECT_TRUE(scene.pairs[1].tells_begins && scene.pairs[1].tells_ends);

    EXPECT_EQ(scene.models.size(), 2u) << "two spellings of one file are one model";
    std::vector<std::string> names;
    for (const FileObject& object : scene.objects) names.push_back(object.name);
    EXPECT_EQ(names, (std::vector<std::string>{"gate", "crate[0,0,0]", "crate[1,0,0]",
                                               "crate[0,0,1]", "crate[1,0,1]", "last"}));
    EXPECT_EQ(pose_of(scene, scene.objects[0], 1)->translation(), (Double3{5, 6, 7}));
    EXPECT_EQ(pose_of(scene, scene.objects[0], 1)->rotation()[1], -1);
    EXPECT_EQ(pose_of(scene, scene.objects[4], 1)->translation(), (Double3{10, 0, -5}));
    EXPECT_EQ(pose_of(scene, scene.objects[5], 2)->translation(), (Double3{1, 2, 3}));
    EXPECT_EQ(pose_of(scene, scene.objects[5], 2)->rotation()[0], -1);
    EXPECT_EQ(scene.objects[5].model, scene.objects[1].model);
}

// The plan refuses effects that are not built; the reader keeps what the file says.
TEST(ReadScene, KeepsEffectsThatAreNotBuilt) {
    const Folder folder;
    const SceneFile scene =
        folder.scene(one_object("", R"("effects": ["tear", "response", "haptic"])"));
    EXPECT_EQ(scene.pairs[0].asked.effects, Ask::tear | Ask::response | Ask::haptic);
}

TEST(ReadScene, ReadsOptionsOfEffects) {
    const Folder folder;
    const SceneFile scene =
        folder.scene(one_object("", R"("effects": ["continuous", "haptic"], "work": 3000,
                          "impact": {"tolerance": 0.5, "most_steps": 7})"));
    const LayerPair& pair = scene.pairs[0].asked;
    EXPECT_EQ(pair.effects, Ask::continuous | Ask::haptic);
    EXPECT_EQ(pair.work, 3000u);
    EXPECT_EQ(pair.impact.tolerance, 0.5);
    EXPECT_EQ(pair.impact.most_steps, 7u);
}

// An angle in degrees, as `query contacts` takes it.
TEST(ReadScene, ReadsOptionsOfContacts) {
    const Folder folder;
    const auto contacts_of = [&](const std::string& options) {
        const SceneFile scene =
            folder.scene(one_object("", R"("effects": ["contacts"])" + options));
        return scene.pairs[0].asked.contacts;
    };
    const ContactOptions given = contacts_of(
        R"(, "contacts": {"tolerance": 0.25, "manifold": true, "most": 8, "work": 900,
            "cluster_deg": 180})");
    EXPECT_EQ(given.tolerance, 0.25);
    EXPECT_EQ(given.manifold, Manifold::four);
    EXPECT_EQ(given.most, 8u);
    EXPECT_EQ(given.work, 900u);
    EXPECT_EQ(given.cluster_angle, std::numbers::pi);
    for (const char* options :
         {"", R"(, "contacts": {})", R"(, "contacts": {"manifold": false})"}) {
        EXPECT_EQ(contacts_of(options).manifold, Manifold::none);
        EXPECT_EQ(contacts_of(options).cluster_angle, 0);
        EXPECT_EQ(contacts_of(options).most, 16u);
    }
}

TEST(ReadScene, HasDefaults) {
    const Folder folder;
    const SceneFile scene = folder.scene(one_object(""));
    EXPECT_EQ(scene.metres_per_unit, 0);
    EXPECT_EQ(scene.step_s, 1.0 / 60);
    EXPECT_EQ(scene.duration_s, 0);
    EXPECT_FALSE(scene.most_pairs);
    EXPECT_FALSE(scene.motions[0].moves());
    EXPECT_EQ(pose_of(scene, scene.objects[0], 0)->rotation(), Pose().rotation());
}

// `query --scene` asks all about all then; an empty list of pairs asks nothing.
TEST(ReadScene, MayHaveNoPairs) {
    const Folder folder;
    const std::string rest = R"("cdprep_scene": 1, "layers": ["a"], "objects": [])";
    EXPECT_FALSE(folder.scene("{" + rest + "}").has_pairs);
    EXPECT_TRUE(folder.scene("{" + rest + R"(, "pairs": []})").has_pairs);
}

struct Mistake {
    std::string text;
    std::vector<std::string> errors;
};

// Each sentence can be checked by hand: line, place, what was found, what is allowed.
TEST(ReadScene, NamesEachMistakeAndItsLine) {
    const Folder folder;
    const std::string words =
        "collide, overlap, distance, within, contacts, response, continuous, self, deform, tear, "
        "haptic or inside.";
    const std::vector<Mistake> mistakes = {
        {"[]", {"line 1: found []; expected an object."}},
        {"3", {"line 1: found 3; expected an object."}},
        {"{\"a\": 3}", {"line 1: the key 'cdprep_scene' is missing."}},
        {"{\n\"cdprep_scene\": 2}",
         {"line 2: /cdprep_scene: found version 2; this program reads version 1."}},
        {"{\n\"cdprep_scene\": \"1\"}",
         {"line 2: /cdprep_scene: found \"1\"; expected a whole number from 0 to 2147483648."}},
        {"{\"cdprep_scene\": 1,\n\"layer\": [],\n\"step_s\": 0, \"duration_s\": -1}",
         {"line 2: /layer: unknown key 'layer'. Choose from $schema, cdprep_scene, "
          "metres_per_unit, step_s, duration_s, gravity, dynamics, limits, layers, pairs or "
          "objects. Did you mean 'layers'?",
          "line 3: /step_s: found 0; expected a number above 0.",
          "line 3: /duration_s: found -1; expected a number, 0 or more.",
          "line 1: the key 'layers' is missing.", "line 1: the key 'objects' is missing."}},
        {"{\"cdprep_scene\": 1, \"pairs\": [], \"objects\": {}, \"limits\": {\"pairs\": 0.5},\n"
         "\"layers\": [\"a\", \"a\", \"\"]}",
         {"line 1: /limits/pairs: found 0.5; expected a whole number from 1 to 2147483648.",
          "line 2: /layers/1: the layer 'a' occurs twice.",
          "line 2: /layers/2: found \"\"; expected a non-empty string.",
          "line 1: /objects: found an empty object; expected an array."}},
        {one_object("", "\"effects\": [\"colide\", 3], \"body\": \"hull\", \"overlap\": 1"),
         {"line 3: /pairs/0/effects/0: 'colide' is not an effect. Choose from " + words +
              " Did you mean 'collide'?",
          "line 3: /pairs/0/effects/1: found 3; expected an effect: " + words,
          "line 3: /pairs/0/body: 'hull' is not a body. Choose from surface or solid.",
          "line 3: /pairs/0/overlap: found 1; expected a kind of overlap: closed or proper."}},
        {one_object("",
                    "\"tolerance\": -1, \"max_distance\": [], \"max_error\": -2, \"events\": "
                    "[\"pauses\"]"),
         {"line 3: /pairs/0: the key 'effects' is missing.",
          "line 3: /pairs/0/tolerance: found -1; expected a number, 0 or more.",
          "line 3: /pairs/0/max_distance: found []; expected a number, 0 or more.",
          "line 3: /pairs/0/max_error: found -2; expected a number, 0 or more.",
          "line 3: /pairs/0/events/0: 'pauses' is not an event. Choose from begins, ends or "
          "stays."}},
        {one_object("", "\"effects\": [\"collide\"], \"contacts\": {}"),
         {"line 3: /pairs/0/contacts: the pair does not request contacts."}},
        {one_object("", "\"effects\": [\"collide\"], \"impact\": {}, \"work\": 0"),
         {"line 3: /pairs/0/impact: the pair does not request continuous.",
          "line 3: /pairs/0/work: found 0; expected a whole number from 1 to 2147483648."}},
        {one_object("",
                    "\"effects\": [\"continuous\"], \"impact\": {\"most_steps\": 0, "
                    "\"tolerance\": -1}"),
         {"line 3: /pairs/0/impact/tolerance: found -1; expected a number, 0 or more.",
          "line 3: /pairs/0/impact/most_steps: found 0; expected a whole number from 1 to "
          "2147483648."}},
        {one_object("", "\"effects\": [\"contacts\"], \"contacts\": {\"depth\": 2}"),
         {"line 3: /pairs/0/contacts/depth: unknown key 'depth'. Choose from tolerance, "
          "manifold, most, work or cluster_deg."}},
        {one_object("",
                    "\"effects\": [\"contacts\"], \"contacts\": {\"manifold\": 4,\n"
                    "\"cluster_deg\": -15}"),
         {"line 3: /pairs/0/contacts/manifold: found 4; expected true or false.",
          "line 4: /pairs/0/contacts/cluster_deg: found -15; expected a number, 0 or more."}},
        {one_object("",
                    "\"effects\": [\"contacts\"], \"contacts\": {\"most\": 0, \"tolerance\": -1}"),
         {"line 3: /pairs/0/contacts/tolerance: found -1; expected a number, 0 or more.",
          "line 3: /pairs/0/contacts/most: found 0; expected a whole number from 1 to 256."}},
        {one_object(", \"pose\": {\"translation\": [1, 2]}"),
         {"line 4: /objects/0/pose/translation: found [1,2]; expected an array of 3 numbers."}},
        {one_object(", \"pose\": {\"quaternion\": [0, 0, 0, 0]}"),
         {"line 4: /objects/0/pose: The quaternion of the pose is zero; it must have a "
          "direction."}},
        {one_object(", \"pose\": {\"matrix\": [[1, 0, 0, 0]]}"),
         {"line 4: /objects/0/pose/matrix: found [[1,0,0,0]]; expected an array of 3 rows of 4 "
          "numbers."}},
        {one_object(", \"motion\": \"free\""),
         {"line 4: /objects/0/motion: found \"free\"; expected \"fixed\", \"body\", or an object "
          "with path, velocity, turn_rad_per_s, deform, tear or body."}},
        {"{\"cdprep_scene\": 1, \"layers\": {},\n\"objects\": [],\n\"pairs\": "
         "[{\"layers\": [\"a\", \"a\"], \"effects\": []}]}",
         {"line 1: /layers: found an empty object; expected an array."}},
        {"{\"cdprep_scene\": 1, \"layers\": [],\n\"objects\": [],\n\"pairs\": "
         "[{\"layers\": [\"a\", \"a\"], \"effects\": []}]}",
         {"line 3: /pairs/0/layers/0: found \"a\"; expected a layer, but the scene has no layers.",
          "line 3: /pairs/0/layers/1: found \"a\"; expected a layer, but the scene has no "
          "layers."}},
        {one_object(", \"motion\": {}"),
         {"line 4: /objects/0/motion: a motion has a path, a velocity, a turn_rad_per_s, a deform, "
          "a tear or a body."}},
        {one_object(", \"motion\": {\"path\": [], \"velocity\": [0, 0, 1]}, \"pose\": {}"),
         {"line 4: /objects/0/motion: a path cannot be combined with velocity or turn_rad_per_s.",
          "line 4: /objects/0/motion: an object with a path cannot have a pose; the keys of the "
          "path have poses.",
          "line 4: /objects/0/motion: the path has no keys."}},
        {one_object(", \"motion\": {\"path\": [{\"time_s\": 1, \"pose\": {}}, {\"time_s\": 1}]}"),
         {"line 4: /objects/0/motion/path/1: the key 'pose' is missing.",
          "line 4: /objects/0/motion/path/1/time_s: found 1; expected a time after that of the "
          "previous key."}},
        {one_object(", \"instances\": {\"counts\": [1, 0, 2], \"spacing\": 3}"),
         {"line 4: /objects/0/instances/spacing: found 3; expected an array of 3 numbers.",
          "line 4: /objects/0/instances/counts/1: found 0; expected a whole number from 1 to "
          "2147483648."}},
        {one_object(", \"instances\": {\"counts\": [2000, 2000, 1], \"spacing\": [1, 1, 1]}"),
         {"line 4: /objects/0: a scene file has at most 1048576 objects; with these it would "
          "have 4000000."}},
        {one_object("},\n{\"name\": \"c\", \"layer\": \"crate\", \"model\": \"none.obj\""),
         {"line 5: /objects/1/model: there is no file ",
          "line 5: /objects/1/layer: 'crate' is not a layer. Choose from crates or gates. Did you "
          "mean 'crates'?",
          "line 5: /objects/1/name: another object has the name 'c'."}},
        {one_object(", \"mass\": 3"),
         {"line 4: /objects/0/mass: unknown key 'mass'. Choose from name, model, layer, pose, "
          "motion, material or instances."}},
    };
    for (const Mistake& mistake : mistakes) {
        const SceneReading reading = folder.read(mistake.text);
        EXPECT_FALSE(reading.scene) << mistake.text;
        ASSERT_EQ(reading.errors.size(), mistake.errors.size())
            << mistake.text << "\n"
            << ::testing::PrintToString(reading.errors);
        for (std::size_t i = 0; i < mistake.errors.size(); ++i) {
            EXPECT_EQ(reading.errors[i].substr(0, 8 + mistake.errors[i].size()),
                      "s.json: " + mistake.errors[i]);
        }
    }
}

TEST(ReadScene, ReadsBodies) {
    const Folder folder;
    const SceneFile scene = folder.scene(R"({"cdprep_scene": 1, "layers": ["a"],
        "gravity": [0, -9.75, 1],
        "dynamics": {"substeps": 2, "iterations": 3, "rest_gap": 0.25, "most_speed": 5,
                     "tolerance": 6, "sleep_speed": 0, "most_contacts": 7, "sleeps": false},
        "objects": [
        {"name": "floor", "model": "gate.obj", "layer": "a", "material": {"friction": 3}},
        {"name": "crate", "model": "crate.obj", "layer": "a", "motion": "body",
         "instances": {"counts": [2, 1, 1], "spacing": [1, 0, 0]}},
        {"name": "ball", "model": "crate.obj", "layer": "a", "pose": {"translation": [1, 2, 3]},
         "material": {"friction": 0, "restitution": 1},
         "motion": {"body": {"mass": 4, "linear_damping": 0.5, "angular_damping": 1,
                             "velocity": [1, 2, 3], "turn_rad_per_s": [4, 5, 6],
                             "continuous": true}}},
        {"name": "light", "model": "crate.obj", "layer": "a",
         "motion": {"body": {"density": 100}}}]})");
    EXPECT_EQ(scene.dynamics.gravity, (Double3{0, -9.75, 1}));
    EXPECT_EQ(scene.dynamics.substeps, 2u);
    EXPECT_EQ(scene.dynamics.iterations, 3u);
    EXPECT_EQ(scene.dynamics.rest_gap, 0.25);
    EXPECT_EQ(scene.dynamics.most_speed, 5);
    EXPECT_EQ(scene.dynamics.tolerance, 6);
    EXPECT_EQ(scene.dynamics.sleep_speed, 0);
    EXPECT_EQ(scene.dynamics.most_contacts, 7u);
    EXPECT_FALSE(scene.dynamics.sleeps);
    std::vector<std::uint32_t> bodies;
    for (const FileObject& object : scene.objects) bodies.push_back(object.body);
    EXPECT_EQ(bodies, (std::vector<std::uint32_t>{kNoBody, 0, 0, 1, 2}));
    EXPECT_EQ(scene.objects[0].material, (Material{.friction = 3}));
    EXPECT_EQ(scene.objects[1].material, Material{});
    EXPECT_EQ(scene.objects[3].material, (Material{.friction = 0, .restitution = 1}));
    ASSERT_EQ(scene.bodies.size(), 3u);
    EXPECT_FALSE(scene.bodies[0].mass || scene.bodies[0].density || scene.bodies[0].is_continuous);
    const BodyMotion& ball = scene.bodies[1];
    EXPECT_EQ(ball.mass, 4);
    EXPECT_EQ(ball.linear_damping, 0.5);
    EXPECT_EQ(ball.angular_damping, 1);
    EXPECT_EQ(ball.velocity, (Double3{1, 2, 3}));
    EXPECT_EQ(ball.turn, (Double3{4, 5, 6}));
    EXPECT_TRUE(ball.is_continuous);
    EXPECT_EQ(scene.bodies[2].density, 100);
    EXPECT_EQ(pose_of(scene, scene.objects[3], 1)->translation(), (Double3{1, 2, 3}))
        << "a body starts at its pose";
}

/// An object with this body on line 4.
std::string falling(const std::string& body) {
    return one_object(", \"motion\": {\"body\": {" + body + "}}");
}

// By hand: each sentence.
TEST(ReadScene, NamesMistakesOfBodies) {
    const Folder folder;
    const std::string body = "line 4: /objects/0/motion/body";
    const std::string no_gravity =
        "line 1: there are bodies, but the key 'gravity' is missing: for example [0, 0, -9.81] in "
        "metres, or [0, 0, 0] for none.";
    const std::vector<Mistake> mistakes = {
        {one_object(", \"motion\": \"body\""), {no_gravity}},
        {falling("\"mass\": 0"),
         {body + "/mass: found 0; expected a number from 1e-30 to 1e+30.", no_gravity}},
        {falling("\"mass\": 1e-31"),
         {body + "/mass: found 1e-31; expected a number from 1e-30 to 1e+30.", no_gravity}},
        {falling("\"mass\": 1, \"density\": 2"),
         {body + "/density: a body has a mass or a density, not both.", no_gravity}},
        {falling("\"linear_damping\": 1.5, \"angular_damping\": -1, \"continuous\": 1"),
         {body + "/linear_damping: found 1.5; expected a number from 0 to 1.",
          body + "/angular_damping: found -1; expected a number from 0 to 1.",
          body + "/continuous: found 1; expected true or false.", no_gravity}},
        {falling("\"friction\": 1"),
         {body + "/friction: unknown key 'friction'. Choose from mass, density, "
                 "linear_damping, angular_damping, velocity, turn_rad_per_s or continuous.",
          no_gravity}},
        {one_object(", \"motion\": {\"body\": {}, \"velocity\": [1, 2, 3]}"),
         {"line 4: /objects/0/motion/velocity: a body cannot have velocity: it is rigid, and "
          "contacts and gravity move it. Its initial velocities belong in 'body'.",
          no_gravity}},
        {one_object(", \"material\": {\"friction\": -1, \"restitution\": 2}"),
         {"line 4: /objects/0/material/friction: found -1; expected a number, 0 or more.",
          "line 4: /objects/0/material/restitution: found 2; expected a number from 0 to 1."}},
        {"{\"cdprep_scene\": 1, \"layers\": [], \"objects\": [], \"gravity\": 9.81,\n"
         "\"dynamics\": {\"substeps\": 0, \"rest_gap\": 0, \"sleeps\": 1, \"steps\": 3}}",
         {"line 1: /gravity: found 9.81; expected an array of 3 numbers.",
          "line 2: /dynamics/steps: unknown key 'steps'. Choose from substeps, iterations, "
          "rest_gap, most_speed, tolerance, sleep_speed, most_contacts or sleeps."}},
        {"{\"cdprep_scene\": 1, \"layers\": [], \"objects\": [],\n"
         "\"dynamics\": {\"substeps\": 0, \"rest_gap\": 0, \"sleeps\": 1}}",
         {"line 2: /dynamics/substeps: found 0; expected a whole number from 1 to 1000000.",
          "line 2: /dynamics/rest_gap: found 0; expected a number above 0.",
          "line 2: /dynamics/sleeps: found 1; expected true or false."}},
    };
    for (const Mistake& mistake : mistakes) {
        const SceneReading reading = folder.read(mistake.text);
        ASSERT_EQ(reading.errors.size(), mistake.errors.size())
            << mistake.text << "\n"
            << ::testing::PrintToString(reading.errors);
        for (std::size_t i = 0; i < mistake.errors.size(); ++i) {
            EXPECT_EQ(reading.errors[i], "s.json: " + mistake.errors[i]);
        }
    }
}

/// A motion with this change.
std::string changing(const std::string& change) {
    return one_object(", \"motion\": {" + change + "}");
}

TEST(ReadScene, ReadsChangesOfModels) {
    const Folder folder;
    const SceneFile scene = folder.scene(R"({"cdprep_scene": 1, "layers": ["a"], "objects": [
        {"name": "still", "model": "crate.obj", "layer": "a", "motion": {"velocity": [1, 0, 0]}},
        {"name": "rate", "model": "crate.obj", "layer": "a", "pose": {"translation": [1, 2, 3]},
         "motion": {"deform": {"shear": {"of": "x", "along": "z", "rate_per_s": -2}}}},
        {"name": "wave", "model": "crate.obj", "layer": "a", "motion": {"velocity": [1, 0, 0],
         "deform": {"shear": {"of": "y", "along": "x", "amplitude": 3, "period_s": 4}}}},
        {"name": "twist", "model": "crate.obj", "layer": "a",
         "motion": {"path": [{"time_s": 0, "pose": {}}, {"time_s": 1, "pose": {}}],
                    "deform": {"twist": {"axis": "y", "angle_rad": 5, "period_s": 6}},
                    "tear": {"plane": {"point": [1, 2, 3], "normal": [0, 0, 2]}, "time_s": -7}}},
        {"name": "stream", "model": "crate.obj", "layer": "a",
         "instances": {"counts": [2, 1, 1], "spacing": [1, 0, 0]},
         "motion": {"deform": {"stream": {"file": "gate.obj", "step_s": 8, "repeats": true}}}},
        {"name": "again", "model": "gate.obj", "layer": "a",
         "motion": {"deform": {"stream": {"repeats": true, "step_s": 8, "file": "./gate.obj"}}}},
        {"name": "torn", "model": "crate.obj", "layer": "a",
         "motion": {"tear": {"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}, "time_s": 9,
                             "opening": 10}}}]})");
    std::vector<std::uint32_t> changes;
    for (const FileObject& object : scene.objects) changes.push_back(object.change);
    EXPECT_EQ(changes, (std::vector<std::uint32_t>{kUnchanged, 0, 1, 2, 3, 3, 3, 4}));
    ASSERT_EQ(scene.changes.size(), 5u);
    const auto expect_deform = [&](std::size_t number, const Deform& deform) {
        EXPECT_TRUE(scene.changes[number].deform == deform) << number;
    };
    expect_deform(0, Shear{.of = 0, .along = 2, .rate_per_s = -2});
    expect_deform(1, Shear{.of = 1, .along = 0, .amplitude = 3, .period_s = 4});
    expect_deform(2, Twist{.axis = 1, .angle_rad = 5, .period_s = 6});
    expect_deform(3, Stream{.file = std::get<Stream>(*scene.changes[3].deform).file,
                            .step_s = 8,
                            .repeats = true});
    EXPECT_EQ(std::get<Stream>(*scene.changes[3].deform).file.filename(), "gate.obj");
    EXPECT_FALSE(scene.changes[4].deform);
    EXPECT_EQ(scene.changes[2].tear, (Tear{.point = {1, 2, 3}, .normal = {0, 0, 2}, .time_s = -7}));
    EXPECT_EQ(scene.changes[4].tear, (Tear{.normal = {1, 0, 0}, .time_s = 9, .opening = 10}));
    EXPECT_FALSE(scene.motions[scene.objects[1].motion].moves());
    EXPECT_TRUE(scene.motions[scene.objects[2].motion].moves());
    EXPECT_EQ(pose_of(scene, scene.objects[1], 1)->translation(), (Double3{1, 2, 3}));
}

// By hand: each sentence.
TEST(ReadScene, NamesMistakesOfChanges) {
    const Folder folder;
    const std::string motion = "line 4: /objects/0/motion";
    const std::vector<Mistake> mistakes = {
        {changing("\"deform\": {}"),
         {motion + "/deform: a deform has exactly one of shear, twist and stream."}},
        {changing("\"deform\": {\"shear\": {}, \"twist\": {}}"),
         {motion + "/deform: a deform has exactly one of shear, twist and stream."}},
        {changing("\"deform\": {\"bend\": 1}"),
         {motion + "/deform/bend: unknown key 'bend'. Choose from shear, twist or stream."}},
        {changing("\"deform\": {\"shear\": {\"of\": \"x\", \"along\": \"x\"}}"),
         {motion + "/deform/shear: of and along are both x; they must differ.",
          motion + "/deform/shear: a shear has either a rate_per_s, or an amplitude and a "
                   "period_s."}},
        {changing("\"deform\": {\"shear\": {\"of\": \"w\", \"rate_per_s\": \"2\"}}"),
         {motion + "/deform/shear/of: 'w' is not an axis. Choose from x, y or z.",
          motion + "/deform/shear: the key 'along' is missing.",
          motion + "/deform/shear/rate_per_s: found \"2\"; expected a number."}},
        {changing("\"deform\": {\"shear\": {\"of\": \"x\", \"along\": \"y\", \"amplitude\": 1}}"),
         {motion + "/deform/shear: the key 'period_s' is missing."}},
        {changing("\"deform\": {\"twist\": {\"axis\": 1, \"period_s\": 0}}"),
         {motion + "/deform/twist/axis: found 1; expected an axis: x, y or z",
          motion + "/deform/twist: the key 'angle_rad' is missing.",
          motion + "/deform/twist/period_s: found 0; expected a number above 0."}},
        {changing("\"deform\": {\"stream\": {\"file\": \"none.pc2\", \"repeats\": 1}}"),
         {motion + "/deform/stream/file: there is no file ",
          motion + "/deform/stream: the key 'step_s' is missing.",
          motion + "/deform/stream/repeats: found 1; expected true or false."}},
        {changing("\"tear\": {\"opening\": -1}"),
         {motion + "/tear: the key 'plane' is missing.",
          motion + "/tear: the key 'time_s' is missing.",
          motion + "/tear/opening: found -1; expected a number, 0 or more."}},
        {changing(
             "\"tear\": {\"time_s\": 0, \"plane\": {\"point\": [1e302, 0, 0], \"normal\": [0, 0, "
             "0]}}"),
         {motion + "/tear/plane/point: found [1e+302,0,0]; expected coordinates of at most 2^1000.",
          motion + "/tear/plane/normal: found [0,0,0]; expected a vector with a direction."}},
    };
    for (const Mistake& mistake : mistakes) {
        const SceneReading reading = folder.read(mistake.text);
        EXPECT_FALSE(reading.scene) << mistake.text;
        ASSERT_EQ(reading.errors.size(), mistake.errors.size())
            << mistake.text << "\n"
            << ::testing::PrintToString(reading.errors);
        for (std::size_t i = 0; i < mistake.errors.size(); ++i) {
            EXPECT_EQ(reading.errors[i].substr(0, 8 + mistake.errors[i].size()),
                      "s.json: " + mistake.errors[i]);
        }
    }
}

TEST(ReadScene, NamesTheEntryOfAMatrixThatIsNoRotation) {
    const Folder folder;
    const SceneReading reading = folder.read(
        one_object(", \"pose\": {\"matrix\": [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}"));
    ASSERT_EQ(reading.errors.size(), 1u);
    EXPECT_NE(reading.errors[0].find("s.json: line 4: /objects/0/pose: "), std::string::npos);
}

TEST(ReadScene, RefusesAFileThatIsNotThere) {
    const SceneReading reading = read_scene("no/such/scene.json");
    EXPECT_FALSE(reading.scene);
    ASSERT_EQ(reading.errors.size(), 1u);
    EXPECT_NE(reading.errors[0].find("no/such/scene.json"), std::string::npos);
}

TEST(ReadScene, FindsModelsBesideTheFile) {
    const test::ScratchFolder folder;
    folder.write("crate.obj", std::string_view());
    const SceneReading reading = read_scene(folder.write("s.json", one_object("")));
    ASSERT_TRUE(reading.scene) << reading.errors[0];
    EXPECT_EQ(reading.scene->models[0], folder.path() / "crate.obj");
}

}  // namespace
}  // namespace cdprep::scenes
