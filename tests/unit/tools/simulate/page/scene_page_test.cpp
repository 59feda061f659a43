// SPDX-License-Identifier: MIT
#include "simulate/page/scene_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "page/page_text.h"
#include "simulate/page/scene_chart.h"
#include "simulate/page/scene_geometry.h"
#include "unit/tools/simulate/page/page_scene.h"

namespace cdprep::report {
namespace {

using nlohmann::json;
using test::element_of;
using test::PageScene;
using test::unpacked;

constexpr std::uint64_t kRunFrames = 25;  // from apart, through each other, to apart

std::string page_of_run(const PageScene& scene, PageScene& file, const ScenePageOptions& options,
                        std::vector<std::string>* left_out = nullptr) {
    ScenePage page(file.file(), scene.models(), kRunFrames, options);
    const scenes::Simulation simulation =
        scene.run(kRunFrames, [&](std::uint64_t frame, const scenes::Simulation& now) {
            EXPECT_TRUE(page.add_frame(frame, now));
        });
    std::string text = page.finish(simulation);
    if (left_out != nullptr) *left_out = page.left_out();
    return text;
}

std::string page_of_run(PageScene& scene, const ScenePageOptions& options = {},
                        std::vector<std::string>* left_out = nullptr) {
    return page_of_run(scene, scene, options, left_out);
}

/// The map from page units to the world.
struct PageUnits {
    Double3 centre;
    int exponent;

    explicit PageUnits(const json& data)
        : centre{data["centre"][0], data["centre"][1], data["centre"][2]},
          exponent(data["exponent"]) {}

