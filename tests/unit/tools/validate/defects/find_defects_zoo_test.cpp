// SPDX-License-Identifier: MIT
// Every defect alone, beside every other, and at 2^-40 and 2^40 of the scale: what is found
// is known by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/defect_zoo.h"
#include "unit/tools/soup_of.h"
#include "validate/defects/find_defects.h"

namespace cdprep::mesh {
namespace {

using test::ZooAnimal;

constexpr std::array kScales = {0, -40, 40};

DefectReport report_of(const ZooAnimal& animal, int exponent) {
    DefectOptions options;
    options.weld_distance = std::ldexp(test::kZooWidth, exponent);
    options.seam_width = std::ldexp(test::kZooWidth, exponent);
    return find_defects(test::soup_of(test::scaled_by(animal, exponent).mesh), options);
}

std::map<int, std::uint64_t> found_in(const DefectReport& report) {
    std::map<int, std::uint64_t> found;
    for (const Finding& finding : report.findings) {
        found[static_cast<int>(finding.rule)] = finding.count;
    }
    return found;
}

void expect_found(const ZooAnimal& animal) {
    std::map<int, std::uint64_t> expected = animal.found;
    if (animal.components > 1) expected[404] = animal.components;
    for (const int exponent : kScales) {
        const DefectReport report = report_of(animal, exponent);
        EXPECT_EQ(found_in(report), expected) << animal.name << " at 2^" << exponent;
        EXPECT_EQ(report.counts.components, animal.components) << animal.name;
        EXPECT_EQ(report.verdicts.size(), 1 + animal.components) << animal.name;
        for (const Finding& finding : report.findings) {
            EXPECT_EQ(finding.places.size(), finding.count) << animal.name;
        }
    }
}

TEST(FindDefectsZoo, EveryAnimalAloneHasWhatIsWrongWithIt) {
    for (const ZooAnimal& animal : test::defect_zoo()) expect_found(animal);
}

TEST(FindDefectsZoo, EveryTwoSideBySideHaveWhatIsWrongWithBoth) {
    const std::vector<ZooAnimal> zoo = test::defect_zoo();
    for (std::size_t i = 0; i < zoo.size(); ++i) {
        for (std::size_t j = 0; j < zoo.size(); ++j) {
            expect_found(test::side_by_side(zoo[i], zoo[j]));
        }
    }
}

TEST(FindDefectsZoo, EveryRuleHasAnAnimal) {
    std::map<int, int> animals;
    for (const ZooAnimal& animal : test::defect_zoo()) {
        for (const auto& [rule, count] : animal.found) ++animals[rule];
    }
    for (const RuleText& text : all_rules()) {
        // One speaks of all components, one of a size that scaling changes, and one is not
        // found beside another animal: find_defects_test.cpp has them.
        if (text.rule == Rule::several_components || text.rule == Rule::extent_beyond_float ||
            text.rule == Rule::empty_mesh) {
            continue;
        }
        EXPECT_GT(animals[static_cast<int>(text.rule)], 0) << text.name;
    }
}

}  // namespace
}  // namespace cdprep::mesh
