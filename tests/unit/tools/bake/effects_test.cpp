// SPDX-License-Identifier: MIT
// What a list of effects stands for is read off the table of needs.
#include "bake/effects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
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

// Bodies push each other by contacts, so the one includes the other.
TEST(ParseEffects, ResponseIncludesContacts) {
    const Effects effects = parse_effects("response").value();
    EXPECT_TRUE(
        contains(served_by(effects.sections, false), Ask::response | Ask::contacts | Ask::overlap));
    format::SectionSet more = effects.sections;
    more.erase(parse_effects("contacts").value().sections);
    EXPECT_EQ(more, (format::SectionSet{format::SectionId::mass_properties}));
}

/// The options for a file that was baked for a list of effects.
std::string options_after(Ask needed, const std::string& list) {
    const format::SectionSet sections = parse_effects(list).value().sections;
    return options_to_bake(needed, served_by(sections, false), sections);
}

// By the table: a bake for contacts has all of one for rays, and no components.
TEST(OptionsToBake, KeepWhatAFileServes) {
    EXPECT_EQ(options_after(Ask::within, "inside"), "--effects collide,within")
        << "the file serves solids";
    EXPECT_EQ(options_after(Ask::solid, "ray"), "--effects collide,ray");
    EXPECT_EQ(options_after(Ask::ray, "collide,overlap,distance"),
              "--effects collide,distance,ray");
    EXPECT_EQ(options_after(Ask::response, "contacts"), "--effects response");
    EXPECT_EQ(options_after(Ask::contacts | Ask::response, ""),
              "--effects collide,contacts,response");
    const format::SectionSet trees = sections_for(Ask::octree | Ask::hashed_octree | Ask::hulls);
    EXPECT_EQ(options_to_bake(Ask::contacts, served_by(trees, false), trees),
              "--effects contacts --structures hull,hashed-octree");
}

// What a bake for the options has serves both, whatever both are.
TEST(OptionsToBake, ServeAll) {
    for (const Needs& needed : needs()) {
        for (const Needs& served : needs()) {
            if (needed.ask == Ask::inaccessible || served.ask == Ask::inaccessible) continue;
            const std::string options =
                options_to_bake(needed.ask, served.ask, sections_for(served.ask));
            std::string names = options;
            std::ranges::replace(names, ' ', ',');
            std::istringstream words(names);
            format::SectionSet sections;
            for (std::string word; std::getline(words, word, ',');) {
                const Needs* row = find_needs(std::string_view(word));
                if (row != nullptr) sections.insert(sections_for(row->ask));
            }
            EXPECT_TRUE(contains(served_by(sections, false), needed.ask | served.ask))
                << needed.name << " and " << served.name << ": " << options;
        }
    }
}

// Queries that measure need bounds that measure well.
TEST(BoundsFor, MeasuringEffectsGetSweptSpheres) {
    for (const char* list :
         {"distance", "within", "contacts", "response", "continuous", "haptic,ray"}) {
        EXPECT_EQ(bounds_for(parse_effects(list).value()), build::BvhBounds::oriented_and_swept)
            << list;
    }
    for (const char* list : {"collide,overlap", "self", "deform,tear", "ray"}) {
        EXPECT_EQ(bounds_for(parse_effects(list).value()), build::BvhBounds::oriented) << list;
    }
}

}  // namespace
}  // namespace cdprep::cli
