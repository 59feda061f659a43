// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "cdprep/cdprep.h"
#include "support/aligned_bytes.h"
#include "support/c_models.h"
#include "support/counted_memory.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

struct Fixture {
    AlignedBytes file =
        with_contacts(with_one_piece(bake_tiny(unit_cube().positions, unit_cube().triangles)));
    CModel cube{file};
    CWorkspace workspace;
    cdprep_plan* plan = nullptr;

    Fixture() {
        cdprep_layer_pair pair;
        cdprep_layer_pair_init(&pair, sizeof pair);
        pair.effects = CDPREP_ASK_COLLIDE | CDPREP_ASK_OVERLAP | CDPREP_ASK_WITHIN |
                       CDPREP_ASK_DISTANCE | CDPREP_ASK_CONTACTS;
        pair.tolerance = 0.1;
        pair.max_distance = 0.5;
        pair.body = CDPREP_SOLID;
        cdprep_plan_options options;
        cdprep_plan_options_init(&options, sizeof options);
        options.layer_pairs = &pair;
        options.layer_pair_count = 1;
        options.max_objects = 20;
        options.max_pairs = 200;
        options.max_triangle_pairs = 20000;
        options.max_contacts = 200;
        EXPECT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, nullptr), CDPREP_OK);
    }
    Fixture(const Fixture&) = delete;
    Fixture& operator=(const Fixture&) = delete;
    ~Fixture() {
        cdprep_plan_end(plan);
    }
};

// Objects are added, removed, moved, asked and read, in memory of the caller.
TEST(CSceneMemory, NoFunctionOfASceneAllocates) {
    const Fixture given;
    std::size_t size = 0;
    ASSERT_EQ(cdprep_scene_size(given.plan, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size);
    std::mt19937 random(3);
    std::array<cdprep_object, 20> ids{};
    std::array<cdprep_box_pair, 190> candidates{};
    std::size_t all = 0, all_contacts = 0;
    const std::size_t before = most = used;
    cdprep_scene* scene = nullptr;
    ASSERT_EQ(cdprep_scene_make(given.plan, memory.span().data(), size, &scene, nullptr),
              CDPREP_OK);
    for (int frame = 0; frame < 50; ++frame) {
        for (cdprep_object& id : ids) {
            cdprep_object_options object;
            cdprep_object_options_init(&object, sizeof object);
            object.model = given.cube.get();
            for (int axis = 0; axis < 3; ++axis) {
                object.world_from_model.rows[9 + axis] = static_cast<double>(random() % 64) / 16;
            }
            if (random() % 4 == 0) (void)cdprep_scene_remove(scene, &id, 1, nullptr);
            if (cdprep_scene_set_poses(scene, &id, &object.world_from_model, 1, nullptr) ==
                CDPREP_OK) {
                continue;
            }
            ASSERT_EQ(cdprep_scene_add(scene, &object, 1, &id, nullptr), CDPREP_OK);
        }
        cdprep_step step;
        std::size_t count = 0, contact_count = 0;
        const cdprep_event* events = nullptr;
        const cdprep_scene_contact* contacts = nullptr;
        cdprep_counts counts;
        if (frame % 2 == 0) {
            ASSERT_EQ(cdprep_scene_step(scene, given.workspace.get(), &step, nullptr), CDPREP_OK);
        } else {
            std::size_t pairs = 0;
            for (std::uint32_t a = 0; a < 20; ++a) {
                for (std::uint32_t b = a + 1; b < 20; ++b) candidates[pairs++] = {a, b};
            }
            ASSERT_EQ(cdprep_scene_step_with(scene, candidates.data(), pairs, given.workspace.get(),
                                             &step, nullptr),
                      CDPREP_OK);
        }
        ASSERT_EQ(step.complete, std::uint32_t{CDPREP_YES});
        ASSERT_EQ(cdprep_scene_events(scene, &events, &count, nullptr), CDPREP_OK);
        ASSERT_EQ(cdprep_scene_contacts(scene, &contacts, &contact_count, nullptr), CDPREP_OK);
        ASSERT_EQ(cdprep_scene_counts(scene, &counts, nullptr), CDPREP_OK);
        cdprep_object_info info;
        cdprep_draw draw;
        cdprep_draw_init(&draw, sizeof draw);
        draw.what = CDPREP_DRAW_SURFACE | CDPREP_DRAW_OVERLAPS | CDPREP_DRAW_CONTACTS;
        draw.line = [](void*, const double*, const double*, std::uint32_t) { return 1; };
        draw.triangle = [](void*, const double*, std::uint32_t) { return 1; };
        ASSERT_EQ(cdprep_scene_describe(scene, ids[0], &info, nullptr), CDPREP_OK);
        cdprep_object last{};
        ASSERT_EQ(cdprep_scene_object_at(scene, 19, &last, nullptr), CDPREP_OK);
        ASSERT_EQ(cdprep_scene_draw(scene, &draw, nullptr), CDPREP_OK);
        all += count;
        all_contacts += contact_count;
    }
    cdprep_scene_end(scene);
    EXPECT_EQ(most, before);
    EXPECT_GT(all, 100u);
    EXPECT_GT(all_contacts, 100u);
}

// The memory that is said to be needed is used to its last part: a sanitizer sees one byte more.
TEST(CSceneMemory, ABroadPhaseAllocatesOnce) {
    const CWorkspace workspace;
    cdprep_broad_phase_options options;
    cdprep_broad_phase_options_init(&options, sizeof options);
    options.max_boxes = 40;
    options.max_pairs = 780;
    std::size_t size = 0;
    ASSERT_EQ(cdprep_broad_phase_size(&options, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size);
    std::array<cdprep_world_box, 40> boxes{};
    const std::size_t before = most = used;
    cdprep_broad_phase* broad_phase = nullptr;
    ASSERT_EQ(cdprep_broad_phase_make(&options, memory.span().data(), size, &broad_phase, nullptr),
              CDPREP_OK);
    cdprep_box_update update;
    cdprep_box_update_init(&update, sizeof update);
    update.boxes = boxes.data();
    update.count = 40;
    cdprep_box_pairs pairs;
    ASSERT_EQ(cdprep_broad_phase_update(broad_phase, &update, workspace.get(), &pairs, nullptr),
              CDPREP_OK);
    EXPECT_EQ(pairs.count, 780u);
    cdprep_broad_phase_end(broad_phase);
    EXPECT_EQ(most, before);
}

}  // namespace
}  // namespace cdprep::test