    [[nodiscard]] Double3 to_world(const float* p) const {
        return {centre.x + std::ldexp(p[0], exponent), centre.y + std::ldexp(p[1], exponent),
                centre.z + std::ldexp(p[2], exponent)};
    }
};

void expect_near(const Double3& p, const Double3& q, double tolerance) {
    EXPECT_NEAR(p.x, q.x, tolerance);
    EXPECT_NEAR(p.y, q.y, tolerance);
    EXPECT_NEAR(p.z, q.z, tolerance);
}

/// Returns a point turned by a quaternion w, x, y, z: p + 2 u x (u x p + w p).
Double3 turned_by(const float* q, const Double3& p) {
    const auto cross = [](const Double3& a, const Double3& b) {
        return Double3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const Double3 u{q[1], q[2], q[3]};
    Double3 inner = cross(u, p);
    inner = {inner.x + q[0] * p.x, inner.y + q[0] * p.y, inner.z + q[0] * p.z};
    const Double3 outer = cross(u, inner);
    return {p.x + 2 * outer.x, p.y + 2 * outer.y, p.z + 2 * outer.z};
}

std::uint32_t object_in(const scenes::SceneFile& file, const scenes::Simulation& simulation,
                        ObjectId id) {
    return static_cast<std::uint32_t>(&simulation.object(id) - file.objects.data());
}

/// Checks the results of a frame on the page, but for poses, against the scene.
void expect_answers(const json& shown, const scenes::SceneFile& file,
                    const scenes::Simulation& simulation, const PageUnits& page) {
    const Scene& scene = simulation.scene();
    const auto number = [&](ObjectId id) { return object_in(file, simulation, id); };
    const double rounding = std::ldexp(1e-6, page.exponent);

    std::map<std::uint32_t, std::set<std::uint32_t>> lit;
    for (const SceneOverlaps& list : scene.overlaps()) {
        for (const TrianglePair& pair : list.triangles) {
            lit[number(list.a)].insert(pair.a);
            lit[number(list.b)].insert(pair.b);
        }
    }
    for (const SceneDistance& item : scene.distances()) {
        if (item.distance.upper > 0) continue;
        lit[number(item.a)].insert(item.distance.triangle_a);
        lit[number(item.b)].insert(item.distance.triangle_b);
    }
    ASSERT_EQ(shown["lit"].size(), lit.size());
    for (const json& one : shown["lit"]) {
        const auto triangles = unpacked<std::uint32_t>(one[1]);
        const auto& expected = lit.at(one[0]);
        EXPECT_TRUE(std::ranges::equal(triangles, expected));
    }

    const auto hits = unpacked<std::uint32_t>(shown["hits"]);
    ASSERT_EQ(hits.size(), 3 * scene.hits().size());
    for (std::size_t i = 0; i < scene.hits().size(); ++i) {
        EXPECT_EQ(hits[3 * i], number(scene.hits()[i].a));
        EXPECT_EQ(hits[3 * i + 1], number(scene.hits()[i].b));
        for (std::size_t k = 0; k < kSceneEffects.size(); ++k) {
            EXPECT_EQ(hits[3 * i + 2] >> k & 1, contains(scene.hits()[i].holds, kSceneEffects[k]));
        }
    }

    const auto contacts = unpacked<float>(shown["contacts"]);
    ASSERT_EQ(contacts.size(), 8 * scene.counts().contacts);
    std::size_t at = 0;
    for (const SceneContacts& list : scene.contacts()) {
        for (const Contact& contact : list.contacts) {
            const float* const c = &contacts[8 * at++];
            const Double3 p = page.to_world(c);
            // As far from the point on a as from that on b.
            expect_near({2 * p.x - contact.point_a.x, 2 * p.y - contact.point_a.y,
                         2 * p.z - contact.point_a.z},
                        contact.point_b, 2 * rounding);
            expect_near({c[3], c[4], c[5]}, contact.normal, 1e-6);
            EXPECT_EQ(c[6], static_cast<float>(contact.lower));
            EXPECT_EQ(c[7], static_cast<float>(contact.upper));
        }
    }

    const auto distances = unpacked<float>(shown["distances"]);
    ASSERT_EQ(distances.size(), 8 * scene.distances().size());
    for (std::size_t i = 0; i < scene.distances().size(); ++i) {
        const Distance& found = scene.distances()[i].distance;
        expect_near(page.to_world(&distances[8 * i]), found.witness_a, rounding);
        expect_near(page.to_world(&distances[8 * i + 3]), found.witness_b, rounding);
        EXPECT_EQ(distances[8 * i + 7], static_cast<float>(found.upper));
    }
    EXPECT_EQ(shown["counts"]["candidates"], scene.counts().candidates);
    EXPECT_EQ(shown["counts"]["triangle_pairs"], scene.counts().triangle_pairs);
    json calls = scene.counts().calls;
    calls.push_back(0);  // of response, which nobody asks for
    EXPECT_EQ(shown["calls"], calls);
}

TEST(ScenePage, FramesAreTheAnswersOfTheScene) {
    PageScene scene;
    const std::string text = page_of_run(scene);
    const json frames = element_of(text, "frame-data");
    const PageUnits page(element_of(text, "scene-data"));
    ASSERT_EQ(frames.size(), kRunFrames);
    std::size_t overlaps = 0;
    std::size_t contacts = 0;
    std::size_t apart = 0;
    scene.run(kRunFrames, [&](std::uint64_t frame, const scenes::Simulation& simulation) {
        EXPECT_EQ(frames[frame]["frame"], frame);
        expect_answers(frames[frame], scene.file(), simulation, page);
        overlaps += simulation.scene().overlaps().empty() ? 0 : 1;
        contacts += simulation.scene().contacts().empty() ? 0 : 1;
        apart += simulation.scene().hits().empty() ? 1 : 0;
    });
    EXPECT_GT(overlaps, 3u);
    EXPECT_GT(contacts, 3u);
    EXPECT_GT(apart, 3u);
}

TEST(ScenePage, VerticesAreWhereThePosesMoveThem) {
    PageScene scene;
    const std::string text = page_of_run(scene);
    const json data = element_of(text, "scene-data");
    const json frames = element_of(text, "frame-data");
    const PageUnits page(data);
    const auto model = unpacked<float>(element_of(text, "model-data")[0]["positions"]);
    ASSERT_EQ(model.size(), 3 * scene.torus().vertex_count());
    // Each vertex is drawn once, in the order of its first use by source numbers.
    std::vector<std::array<float, 7>> poses(scene.file().objects.size());
    std::vector<bool> present(poses.size());
    const auto corner = unpacked<std::uint32_t>(element_of(text, "model-data")[0]["indices"]);
    scene.run(kRunFrames, [&](std::uint64_t frame, const scenes::Simulation& simulation) {
        const auto moved = unpacked<std::uint32_t>(frames[frame]["moved"]);
        const auto packed = unpacked<float>(frames[frame]["poses"]);
        ASSERT_EQ(packed.size(), 7 * moved.size());
        EXPECT_EQ(moved.size(), frame == 0 ? 4u : 1u) << "still objects stay";
        for (std::size_t i = 0; i < moved.size(); ++i) {
            std::copy_n(&packed[7 * i], 7, poses[moved[i]].begin());
            present[moved[i]] = true;
        }
        const auto& tree = scene.torus().mesh();
        const auto numbers = scene.torus().source().triangle;
        for (std::uint32_t slot = 0; slot < simulation.poses().size(); ++slot) {
            const ObjectId id = simulation.scene().object_at(slot);
            const std::uint32_t object = object_in(scene.file(), simulation, id);
            ASSERT_TRUE(present[object]);
            const float* const q = poses[object].data();
            for (std::size_t place = 0; place < numbers.size(); place += 7) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const float* const p = &model[3 * corner[3 * numbers[place] + k]];
                    const Double3 turned = turned_by(q, {p[0], p[1], p[2]});
                    const std::array<float, 3> at = {static_cast<float>(turned.x) + q[4],
                                                     static_cast<float>(turned.y) + q[5],
                                                     static_cast<float>(turned.z) + q[6]};
                    const Float3& stored = tree.positions_f32[tree.triangles[place].vertex[k]];
                    expect_near(
                        page.to_world(at.data()),
                        transform_point(simulation.poses()[slot], {stored.x, stored.y, stored.z}),
                        std::ldexp(1e-6, page.exponent));
                }
            }
        }
    });
    EXPECT_EQ(data["models"][1]["drawn"], "none");
    EXPECT_EQ(data["objects"][0][3], 0) << "nobody asks for it";
    EXPECT_EQ(data["objects"][3][3], 1);
}

TEST(ScenePage, EventsAndSpansAreThoseOfTheRun) {
    PageScene scene;
    const json data = element_of(page_of_run(scene), "scene-data");
    const auto listed = unpacked<std::uint32_t>(data["events"]);
    std::vector<std::uint32_t> expected;
    const json& spans = data["spans"];
    ASSERT_EQ(spans["frames"].size(), kRunFrames);
    scene.run(kRunFrames, [&](std::uint64_t frame, const scenes::Simulation& simulation) {
        std::array<std::uint64_t, kSimulatedEffects.size()> begins{};
        for (const SceneEvent& event : simulation.scene().events()) {
            const auto effect = static_cast<std::uint32_t>(
                std::ranges::find(kSceneEffects, event.effect) - kSceneEffects.begin());
            begins[effect] += event.kind == EventKind::begins ? 1 : 0;
            expected.insert(expected.end(), {static_cast<std::uint32_t>(frame),
                                             object_in(scene.file(), simulation, event.a),
                                             object_in(scene.file(), simulation, event.b),
                                             effect + 16 * static_cast<std::uint32_t>(event.kind) +
                                                 64 * static_cast<std::uint32_t>(event.reason)});
        }
        EXPECT_EQ(spans["begins"][frame], json(begins)) << frame;
        EXPECT_EQ(spans["holds"][frame][3], simulation.scene().distances().size()) << frame;
    });
    EXPECT_GE(expected.size(), 4u * 10) << "five effects begin and end";
    EXPECT_EQ(listed, expected);
    for (std::size_t i = 0; i < kSimulatedEffects.size(); ++i) {
        EXPECT_EQ(data["effects"][i]["asked"], i < 5) << "the first five are asked for";
    }
}

/// The torus of the scene that moves twists too.
void twist_moving(PageScene& scene) {
    scene.file().pairs[0].asked = {.a = 0, .b = 1, .effects = Ask::collide | Ask::deform};
    scene.file().changes = {{.deform = scenes::Twist{.axis = 0, .angle_rad = 1, .period_s = 3}}};
    scene.file().objects[3].change = 0;
}

// The oracle is the live model itself, by the numbers of the imported file.
TEST(ScenePage, LiveModelsHaveTheShapeOfEachFrame) {
    PageScene scene;
    twist_moving(scene);
    const std::string page = page_of_run(scene);
    const json data = element_of(page, "scene-data");
    ASSERT_EQ(data["changing"].size(), 1u);
    EXPECT_EQ(data["changing"][0]["objects"], json::array({3}));
    const json& topology = data["changing"][0]["topologies"][0];
    const std::size_t triangles = scene.torus().triangle_count();
    EXPECT_EQ(unpacked<std::uint32_t>(topology["indices"]).size(), 3 * triangles);
    const json frames = element_of(page, "frame-data");
    const double unit = std::ldexp(1.0, data["exponent"].get<int>());
    scene.run(kRunFrames, [&](std::uint64_t frame, const scenes::Simulation& simulation) {
        const scenes::ChangingModel& live = simulation.changing()[0].live;
        ASSERT_EQ(frames[frame]["shapes"].size(), 1u) << frame;
        const auto drawn = unpacked<float>(frames[frame]["shapes"][0][2]);
        const auto positions = live.positions();
        ASSERT_EQ(drawn.size(), 3 * positions.size());
        const Double3 middle = live.rest_box().middle();
        for (std::size_t i = 0; i < positions.size(); ++i) {
            EXPECT_NEAR(unit * drawn[3 * i], positions[i].x - middle.x, 1e-6);
            EXPECT_NEAR(unit * drawn[3 * i + 2], positions[i].z - middle.z, 1e-6);
        }
    });
}

TEST(ScenePage, LargeLiveModelsAreDrawnAtRest) {
    PageScene scene;
    twist_moving(scene);
    ScenePageOptions options;
    options.limits.changing = scene.torus().triangle_count() - 1;
    std::vector<std::string> left_out;
    const std::string page = page_of_run(scene, options, &left_out);
    EXPECT_TRUE(element_of(page, "scene-data")["changing"][0].is_null());
    EXPECT_TRUE(element_of(page, "frame-data")[1]["shapes"].empty());
    const std::string expected = "'moving' deforms or tears, but is drawn at rest because it has " +
                                 std::to_string(scene.torus().triangle_count()) + " triangles.";
    EXPECT_EQ(std::ranges::count(left_out, expected), 1) << ::testing::PrintToString(left_out);
}

// Each limit has its sentence, and nothing else has one.
TEST(ScenePage, SaysWhatItLeavesOut) {
    const auto told = [](const ScenePageOptions& options) {
        PageScene scene;
        std::vector<std::string> left_out;
        const std::string page = page_of_run(scene, options, &left_out);
        EXPECT_EQ(element_of(page, "scene-data")["left_out"], json(left_out));
        const std::string unused =
            "unused.obj is not drawn: no pair of layers uses its objects, so it was not opened.";
        EXPECT_EQ(std::ranges::count(left_out, unused), 1);
        std::erase(left_out, unused);
        return left_out;
    };
    EXPECT_EQ(told({}), std::vector<std::string>{});
    EXPECT_EQ(told({.limits = {.frames = 10}}),
              std::vector<std::string>{"The page shows every 4th of 25 frames, and the last one. "
                                       "The lanes count all frames."});
    EXPECT_EQ(told({.events = 3}).size(), 1u);
    EXPECT_NE(told({.events = 3})[0].find("events of late frames are not listed"),
              std::string::npos);
    EXPECT_NE(told({.limits = {.lit = 5}})[0].find("touching triangles in all shown frames"),
              std::string::npos);
    const std::vector<std::string> few = told({.limits = {.objects = 2}});
    ASSERT_EQ(few.size(), 5u);
    EXPECT_EQ(few[0], "The page has 2 of 4 objects: the first ones in the file.");
    EXPECT_NE(told({.triangles = 100})[0].find(
                  "torus.obj is drawn coarsely because it has 192 triangles"),
              std::string::npos);
}

// What touches of a model that is drawn coarsely has the corners of the model.
TEST(ScenePage, TouchingTrianglesOfACoarseModelAreExact) {
    PageScene scene;
    const std::string text = page_of_run(scene, {.triangles = 100});
    const json model = element_of(text, "model-data")[0];
    const auto numbers = unpacked<std::uint32_t>(model["numbers"]);
    const auto corners = unpacked<float>(model["lit"]);
    ASSERT_GT(numbers.size(), 10u);
    ASSERT_EQ(corners.size(), 9 * numbers.size());
    PageScene exact_scene;
    const json exact = element_of(page_of_run(exact_scene), "model-data")[0];
    EXPECT_FALSE(exact.contains("numbers"));
    const auto positions = unpacked<float>(exact["positions"]);
    const auto indices = unpacked<std::uint32_t>(exact["indices"]);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        for (std::size_t k = 0; k < 9; ++k) {
            EXPECT_EQ(corners[9 * i + k], positions[3 * indices[3 * numbers[i] + k / 3] + k % 3]);
        }
    }
}

