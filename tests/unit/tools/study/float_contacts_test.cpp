// SPDX-License-Identifier: MIT
#include "cdprep/advanced/float_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cdprep/pairs.h"
#include "study/memory_model.h"
#include "study/pose_set.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

// What float is certain of is in the exact set, and the exact set is in all that it leaves.
TEST(FloatContacts, HoldTheExactSetAndAreRightWhereCertain) {
    const MemoryModel a = make_memory_model(test::mesh_of(test::torus(1, 0.4, 24, 12))).value();
    const MemoryModel b = make_memory_model(test::mesh_of(test::icosphere(3))).value();
    const PoseSet set = make_pose_set(a.model, b.model, {.seed = 2, .per_stratum = 8});
    Workspace workspace;
    std::size_t doubtful = 0;
    std::size_t certain = 0;
    for (const StudyPose& pose : set.poses) {
        const Placement placement = Placement::b_moves(pose.a_from_b);
        std::vector<TrianglePair> exact(20'000);
        exact.resize(overlaps({a.model, b.model, placement}, workspace, exact));
        std::vector<TrianglePair> left;
        const auto visit = [&](const FloatContact& contact) {
            left.push_back({contact.a, contact.b});
            ++(contact.certain ? certain : doubtful);
            EXPECT_TRUE(!contact.certain || std::ranges::binary_search(exact, left.back()));
            return true;
        };
        EXPECT_TRUE(visit_float_contacts({a.model, b.model, placement}, workspace, FloatSearch::all,
                                         visit));
        std::ranges::sort(left);
        EXPECT_TRUE(std::ranges::includes(left, exact));
        bool found = false;
        const auto first = [&](const FloatContact&) {
            found = true;
            return false;
        };
        const bool whole = visit_float_contacts({a.model, b.model, placement}, workspace,
                                                FloatSearch::first, first);
        EXPECT_EQ(whole, !found);
        EXPECT_TRUE(found || exact.empty());
    }
    EXPECT_GT(certain, 100U);
    EXPECT_GT(doubtful, 10U);
}

}  // namespace
}  // namespace cdprep::study
