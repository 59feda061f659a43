// SPDX-License-Identifier: MIT
// Pictures of models and scenes: the shapes that are drawn, and what a caller can get wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "cdprep/cdprep.h"
#include "support/aligned_bytes.h"
#include "support/c_mistakes.h"
#include "support/c_models.h"
#include "support/float_modes.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/random_pose.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

using DrawnTriangle = std::array<double, 9>;
using DrawnLine = std::array<double, 6>;

/// What was drawn, in that order. Ends the picture after `most` shapes.
struct Picture {
    std::vector<DrawnTriangle> triangles;
    std::vector<DrawnLine> lines;
    std::vector<std::string> labels;
    std::vector<std::array<double, 3>> places;  ///< of labels
    std::vector<std::uint32_t> colours;         ///< of triangles
    std::vector<std::uint64_t> controls;        ///< of the floating-point unit, in each call
    std::size_t most = SIZE_MAX;

    [[nodiscard]] std::size_t size() const {
        return triangles.size() + lines.size() + labels.size();
    }
    int next() {
        controls.push_back(control_bits(format::float_control()));
        return size() < most ? 1 : 0;
    }
    static int add_line(void* picture, const double* start, const double* end,
                        std::uint32_t /*rgba*/) {
        auto* const self = static_cast<Picture*>(picture);
        self->lines.push_back({start[0], start[1], start[2], end[0], end[1], end[2]});
        return self->next();
    }
    static int add_triangle(void* picture, const double* corners, std::uint32_t rgba) {
        auto* const self = static_cast<Picture*>(picture);
        DrawnTriangle to{};
        std::copy_n(corners, 9, to.begin());
        self->triangles.push_back(to);
        self->colours.push_back(rgba);
        return self->next();
    }
    static int add_label(void* picture, const double* at, const char* text,
                         std::uint32_t /*rgba*/) {
        auto* const self = static_cast<Picture*>(picture);
        self->labels.emplace_back(text);
        self->places.push_back({at[0], at[1], at[2]});
        return self->next();
    }
};

cdprep_draw draw_into(Picture& picture, std::uint32_t what, std::uint32_t level = 0) {
    cdprep_draw draw;
    cdprep_draw_init(&draw, sizeof draw);
    draw.what = what;
    draw.level = level;
    draw.line = Picture::add_line;
    draw.triangle = Picture::add_triangle;
    draw.label = Picture::add_label;
    draw.context = &picture;
    return draw;
}

constexpr cdprep_pose kStill = {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}};

Picture picture_of(const cdprep_model* model, const cdprep_pose& pose, std::uint32_t what,
                   std::uint32_t level = 0) {
    Picture picture;
    const cdprep_draw draw = draw_into(picture, what, level);
    cdprep_error error;
    EXPECT_EQ(cdprep_model_draw(model, &pose, &draw, &error), CDPREP_OK) << error.message;
    return picture;
}

