// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/structures.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cdprep/cells/structure_presets.h"

namespace cdprep::cli {
namespace {

using Names = std::vector<std::string>;

const Names kEvery = {"octree", "octree-adaptive", "hashed-octree", "tetra-tree", "hull"};

Result<StructureChoice> choose(const StructureArguments& arguments,
                               const std::string& effects = "collide") {
    return choose_structures(arguments, parse_effects(effects).value());
}

std::string fault(const StructureArguments& arguments) {
    const Result<StructureChoice> choice = choose(arguments);
    if (choice) return "";
    EXPECT_EQ(choice.error().code, ErrorCode::bad_argument);
    return choice.error().message;
}

template <class Options>
void expect_limits(const Options& options, const build::TreeLimits& limits) {
    EXPECT_EQ(options.level, limits.level);
    EXPECT_EQ(options.threshold, limits.threshold);
}

TEST(ChooseStructures, NoneUnlessAskedFor) {
    const StructureChoice choice = choose({}).value();
    EXPECT_TRUE(choice.names.empty());
    EXPECT_EQ(choice.sections, format::SectionSet{});
    EXPECT_FALSE(choice.has_octree() || choice.has_adaptive_octree() || choice.has_tetra_tree());
    EXPECT_TRUE(choice.settings.empty());
}

TEST(ChooseStructures, AllEffectsBringAll) {
    EXPECT_EQ(choose({}, "all").value().names, kEvery);
    EXPECT_TRUE(choose({.list = "none"}, "all").value().names.empty());
    EXPECT_EQ(choose({.list = "octree"}, "all").value().names, Names{"octree"});
}

TEST(ChooseStructures, ListsNameThem) {
    EXPECT_EQ(choose({.list = "all"}).value().names, kEvery);
    EXPECT_EQ(choose({.list = "octree,all"}).value().names, kEvery);
    EXPECT_EQ(choose({.list = "tetra-tree,octree,octree"}).value().names,
              (Names{"octree", "tetra-tree"}));
    const StructureChoice tetra = choose({.list = "tetra-tree"}).value();
    EXPECT_TRUE(tetra.has_tetra_tree() && !tetra.has_octree() && !tetra.has_adaptive_octree());
    EXPECT_EQ(choose({.list = "tetra-tree", .bounding = "caps"}).value().sections,
              find_needs(ask_of(Structure::tetra_tree))->needed);
    format::SectionSet with_boxes = find_needs(ask_of(Structure::tetra_tree))->needed;
    with_boxes.insert(find_needs(ask_of(Structure::tetra_tree))->used);
    EXPECT_EQ(choose({.list = "tetra-tree", .bounding = "boxes"}).value().sections, with_boxes);
}

// Its tables are of no use without the octree's own sections.
TEST(ChooseStructures, AHashedOctreeBringsTheOctree) {
    const StructureChoice hashed = choose({.list = "hashed-octree"}).value();
    EXPECT_EQ(hashed.names, (Names{"octree", "hashed-octree"}));
    EXPECT_TRUE(hashed.octree.hashed);
    EXPECT_FALSE(choose({.list = "octree"}).value().octree.hashed);
}

TEST(ChooseStructures, InaccessiblePartsBringATetraTree) {
    EXPECT_EQ(choose({}, "inaccessible").value().names, Names{"tetra-tree"});
    EXPECT_EQ(choose({.list = "octree"}, "inaccessible").value().names,
              (Names{"octree", "tetra-tree"}));
}

TEST(ChooseStructures, PresetsSayHowFine) {
    for (const build::StructurePreset& preset : build::kStructurePresets) {
        const StructureChoice hashed = choose({.list = "all", .preset = preset.name}).value();
        expect_limits(hashed.octree, preset.hashed_octree);
        expect_limits(hashed.adaptive_octree, preset.adaptive_octree);
        expect_limits(hashed.tetra_tree, preset.tetra_tree);
        const StructureChoice plain = choose({.list = "octree", .preset = preset.name}).value();
        expect_limits(plain.octree, preset.octree);
        EXPECT_EQ(hashed.octree_boxes(), preset.boxes);
        EXPECT_EQ(hashed.adaptive_octree_boxes(), preset.boxes);
        EXPECT_EQ(plain.octree_boxes(), preset.boxes);
        EXPECT_FALSE(plain.adaptive_octree_boxes());
        EXPECT_EQ(hashed.adaptive_octree.rule, preset.split);
        EXPECT_EQ(hashed.tetra_tree.bounding, preset.bounding);
    }
}

TEST(ChooseStructures, OptionsGoBeforeThePreset) {
    const StructureChoice choice = choose({.list = "all",
                                           .octree_level = 7,
                                           .octree_threshold = 9,
                                           .tetra_level = 5,
                                           .tetra_threshold = 11,
                                           .split = "median",
                                           .octree_bounding = "cells",
                                           .bounding = "tetra"})
                                       .value();
    expect_limits(choice.octree, {7, 9});
    expect_limits(choice.adaptive_octree, {7, 9});
    expect_limits(choice.tetra_tree, {5, 11});
    EXPECT_EQ(choice.adaptive_octree.rule, format::SplitRule::median);
    EXPECT_FALSE(choice.octree_boxes() || choice.adaptive_octree_boxes());
    EXPECT_EQ(choice.tetra_tree.bounding, format::TetraBounding::tetra);
    const StructureChoice level_alone =
        choose({.list = "tetra-tree", .tetra_level = 6, .split = "", .bounding = "caps"}).value();
    expect_limits(level_alone.tetra_tree, {6, build::kTunedPreset.tetra_tree.threshold});
    EXPECT_EQ(level_alone.tetra_tree.bounding, format::TetraBounding::caps);
    EXPECT_EQ(level_alone.adaptive_octree.rule, build::kTunedPreset.split);
    EXPECT_TRUE(choose({.list = "all", .preset = "paper", .octree_bounding = "boxes"})
                    .value()
                    .octree_boxes());
}

/// As --split and the others spell what was chosen.
std::string rules_of(const report::StructureSettings& settings) {
    std::string text;
    for (const report::StructureRule& rule : settings.rules) {
        text += (text.empty() ? "" : ", ") + rule.name + "=" + rule.value;
    }
    return text;
}

TEST(ChooseStructures, SettingsAreWhatIsBuilt) {
    const StructureChoice choice =
        choose({.list = "all", .octree_level = 6, .tetra_threshold = 3, .split = "area"}).value();
    const std::vector<report::StructureSettings> settings = choice.settings;
    ASSERT_EQ(settings.size(), 4U);
    EXPECT_EQ(settings[0].structure, Structure::octree);
    EXPECT_EQ(settings[0].level, 6U);
    EXPECT_EQ(settings[0].threshold, build::kTunedPreset.hashed_octree.threshold);
    EXPECT_EQ(rules_of(settings[0]), "bounding=boxes");
    EXPECT_EQ(settings[1].structure, Structure::adaptive_octree);
    EXPECT_EQ(rules_of(settings[1]), "split=area, bounding=boxes");
    EXPECT_EQ(settings[2].structure, Structure::hashed_octree);
    EXPECT_EQ(settings[2].level, 6U);
    EXPECT_EQ(settings[3].structure, Structure::tetra_tree);
    EXPECT_EQ(settings[3].threshold, 3U);
    EXPECT_EQ(rules_of(settings[3]), "bounding=boxes");
}

TEST(ChooseStructures, UnknownNamesAreRefusedWithThoseThatAreKnown) {
    for (const char* list : {"octrees", "octree,", ",octree", "octree,bvh", "none,octree",
                             "hashed-octree-literal", "Octree", " octree"}) {
        const std::string message = fault({.list = list});
        if (std::string(list) == "octree,") {
            EXPECT_EQ(message, "");  // nothing stands behind the comma
            continue;
        }
        for (const std::string& name : kEvery) {
            EXPECT_NE(message.find(" " + name), std::string::npos) << list << ": " << message;
        }
    }
    EXPECT_EQ(fault({.list = "kd-tree"}),
              "--structures: unknown structure 'kd-tree'. Choose from octree, octree-adaptive, "
              "hashed-octree, tetra-tree, hull, all or none.");
}

TEST(ChooseStructures, OptionsOfWhatIsNotBuiltAreRefused) {
    EXPECT_EQ(fault({.octree_level = 3}),
              "--octree-level has no effect: add octree to --structures, or remove the option.");
    const auto names = [](const std::string& message, const std::string& option,
                          const std::string& structure) {
        return message.starts_with(option + " ") &&
               message.find("add " + structure + " to") != std::string::npos;
    };
    EXPECT_TRUE(names(fault({.list = "tetra-tree", .octree_threshold = 3}), "--octree-threshold",
                      "octree"));
    EXPECT_TRUE(names(fault({.list = "octree", .tetra_level = 3}), "--tetra-level", "tetra-tree"));
    EXPECT_TRUE(
        names(fault({.list = "octree", .tetra_threshold = 3}), "--tetra-threshold", "tetra-tree"));
    EXPECT_TRUE(
        names(fault({.list = "hashed-octree", .split = "median"}), "--split", "octree-adaptive"));
    EXPECT_TRUE(
        names(fault({.list = "octree-adaptive", .bounding = "caps"}), "--bounding", "tetra-tree"));
    EXPECT_EQ(fault({.list = "octree-adaptive", .octree_level = 3}), "");
    EXPECT_TRUE(names(fault({.preset = "paper", .is_preset_given = true}), "--structure-preset",
                      "octree or tetra-tree"));
    EXPECT_TRUE(names(fault({.list = "hull", .is_preset_given = true}), "--structure-preset",
                      "octree or tetra-tree"));
    for (const char* list : {"octree", "octree-adaptive", "hashed-octree", "tetra-tree", "all"}) {
        EXPECT_EQ(fault({.list = list, .preset = "paper", .is_preset_given = true}), "");
    }
}

}  // namespace
}  // namespace cdprep::cli