TEST(ScenePage, UpIsAgainstGravityOrAsTheFileSays) {
    PageScene scene;
    const auto y_is_up = [&](bool of_file, std::optional<Double3> gravity) -> bool {
        scene.file().y_is_up = of_file;
        scene.file().dynamics.gravity = gravity;
        return element_of(page_of_run(scene), "scene-data")["y_is_up"];
    };
    EXPECT_FALSE(y_is_up(false, std::nullopt));
    EXPECT_TRUE(y_is_up(true, std::nullopt));
    EXPECT_TRUE(y_is_up(false, Double3{0, -9.81, 1}));
    EXPECT_FALSE(y_is_up(true, Double3{0, 0, -9.81}));
}

TEST(ScenePage, NamesCannotEndTheirElement) {
    PageScene plain;
    PageScene hostile;
    hostile.file().name = "</script><script>alert(1)</script><!--\xff@data@@three@.json";
    hostile.file().objects[1].name = "</script><img src=x onerror=alert(1)>";
    hostile.file().layers[0] = "</title><b>";
    const auto count = [](const std::string& text, std::string_view part) {
        std::size_t found = 0;
        for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
        return found;
    };
    const std::string as_plain = page_of_run(plain);
    const std::string as_hostile = page_of_run(hostile);
    for (const char* part : {"<script", "</script", "<!--", "<img", "</title", "<b>"}) {
        EXPECT_EQ(count(as_plain, part), count(as_hostile, part)) << part;
    }
    EXPECT_NE(as_plain.find("default-src 'none'"), std::string::npos);
    EXPECT_NE(as_plain.find("Permission is hereby granted, free of charge"), std::string::npos);
    const std::size_t three = as_plain.find(page::kThree);
    const std::string ours =
        as_plain.substr(0, three) + as_plain.substr(as_plain.find(page::kElements));
    for (const char* part : {"https:", "//cdn", "@import", "url(", " src=\"", "fetch("}) {
        EXPECT_EQ(ours.find(part), std::string::npos) << part;
    }
    EXPECT_EQ(ours.find("@js@"), std::string::npos);
}

TEST(SceneChart, HasEachStageAndNoMarkup) {
    PageScene scene;
    SceneTimeline timeline;
    scene.run(5, [&](std::uint64_t, const scenes::Simulation& now) { timeline.add(now); });
    const std::string svg = scene_svg(timeline, "<b>\x01.json", 0.25);
    EXPECT_NE(svg.find(">pair overhead</text>"), std::string::npos);
    EXPECT_NE(svg.find("class=\"stage s0\""), std::string::npos);
    EXPECT_NE(svg.find("&lt;b&gt;\\x01.json"), std::string::npos);
    EXPECT_EQ(svg.find("<b>"), std::string::npos);
}

}  // namespace
}  // namespace cdprep::report