/// The triangles of a model, moved, one by one.
std::vector<DrawnTriangle> moved_triangles(const cdprep_model* model, const cdprep_pose& pose) {
    cdprep_model_info info;
    EXPECT_EQ(cdprep_model_describe(model, &info, nullptr), CDPREP_OK);
    std::vector<DrawnTriangle> all(info.triangles);
    for (std::uint32_t i = 0; i < info.triangles; ++i) {
        cdprep_corners corners;
        EXPECT_EQ(cdprep_model_corners(model, &i, 1, &corners, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_pose_move(&pose, corners.point[0], 3, all[i].data(), nullptr), CDPREP_OK);
    }
    return all;
}

template <class Shape>
std::vector<Shape> in_order(std::vector<Shape> shapes) {
    std::sort(shapes.begin(), shapes.end());
    return shapes;
}

/// Six times the volume that triangles enclose; negative if they are inside out.
double six_volumes(const std::vector<DrawnTriangle>& triangles) {
    double sum = 0;
    for (const DrawnTriangle& t : triangles) {
        sum += t[0] * (t[4] * t[8] - t[5] * t[7]) - t[1] * (t[3] * t[8] - t[5] * t[6]) +
               t[2] * (t[3] * t[7] - t[4] * t[6]);
    }
    return sum;
}

AlignedBytes baked_for_pictures(const TestMesh& mesh) {
    return with_hulls(with_contacts(with_one_piece(bake_tiny(mesh.positions, mesh.triangles))));
}

TEST(CDraw, ASurfaceIsEveryTriangleAsItIsMoved) {
    const AlignedBytes file = baked_for_pictures(icosphere(2));
    const CModel ball(file);
    std::mt19937 random(3);
    const cdprep_pose pose = rows_in_c(random_pose(random, 10));
    const Picture picture = picture_of(ball.get(), pose, CDPREP_DRAW_SURFACE);
    EXPECT_EQ(picture.triangles.size(), 320u);
    EXPECT_EQ(picture.size(), 320u);
    EXPECT_EQ(in_order(picture.triangles), in_order(moved_triangles(ball.get(), pose)));
}

// By hand: a cube of side 1. Its hull and its only piece are the cube.
TEST(CDraw, HullsAndPiecesEncloseACube) {
    const AlignedBytes file = baked_for_pictures(unit_cube());
    const CModel cube(file);
    for (const std::uint32_t what : {CDPREP_DRAW_HULLS, CDPREP_DRAW_PIECES, CDPREP_DRAW_SURFACE}) {
        const Picture picture = picture_of(cube.get(), kStill, what);
        EXPECT_EQ(picture.triangles.size(), 12u) << what;
        EXPECT_NEAR(six_volumes(picture.triangles), 6, 1e-12) << what;
        for (const DrawnTriangle& triangle : picture.triangles) {
            for (const double x : triangle) EXPECT_TRUE(x == 0 || x == 1) << what;
        }
    }
    const Picture numbered = picture_of(
        cube.get(), kStill, CDPREP_DRAW_HULLS | CDPREP_DRAW_PIECES | CDPREP_DRAW_NUMBERS);
    EXPECT_EQ(numbered.labels, (std::vector<std::string>{"0", "0"}));
    EXPECT_EQ(numbered.places[0], (std::array<double, 3>{0.5, 0.5, 0.5}));
    EXPECT_EQ(numbered.triangles.size(), 24u);
}

// Each triangle is a piece, and has a number and one of eight colours.
TEST(CDraw, PiecesHaveNumbersAndColours) {
    const TestMesh mesh = icosphere(1);
    const AlignedBytes file = with_contacts(with_pieces(bake_tiny(mesh.positions, mesh.triangles)));
    const CModel ball(file);
    const Picture picture =
        picture_of(ball.get(), kStill, CDPREP_DRAW_PIECES | CDPREP_DRAW_NUMBERS);
    ASSERT_EQ(picture.labels.size(), 80u);
    EXPECT_EQ(picture.labels[79], "79");
    std::vector<std::uint32_t> colours = in_order(picture.colours);
    colours.erase(std::unique(colours.begin(), colours.end()), colours.end());
    EXPECT_EQ(colours.size(), 8u);
}

/// The box around 12 lines, which must be the edges of that box.
std::array<double, 6> box_of_lines(const DrawnLine* lines) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    std::array<double, 6> box = {kInf, kInf, kInf, -kInf, -kInf, -kInf};
    std::array<std::size_t, 3> along{};
    for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
            box[k % 3] = std::min(box[k % 3], lines[i][k]);
            box[3 + k % 3] = std::max(box[3 + k % 3], lines[i][k]);
        }
    }
    for (std::size_t i = 0; i < 12; ++i) {
        std::size_t changes = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double from = lines[i][axis], to = lines[i][3 + axis];
            EXPECT_TRUE(from == box[axis] || from == box[3 + axis]);
            EXPECT_TRUE(to == box[axis] || to == box[3 + axis]);
            if (from == to) continue;
            ++changes;
            ++along[axis];
        }
        EXPECT_EQ(changes, 1u);
    }
    for (const std::size_t count : along) EXPECT_EQ(count, 4u);
    return box;
}

