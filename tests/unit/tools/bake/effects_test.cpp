// SPDX-License-Identifier: MIT
// What a list of effects stands for is read off the table of needs.
#include "bake/effects.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cdprep::cli {
namespace {

using format::SectionId;
using Names = std::vector<std::string>;

TEST(ParseEffects, AnEmptyListIsTheDefault) {
    const Effects effects = parse_effects("").value();
    EXPECT_EQ(effects.names, (Names{"closest", "collide", "distance", "overlap", "ray", "within"}));
    EXPECT_EQ(effects.asks,
              Ask::closest | Ask::collide | Ask::distance | Ask::overlap | Ask::ray | Ask::within);
}

TEST(ParseEffects, EachNameIsKeptOnceAndSorted) {
    EXPECT_EQ(parse_effects("ray,collide,ray").value().names, (Names{"collide", "ray"}));
}

// Solid is a way to ask, and structures have an option of their own.
TEST(ParseEffects, AllStandsForEveryEffectAndNoStructure) {
    const Effects effects = parse_effects("all").value();
    EXPECT_EQ(effects.names,
              (Names{"closest", "collide", "contacts", "continuous", "corners", "deform",
                     "distance", "haptic", "inaccessible", "inside", "overlap", "pieces", "ray",
                     "response", "self", "tear", "touch", "within"}));
    for (const SectionId id : {SectionId::octree_grid, SectionId::tetra_tree, SectionId::hulls}) {
        EXPECT_FALSE(effects.sections.contains(id)) << static_cast<int>(id);
    }
}

TEST(ParseEffects, AnUnknownNameFailsWithTheKnownOnes) {
    for (const char* list : {"colide", "collide,solid", "tetra-tree", "hull", "Collide", " ray"}) {
        const auto effects = parse_effects(list);
        ASSERT_FALSE(effects.ok()) << list;
        EXPECT_EQ(effects.error().code, ErrorCode::bad_argument);
        EXPECT_NE(effects.error().message.find("Choose from closest, collide, contacts,"),
                  std::string::npos)
            << effects.error().message;
    }
}

// What is baked for an effect must serve it.
TEST(ParseEffects, TheSectionsOfEachEffectServeIt) {
    int asked = 0;
    for (const std::string& name : parse_effects("all").value().names) {
        if (name == "inaccessible") continue;  // with --structures tetra-tree
        ++asked;
        const Effects effects = parse_effects(name).value();
        EXPECT_TRUE(contains(served_by(effects.sections, false), effects.asks)) << name;
    }
    EXPECT_GT(asked, 8);
}

// Queries that measure need bounds that measure well.
TEST(BoundsFor, MeasuringEffectsGetSweptSpheres) {
    for (const char* list : {"distance", "within", "contacts", "continuous", "haptic,ray"}) {
        EXPECT_EQ(bounds_for(parse_effects(list).value()), build::BvhBounds::oriented_and_swept)
            << list;
    }
    for (const char* list : {"collide,overlap", "self", "deform,tear", "ray"}) {
        EXPECT_EQ(bounds_for(parse_effects(list).value()), build::BvhBounds::oriented) << list;
    }
}

}  // namespace
}  // namespace cdprep::cli
