// SPDX-License-Identifier: MIT
#include "study/published.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cdprep::study {
namespace {

constexpr double kMebibyte = 1 << 20;

// The paper's own digits: its first four sizes of PQP follow from the triangles, the last two
// do not, and are marked.
TEST(Published, SizesOfPqpFollowFromTheTrianglesOrAreErrata) {
    for (std::size_t i = 0; i < kPublishedModels; ++i) {
        const PublishedModel& model = kPublished[i];
        const double printed = std::round(pqp_bytes_32(model.triangles) / kMebibyte * 1e4) / 1e4;
        EXPECT_EQ(printed == model.pqp.mebibytes, i < 4) << model.name;
        EXPECT_EQ(*model.pqp.erratum == '\0', i < 4) << model.name;
    }
    EXPECT_NEAR(pqp_bytes_64(7172) / kMebibyte, 2.9546, 5e-5);
}

// By hand: 4 bytes for each of the dragon's triangles are more than was printed.
TEST(Published, OnlyTheDragonsOctreeIsTooSmallToBeTrue) {
    for (const PublishedModel& model : kPublished) {
        const bool is_possible = 4.0 * model.triangles <= model.octree.mebibytes * kMebibyte;
        EXPECT_EQ(*model.octree.erratum == '\0', is_possible) << model.name;
    }
    EXPECT_FALSE(*kPublished[4].octree.erratum == '\0');
}

TEST(Published, EveryPairOfTableFourIsFoundInEitherOrder) {
    for (const PublishedPair& pair : kPublishedPairs) {
        EXPECT_EQ(find_published_pair(pair.a, pair.b), &pair);
        EXPECT_EQ(find_published_pair(pair.b, pair.a), &pair);
        // Collide is a prefix of overlap: where it takes longer, that is marked.
        EXPECT_EQ(pair.octree_collide > pair.octree_overlap, *pair.octree_erratum != '\0');
        EXPECT_LT(pair.tetra_collide, pair.octree_collide);
    }
    EXPECT_EQ(find_published_pair(0, 1), nullptr);
}

TEST(Likeness, CountsAloneDoNotMakeItThePublishedMesh) {
    const Likeness likeness = find_likeness(3582, 7172, 1);
    EXPECT_EQ(likeness.model, 0U);
    EXPECT_EQ(likeness.mark, Mark::none);
    EXPECT_NE(likeness.sentence.find("not known"), std::string::npos);
}

TEST(Likeness, AStandInIsMarkedThoughItsCountsAreThePublishedOnes) {
    const Likeness likeness = find_likeness(172974, 345944, 0x98b20742e8b1d8fc);
    EXPECT_EQ(likeness.model, 3U);
    EXPECT_EQ(likeness.mark, Mark::stand_in);
    EXPECT_EQ(beside(likeness, 2.0)->mark, Mark::stand_in);
}

TEST(Likeness, OtherVersionsOfAScanAreMarked) {
    const Likeness likeness = find_likeness(437645, 871414, 1);
    EXPECT_EQ(likeness.model, 4U);
    EXPECT_EQ(likeness.mark, Mark::other_counts);
}

TEST(Likeness, OtherCountsHaveNoFiguresBesideThem) {
    const Likeness reduced = find_likeness(49990, 99976, 0x05745eeab25131b7);
    EXPECT_FALSE(reduced.model);
    EXPECT_EQ(reduced.version_of, 3U);
    EXPECT_NE(reduced.sentence.find("Armadillo"), std::string::npos);
    const auto dash = beside(reduced, 1.0);
    ASSERT_TRUE(dash);
    EXPECT_FALSE(dash->value);
    EXPECT_EQ(dash->mark, Mark::not_comparable);
    EXPECT_EQ(dash->remark, reduced.sentence);
    EXPECT_FALSE(find_likeness(3582, 7171, 1).model);
    EXPECT_FALSE(find_likeness(3582, 7171, 1).version_of);
    EXPECT_FALSE(beside(find_likeness(3582, 7171, 1), 1.0));
}

// An erratum is one whatever the mesh is.
TEST(Likeness, AnErratumStandsBeforeAStandIn) {
    const Likeness likeness = find_likeness(172974, 345944, 0x98b20742e8b1d8fc);
    EXPECT_EQ(beside(likeness, 1.0, "it cannot be")->mark, Mark::erratum);
}

TEST(GeometryHash, DependsOnCoordinatesAndTriangles) {
    const std::vector<std::byte> none;
    const std::vector<std::byte> one(12, std::byte{1});
    EXPECT_NE(geometry_hash(one, none), geometry_hash(none, none));
    EXPECT_EQ(geometry_hash(one, none), geometry_hash(one, none));
}

}  // namespace
}  // namespace cdprep::study