bool box_holds(const std::array<double, 6>& box, const double* point) {
    return point[0] >= box[0] && point[1] >= box[1] && point[2] >= box[2] && point[0] <= box[3] &&
           point[1] <= box[4] && point[2] <= box[5];
}

// 320 triangles: 40 leaves of 8, in 5 nodes, below a root.
TEST(CDraw, BoxesOfEachLevelHoldTheTriangles) {
    const AlignedBytes file = baked_for_pictures(icosphere(2));
    const CModel ball(file);
    const std::vector<DrawnTriangle> triangles = moved_triangles(ball.get(), kStill);
    const std::array<std::size_t, 5> expected = {1, 5, 40, 40, 40};
    for (std::uint32_t level = 0; level < expected.size(); ++level) {
        const std::uint32_t asked = level == 4 ? UINT32_MAX : level;
        const Picture picture = picture_of(ball.get(), kStill, CDPREP_DRAW_BOXES, asked);
        ASSERT_EQ(picture.lines.size(), 12 * expected[level]) << level;
        std::vector<std::array<double, 6>> boxes;
        for (std::size_t i = 0; i < expected[level]; ++i) {
            boxes.push_back(box_of_lines(&picture.lines[12 * i]));
        }
        std::size_t inside = 0;
        for (const DrawnTriangle& t : triangles) {
            inside += std::any_of(boxes.begin(), boxes.end(), [&](const auto& box) {
                return box_holds(box, &t[0]) && box_holds(box, &t[3]) && box_holds(box, &t[6]);
            });
        }
        EXPECT_EQ(inside, triangles.size()) << level;
    }
    const Picture whole = picture_of(ball.get(), kStill, CDPREP_DRAW_BOXES);
    for (const double x : box_of_lines(whole.lines.data())) EXPECT_NEAR(std::fabs(x), 1, 0.06);
}

TEST(CDraw, NothingIsDrawnOfNothing) {
    const CWorkspace workspace;
    cdprep_build_options options;
    cdprep_build_options_init(&options, sizeof options);
    const CBuilt empty(options, workspace.get());
    const std::uint32_t what = CDPREP_DRAW_SURFACE | CDPREP_DRAW_BOXES | CDPREP_DRAW_NUMBERS;
    EXPECT_EQ(picture_of(empty.get(), kStill, what).size(), 0u);
    EXPECT_EQ(picture_of(empty.get(), kStill, what, 3).size(), 0u);
    const AlignedBytes file = baked_for_pictures(unit_cube());
    const CModel cube(file);
    EXPECT_EQ(picture_of(cube.get(), kStill, 0).size(), 0u);
}

TEST(CDraw, AFunctionThatReturnsZeroEndsThePicture) {
    const AlignedBytes file = baked_for_pictures(icosphere(1));
    const CModel ball(file);
    const std::uint32_t what = CDPREP_DRAW_SURFACE | CDPREP_DRAW_BOXES | CDPREP_DRAW_HULLS |
                               CDPREP_DRAW_PIECES | CDPREP_DRAW_NUMBERS;
    const std::size_t all = picture_of(ball.get(), kStill, what, 1).size();
    ASSERT_GT(all, 250u);
    for (std::size_t most = 1; most <= all; ++most) {
        Picture picture;
        picture.most = most;
        const cdprep_draw draw = draw_into(picture, what, 1);
        ASSERT_EQ(cdprep_model_draw(ball.get(), &kStill, &draw, nullptr), CDPREP_OK);
        ASSERT_EQ(picture.size(), most);
    }
}

