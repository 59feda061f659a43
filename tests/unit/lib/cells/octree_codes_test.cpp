// SPDX-License-Identifier: MIT
#include "cells/octree_codes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>

namespace cdprep::test {
namespace {

constexpr std::uint32_t kLast = kOctreeSteps - 1;

/// Bit by bit, as format/octree.h defines keys.
std::uint64_t code_bit_by_bit(const CellPlace& cell) {
    std::uint64_t code = 0;
    for (std::uint32_t bit = 0; bit < format::kOctreeBits; ++bit) {
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            code |= std::uint64_t{cell[axis] >> bit & 1} << (3 * bit + axis);
        }
    }
    return code;
}

std::vector<CellPlace> some_cells() {
    std::vector<CellPlace> cells = {{0, 0, 0},     {kLast, 0, 0},         {0, kLast, 0},
                                    {0, 0, kLast}, {kLast, kLast, kLast}, {1, 2, 4}};
    for (std::uint32_t bit = 0; bit < format::kOctreeBits; ++bit) {
        cells.push_back({1U << bit, 0, 0});
        cells.push_back({0, 1U << bit, 0});
        cells.push_back({0, 0, 1U << bit});
    }
    std::mt19937 random(1);
    for (int i = 0; i < 100'000; ++i) {
        CellPlace& cell = cells.emplace_back();
        for (std::uint32_t& x : cell) x = static_cast<std::uint32_t>(random()) & kLast;
    }
    return cells;
}

TEST(OctreeCodes, EveryInstructionSetMakesTheCodesOfTheDefinition) {
    const kernels::AvailableCurves curves = kernels::available_curves();
    for (const kernels::Curve* curve : std::span(curves.curve, curves.count)) {
        for (const CellPlace& cell : some_cells()) {
            const std::uint64_t code = curve->code(cell[0], cell[1], cell[2]);
            ASSERT_EQ(code, code_bit_by_bit(cell)) << curve->name;
            CellPlace back;
            curve->cell(code, back.data());
            ASSERT_EQ(back, cell) << curve->name;
        }
    }
}

TEST(OctreeCodes, Bmi2AgreesWhereTheProcessorHasIt) {
    const kernels::AvailableCurves curves = kernels::available_curves();
    if (curves.count < 2) GTEST_SKIP() << "this processor has no BMI2";
    EXPECT_STREQ(curves.curve[1]->name, "bmi2");
    for (const CellPlace& cell : some_cells()) {
        ASSERT_EQ(curves.curve[1]->code(cell[0], cell[1], cell[2]),
                  curves.curve[0]->code(cell[0], cell[1], cell[2]));
    }
}

TEST(OctreeCodes, TheActiveOneIsAvailable) {
    const kernels::AvailableCurves curves = kernels::available_curves();
    const auto all = std::span(curves.curve, curves.count);
    EXPECT_NE(std::find(all.begin(), all.end(), &kernels::active_curve()), all.end());
}

// The law of keys: a parent's is three bits shorter, levels count bits, and codes of one
// level rise along the Z-order curve as keys do.
TEST(OctreeCodes, KeysKnowTheirParentAndLevelAndRiseAlongTheCurve) {
    for (const CellPlace& cell : some_cells()) {
        const std::uint64_t code = octree_code(cell);
        for (std::uint32_t level = 0; level <= format::kOctreeBits; ++level) {
            const std::uint64_t path = code >> (3 * (format::kOctreeBits - level));
            const std::uint64_t key = std::uint64_t{1} << (3 * level) | path;
            ASSERT_EQ(level_of(key), level);
            ASSERT_EQ(code_of(key), code / cells_below(level) * cells_below(level));
            const CellPlace first = octree_place(key);
            const std::uint32_t mask = ~((kOctreeSteps >> level) - 1);
            ASSERT_EQ(first, (CellPlace{cell[0] & mask, cell[1] & mask, cell[2] & mask}));
            if (level == 0) continue;
            ASSERT_EQ(level_of(key >> 3), level - 1);
            ASSERT_LE(code_of(key >> 3), code_of(key));
            ASSERT_LE(code_of(key) - code_of(key >> 3), 7 * cells_below(level));
        }
    }
}

// Where two cells differ first, the last axis that does decides: z before y before x.
TEST(OctreeCodes, CodesRiseAsTheZCurveRuns) {
    const std::vector<CellPlace> cells = some_cells();
    for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
        std::uint32_t axis = 2, most = 0;
        for (std::uint32_t k = 3; k-- > 0;) {
            const std::uint32_t differs = cells[i][k] ^ cells[i + 1][k];
            // Its highest bit is above that of all others seen.
            if (most < differs && most < (differs ^ most)) {
                most = differs;
                axis = k;
            }
        }
        ASSERT_EQ(octree_code(cells[i]) < octree_code(cells[i + 1]),
                  cells[i][axis] < cells[i + 1][axis]);
    }
}

}  // namespace
}  // namespace cdprep::test