// The caller's functions see the caller's environment, and the same numbers in each.
TEST(CDraw, NoFloatModeChangesAPicture) {
    const TestMesh ball = icosphere(1);
    const AlignedBytes file = baked_for_pictures(ball);
    const CModel model(file);
    std::mt19937 random(9);
    const cdprep_pose pose = rows_in_c(random_pose(random, 0x1p-30));
    const std::uint32_t what = CDPREP_DRAW_SURFACE | CDPREP_DRAW_BOXES | CDPREP_DRAW_HULLS |
                               CDPREP_DRAW_PIECES | CDPREP_DRAW_NUMBERS;
    const Picture expected = picture_of(model.get(), pose, what, 2);
    for (const FloatMode& mode : float_modes()) {
        Picture picture;
        const cdprep_draw draw = draw_into(picture, what, 2);
        int code = 77;
        const std::uint64_t left =
            run_in(mode, [&] { code = cdprep_model_draw(model.get(), &pose, &draw, nullptr); });
        EXPECT_EQ(code, CDPREP_OK);
        EXPECT_EQ(left, control_bits(mode.control)) << mode.name;
        EXPECT_EQ(picture.triangles, expected.triangles) << mode.name;
        EXPECT_EQ(picture.lines, expected.lines) << mode.name;
        EXPECT_EQ(picture.places, expected.places) << mode.name;
        ASSERT_FALSE(picture.controls.empty());
        for (const std::uint64_t control : picture.controls) {
            EXPECT_EQ(control, control_bits(mode.control)) << mode.name;
        }
    }
}

// A torn sheet: what is gone is not drawn, and what has come is.
TEST(CDraw, ALiveModelIsDrawnAsItIs) {
    const TestMesh sheet = grid_sheet(8, 8);
    const AlignedBytes file = bake_tiny(sheet.positions, sheet.triangles);
    const CModel base(file);
    cdprep_live_options options;
    cdprep_live_options_init(&options, sizeof options);
    options.model = base.get();
    options.max_triangles = 200;
    cdprep_live* live = nullptr;
    ASSERT_EQ(cdprep_live_make(&options, nullptr, 0, &live, nullptr), CDPREP_OK);
    const std::array<std::uint32_t, 3> gone = {0, 3, 99}, corners = {0, 1, 2};
    std::uint32_t first = 0;
    ASSERT_EQ(cdprep_live_remove(live, gone.data(), 3, nullptr), CDPREP_OK);
    ASSERT_EQ(cdprep_live_append(live, corners.data(), 1, &first, nullptr), CDPREP_OK);
    std::vector<DrawnTriangle> expected;
    for (std::uint32_t i = 0; i <= first; ++i) {
        if (std::find(gone.begin(), gone.end(), i) != gone.end()) continue;
        cdprep_corners facts;
        ASSERT_EQ(cdprep_model_corners(cdprep_live_model(live), &i, 1, &facts, nullptr), CDPREP_OK);
        DrawnTriangle triangle{};
        std::memcpy(triangle.data(), facts.point, sizeof facts.point);
        expected.push_back(triangle);
    }
    const Picture picture = picture_of(cdprep_live_model(live), kStill, CDPREP_DRAW_SURFACE);
    EXPECT_EQ(picture.triangles.size(), sheet.triangles.size() - 2);
    EXPECT_EQ(in_order(picture.triangles), in_order(expected));
    const Picture boxes = picture_of(cdprep_live_model(live), kStill, CDPREP_DRAW_BOXES, 9);
    EXPECT_GT(boxes.lines.size(), 12u * 15);
    cdprep_live_end(live);
}

/// Two cubes and a third far away, in a scene that lists overlaps and contacts.
class CDrawnScene : public testing::Test {
protected:
    CDrawnScene() {
        cdprep_layer_pair pair;
        cdprep_layer_pair_init(&pair, sizeof pair);
        pair.effects = CDPREP_ASK_OVERLAP | CDPREP_ASK_CONTACTS;
        cdprep_contact_options contacts;
        cdprep_contact_options_init(&contacts, sizeof contacts);
        contacts.manifold = 4;
        pair.contacts = &contacts;
        cdprep_plan_options options;
        cdprep_plan_options_init(&options, sizeof options);
        options.layer_pairs = &pair;
        options.layer_pair_count = 1;
        options.max_objects = options.max_pairs = 8;
        options.max_triangle_pairs = 500;
        options.max_contacts = 50;
        cdprep_plan* plan = nullptr;
        EXPECT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_scene_make(plan, nullptr, 0, &scene_, nullptr), CDPREP_OK);
        cdprep_plan_end(plan);
        const std::array<double, 3> x = {0, 0.75, 10};
        for (std::size_t i = 0; i < 3; ++i) {
            ids_[i] = add(cube_.get(), x[i], 0);
        }
        cdprep_step step;
        EXPECT_EQ(cdprep_scene_step(scene_, workspace_.get(), &step, nullptr), CDPREP_OK);
        EXPECT_EQ(step.complete, std::uint32_t{CDPREP_YES});
    }
    ~CDrawnScene() override {
        cdprep_scene_end(scene_);
    }
    cdprep_object add(const cdprep_model* model, double x, std::uint32_t layer) {
        cdprep_object_options object;
        cdprep_object_options_init(&object, sizeof object);
        object.model = model;
        object.layer = layer;
        object.world_from_model.rows[9] = x;
        cdprep_object id{};
        cdprep_error error;
        EXPECT_EQ(cdprep_scene_add(scene_, &object, 1, &id, &error), CDPREP_OK) << error.message;
        return id;
    }
    Picture picture(std::uint32_t what) {
        Picture picture;
        const cdprep_draw draw = draw_into(picture, what);
        cdprep_error error;
        EXPECT_EQ(cdprep_scene_draw(scene_, &draw, &error), CDPREP_OK) << error.message;
        return picture;
    }
    static cdprep_pose at(double x) {
        cdprep_pose pose = kStill;
        pose.rows[9] = x;
        return pose;
    }

    AlignedBytes file_ = baked_for_pictures(unit_cube());
    CModel cube_{file_};
    CModel opened_for_inside_{file_, CDPREP_ASK_INSIDE};  ///< without numbers of triangles
    CWorkspace workspace_;
    cdprep_scene* scene_ = nullptr;
    std::array<cdprep_object, 3> ids_{};
};

TEST_F(CDrawnScene, ObjectsAreWhereTheyAre) {
    const Picture drawn = picture(CDPREP_DRAW_SURFACE | CDPREP_DRAW_NUMBERS);
    std::vector<DrawnTriangle> expected;
    for (const double x : {0.0, 0.75, 10.0}) {
        for (const DrawnTriangle& t : moved_triangles(cube_.get(), at(x))) expected.push_back(t);
    }
    EXPECT_EQ(in_order(drawn.triangles), in_order(expected));
    EXPECT_EQ(drawn.labels, (std::vector<std::string>{"0", "1", "2"}));
    EXPECT_NEAR(drawn.places[2][0], 10.5, 1e-5);
    EXPECT_NEAR(drawn.places[2][1], 0.5, 1e-5);
    EXPECT_EQ(picture(CDPREP_DRAW_BOXES).lines.size(), 36u);
}

TEST_F(CDrawnScene, OverlapsAreTheListedTriangles) {
    const cdprep_scene_overlap* lists = nullptr;
    std::size_t count = 0;
    ASSERT_EQ(cdprep_scene_overlaps(scene_, &lists, &count, nullptr), CDPREP_OK);
    ASSERT_EQ(count, 1u);
    std::vector<DrawnTriangle> expected;
    const std::vector<DrawnTriangle> a = moved_triangles(cube_.get(), at(0));
    const std::vector<DrawnTriangle> b = moved_triangles(cube_.get(), at(0.75));
    for (std::size_t i = 0; i < lists[0].count; ++i) {
        expected.push_back(a[lists[0].items[i].a]);
        expected.push_back(b[lists[0].items[i].b]);
    }
    EXPECT_GT(expected.size(), 10u);
    EXPECT_EQ(picture(CDPREP_DRAW_OVERLAPS).triangles, expected);
    // Where the objects are now; an object that is gone takes its lists with it.
    const cdprep_pose moved = at(0.5);
    ASSERT_EQ(cdprep_scene_set_poses(scene_, &ids_[1], &moved, 1, nullptr), CDPREP_OK);
    EXPECT_EQ(picture(CDPREP_DRAW_OVERLAPS).triangles[1],
              moved_triangles(cube_.get(), moved)[lists[0].items[0].b]);
    ASSERT_EQ(cdprep_scene_remove(scene_, &ids_[0], 1, nullptr), CDPREP_OK);
    add(cube_.get(), 0, 0);  // in the same slot
    EXPECT_EQ(picture(CDPREP_DRAW_OVERLAPS).size(), 0u);
    EXPECT_EQ(picture(CDPREP_DRAW_CONTACTS).size(), 0u);
}

TEST_F(CDrawnScene, ContactsAreLinesAndNormals) {
    const cdprep_scene_contact* lists = nullptr;
    std::size_t count = 0;
    ASSERT_EQ(cdprep_scene_contacts(scene_, &lists, &count, nullptr), CDPREP_OK);
    ASSERT_EQ(count, 1u);
    ASSERT_EQ(lists[0].count, 1u);
    const cdprep_contact& contact = lists[0].items[0];
    const Picture drawn = picture(CDPREP_DRAW_CONTACTS);
    ASSERT_EQ(drawn.lines.size(), contact.point_count + 1u);
    for (std::size_t i = 0; i < contact.point_count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(drawn.lines[i][k], contact.points[i].on_a[k]);
            EXPECT_EQ(drawn.lines[i][3 + k], contact.points[i].on_b[k]);
        }
    }
    const DrawnLine& normal = drawn.lines.back();
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(normal[k], contact.on_a[k]);
        EXPECT_NEAR(normal[3 + k] - normal[k], contact.normal[k] * std::sqrt(3.0) / 8, 1e-5);
    }
}

// By hand: the object in slot 3 is of a layer that asks for nothing.
TEST_F(CDrawnScene, AModelThatLacksWhatIsDrawnIsNamed) {
    add(opened_for_inside_.get(), 20, 7);
    Picture drawn;
    cdprep_draw draw = draw_into(drawn, CDPREP_DRAW_SURFACE);
    cdprep_error error;
    EXPECT_EQ(cdprep_scene_draw(scene_, &draw, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error.why, CDPREP_WHY_NOT_OPENED);
    EXPECT_STREQ(error.argument, "scene");
    EXPECT_TRUE(std::string(error.message).starts_with("The object in slot 3 cannot be drawn. "))
        << error.message;
    EXPECT_EQ(drawn.size(), 0u);
    draw.what = CDPREP_DRAW_BOXES | CDPREP_DRAW_OVERLAPS | CDPREP_DRAW_CONTACTS;
    EXPECT_EQ(cdprep_scene_draw(scene_, &draw, &error), CDPREP_OK) << error.message;
    EXPECT_EQ(drawn.lines.size(), 4 * 12 + picture(CDPREP_DRAW_CONTACTS).lines.size());
}

std::vector<Mistake<cdprep_draw>> draw_mistakes(bool is_scene) {
    using D = cdprep_draw;
    std::vector<Mistake<D>> all = struct_mistakes<D>("draw");
    for (const std::uint32_t bits : {128U, 1U << 31, UINT32_MAX}) {
        all.push_back(
            {"unknown bits", [=](D& d) { d.what = bits; }, CDPREP_WHY_OUT_OF_RANGE, "draw.what"});
    }
    if (!is_scene) {
        for (const std::uint32_t bits : {CDPREP_DRAW_CONTACTS, CDPREP_DRAW_OVERLAPS}) {
            all.push_back(
                {"of scenes", [=](D& d) { d.what |= bits; }, CDPREP_WHY_NO_MEANING, "draw.what"});
        }
    }
    all.push_back({"a level without boxes",
                   [](D& d) {
                       d.what = CDPREP_DRAW_SURFACE;
                       d.level = 1;
                   },
                   CDPREP_WHY_NO_MEANING, "draw.level"});
    all.push_back({"no line", [](D& d) { d.line = nullptr; }, CDPREP_WHY_NULL, "draw.line"});
    all.push_back(
        {"no triangle", [](D& d) { d.triangle = nullptr; }, CDPREP_WHY_NULL, "draw.triangle"});
    all.push_back({"no label", [](D& d) { d.label = nullptr; }, CDPREP_WHY_NULL, "draw.label"});
    return all;
}

TEST_F(CDrawnScene, WhatIsDrawnIsCheckedFieldByField) {
    Picture drawn;
    const cdprep_draw right =
        draw_into(drawn, CDPREP_DRAW_BOXES | CDPREP_DRAW_SURFACE | CDPREP_DRAW_NUMBERS, 1);
    expect_refused(right, draw_mistakes(false), [&](const cdprep_draw* given) {
        const std::size_t before = drawn.size();
        cdprep_error error;
        const int code = cdprep_model_draw(cube_.get(), &kStill, given, &error);
        return outcome(code, error, drawn.size() == before);
    });
    expect_refused(right, draw_mistakes(true), [&](const cdprep_draw* given) {
        const std::size_t before = drawn.size();
        cdprep_error error;
        const int code = cdprep_scene_draw(scene_, given, &error);
        return outcome(code, error, drawn.size() == before);
    });
}

TEST_F(CDrawnScene, DrawnModelsAndPosesAreChecked) {
    Picture drawn;
    cdprep_draw draw = draw_into(drawn, CDPREP_DRAW_SURFACE);
    cdprep_error error;
    const auto expect = [&](const cdprep_model* model, const cdprep_pose* pose, int why,
                            const char* argument) {
        EXPECT_EQ(cdprep_model_draw(model, pose, &draw, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, why) << argument;
        EXPECT_STREQ(error.argument, argument);
    };
    expect(nullptr, &kStill, CDPREP_WHY_NULL, "model");
    expect(cube_.get(), nullptr, CDPREP_WHY_NULL, "world_from_model");
    cdprep_pose wrong = kStill;
    wrong.rows[8] = -1;
    expect(cube_.get(), &wrong, CDPREP_WHY_NOT_RIGID, "world_from_model");
    wrong.rows[8] = kInfinity;
    expect(cube_.get(), &wrong, CDPREP_WHY_NOT_FINITE, "world_from_model.rows[8]");
    expect(opened_for_inside_.get(), &kStill, CDPREP_WHY_NOT_OPENED, "model");
    draw.what = CDPREP_DRAW_BOXES;
    const CModel corners(file_, CDPREP_ASK_CORNERS);
    expect(corners.get(), &kStill, CDPREP_WHY_NOT_OPENED, "model");
    const TestMesh mesh = unit_cube();
    const CBuilt built(build_options_of(mesh), workspace_.get());
    draw.what = CDPREP_DRAW_PIECES;
    expect(built.get(), &kStill, CDPREP_WHY_NOT_BAKED, "model");
    draw.what = CDPREP_DRAW_HULLS;
    expect(built.get(), &kStill, CDPREP_WHY_NOT_BAKED, "model");
    EXPECT_EQ(drawn.size(), 0u);
    EXPECT_EQ(cdprep_model_draw(nullptr, nullptr, nullptr, nullptr), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(cdprep_scene_draw(nullptr, &draw, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "scene");
    EXPECT_EQ(cdprep_scene_draw(scene_, nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "draw");
    cdprep_draw_init(nullptr, sizeof draw);
}

}  // namespace
}  // namespace cdprep::test
