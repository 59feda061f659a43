// SPDX-License-Identifier: MIT
#include "kernels/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "cdprep/format/hull.h"
#include "exact/triangle_contact.h"
#include "exact/triangle_distance.h"
#include "exact/vectors.h"
#include "support/random_pose.h"
#include "unit/lib/kernels/each_table.h"
#include "unit/lib/kernels/inputs.h"
#ifdef CDPREP_HAVE_AVX2
#include "kernels/processor.h"
#endif

namespace cdprep::kernels {
namespace {

double half_edges(const Node& node, std::size_t box) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += node[24 + 8 * i + box] - node[8 * i + box];
    return sum / 2;
}

/// The pair that is named overlaps most, as far as its depth can tell.
void expect_deepest(const BoxDepths& depths, BoxPairs found) {
    if (found == 0) return;
    float most = 0;
    for (std::size_t bit = 0; bit < kLanes * kLanes; ++bit) {
        if ((found >> bit & 1) != 0) {
            most = std::max(most, depths.value[bit / kLanes][bit % kLanes]);
        }
    }
    ASSERT_LT(depths.deepest, kLanes * kLanes);
    ASSERT_NE(found >> depths.deepest & 1, 0U);
    ASSERT_GE(depths.value[depths.deepest / kLanes][depths.deepest % kLanes],
              most * (1 - 0x1p-16F));
}

/// The least overlap of box i of A and box j of B along six face directions, in
/// double.
double face_overlap(const Pose& pose, const Node& a, std::size_t i, const Node& b, std::size_t j) {
    const auto& r = pose.rotation();
    const std::array<double, 3> t = {pose.translation().x, pose.translation().y,
                                     pose.translation().z};
    std::array<double, 3> ca{}, ha{}, cb{}, hb{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ca[axis] = 0.5 * (double{a[8 * axis + i]} + double{a[24 + 8 * axis + i]});
        ha[axis] = 0.5 * (double{a[24 + 8 * axis + i]} - double{a[8 * axis + i]});
        cb[axis] = 0.5 * (double{b[8 * axis + j]} + double{b[24 + 8 * axis + j]});
        hb[axis] = 0.5 * (double{b[24 + 8 * axis + j]} - double{b[8 * axis + j]});
    }
    std::array<double, 3> d{};  // from A's centre to B's
    for (std::size_t k = 0; k < 3; ++k) {
        d[k] = r[3 * k] * cb[0] + r[3 * k + 1] * cb[1] + r[3 * k + 2] * cb[2] + t[k] - ca[k];
    }
    double least = 1e300;
    for (std::size_t k = 0; k < 3; ++k) {
        double reach_b = 0, reach_a = 0, along_b = 0;
        for (std::size_t l = 0; l < 3; ++l) {
            reach_b += std::fabs(r[3 * k + l]) * hb[l];
            reach_a += std::fabs(r[3 * l + k]) * ha[l];
            along_b += r[3 * l + k] * d[l];
        }
        least = std::min(least, ha[k] + reach_b - std::fabs(d[k]));
        least = std::min(least, hb[k] + reach_a - std::fabs(along_b));
    }
    return least;
}

/// Of every other round: far more than any slack.
float tolerance_of(int round) {
    return round % 2 == 0 ? 0.0F : 0.05F;
}

// The oracle: the same directions in double, without a slack. Where the overlap is
// larger than rounding, the answer is settled. Boxes as far apart as the tolerance overlap.
TEST(Kernels, BoxesAreTestedAlongSixFaceDirections) {
    constexpr float kSlack = 1e-5F;
    std::mt19937 random(20240601);
    std::size_t set = 0, all = 0;
    for (int round = 0; round < 3000; ++round) {
        const Node a = random_node(random);
        const Node b = random_node(random);
        const Pose pose = test::random_pose(random, 0.7);
        BoxPlacement placement = placement_of(pose, kSlack);
        placement.tolerance = tolerance_of(round);
        for_each_table([&](const Table& table) {
            const NodeBoxes node_a{a.data(), nullptr}, node_b{b.data(), nullptr};
            const BoxChoice everything{0xff, 0xff, nullptr};
            BoxSizes sizes{};
            const BoxPairs pairs =
                table.overlapping_boxes(placement, node_a, node_b, everything, sizes);
            for (std::size_t j = 0; j < kLanes; ++j) {
                for (std::size_t i = 0; i < kLanes; ++i) {
                    const double overlap =
                        face_overlap(pose, a, i, b, j) + double{placement.tolerance};
                    const bool found = has(pairs, i, j);
                    if (overlap >= 0) {
                        ASSERT_TRUE(found) << round << ": " << i << ", " << j;
                    }
                    if (overlap < -4e-5) {
                        ASSERT_FALSE(found) << round << ": " << i << ", " << j;
                    }
                    set += found ? 1 : 0;
                    ++all;
                }
            }
            BoxDepths depths{};
            ASSERT_EQ(table.overlap_depths(placement, node_a, node_b, everything, sizes, depths),
                      pairs);
            expect_deepest(depths, pairs);
            for (std::size_t j = 0; j < kLanes; ++j) {
                for (std::size_t i = 0; i < kLanes; ++i) {
                    const double overlap =
                        face_overlap(pose, a, i, b, j) + double{placement.tolerance};
                    ASSERT_NEAR(depths.value[j][i], overlap, 4e-5);
                }
                ASSERT_NEAR(sizes.a[j], half_edges(a, j), 1e-6);
                ASSERT_NEAR(sizes.b[j], half_edges(b, j), 1e-6);
            }
        });
    }
    // Neither answer may be rare, or this test would prove nothing.
    EXPECT_GT(set, all / 30);
    EXPECT_LT(set, all * 9 / 10);
}

TEST(Kernels, EitherSideOfASetOfPairs) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 1000; ++round) {
        const BoxPairs pairs = random() & random() & random() & random() & random();
        unsigned of_a = 0, of_b = 0;
        for (unsigned i = 0; i < kLanes; ++i) {
            for (unsigned j = 0; j < kLanes; ++j) {
                of_a |= static_cast<unsigned>(has(pairs, i, j)) << i;
                of_b |= static_cast<unsigned>(has(pairs, i, j)) << j;
            }
        }
        ASSERT_EQ(boxes_of_a(pairs), of_a);
        ASSERT_EQ(boxes_of_b(pairs), of_b);
    }
}

TEST(Kernels, OnlyChosenBoxesAreAnswered) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        const Node a = random_node(random), b = random_node(random);
        const BoxPlacement placement = placement_of(test::random_pose(random, 0.2), 1e-5F);
        const auto of_a = static_cast<std::uint8_t>(random());
        const auto of_b = static_cast<std::uint8_t>(random());
        for_each_table([&](const Table& table) {
            const NodeBoxes node_a{a.data(), nullptr}, node_b{b.data(), nullptr};
            BoxSizes sizes{};
            const BoxPairs whole =
                table.overlapping_boxes(placement, node_a, node_b, {0xff, 0xff, nullptr}, sizes);
            const BoxChoice choice{of_a, of_b, nullptr};
            BoxPairs expected = 0;
            for (unsigned j = 0; j < kLanes; ++j) {
                if ((of_b >> j & 1) != 0) expected |= BoxPairs{of_a} << (kLanes * j);
            }
            expected &= whole;
            ASSERT_EQ(table.overlapping_boxes(placement, node_a, node_b, choice, sizes), expected);
            BoxDepths depths{};
            ASSERT_EQ(table.overlap_depths(placement, node_a, node_b, choice, sizes, depths),
                      expected);
            expect_deepest(depths, expected);
        });
    }
}

TEST(Kernels, TheBoxAroundANodeRulesOutNothingThatOverlapsItsBoxes) {
    std::mt19937 random(4);
    std::size_t ruled_out = 0;
    for (int round = 0; round < 500; ++round) {
        Node a = random_node(random);
        const Node b = random_node(random);
        Node around{};  // in lane 0: the union of A's boxes
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t box = 0; box < kLanes; ++box) {
                a[8 * axis + box] *= 0.3F;  // small, so that B's boxes can miss it
                a[24 + 8 * axis + box] *= 0.3F;
                if (a[24 + 8 * axis + box] < a[8 * axis + box]) {
                    std::swap(a[24 + 8 * axis + box], a[8 * axis + box]);
                }
            }
            around[8 * axis] = *std::min_element(&a[8 * axis], &a[8 * axis] + 8);
            around[24 + 8 * axis] = *std::max_element(&a[24 + 8 * axis], &a[24 + 8 * axis] + 8);
        }
        const BoxPlacement placement = placement_of(test::random_pose(random, 0.7), 1e-5F);
        for_each_table([&](const Table& table) {
            const NodeBoxes node_a{a.data(), nullptr}, node_b{b.data(), nullptr};
            BoxSizes sizes{};
            const BoxPairs all =
                table.overlapping_boxes(placement, node_a, node_b, {0xff, 0xff, nullptr}, sizes);
            ASSERT_EQ(table.overlapping_boxes(placement, node_a, node_b,
                                              {0xff, 0xff, around.data()}, sizes),
                      all);
            for (unsigned j = 0; j < kLanes; ++j) {
                ruled_out += ((all >> (kLanes * j)) & 0xff) == 0 ? 1 : 0;
            }
        });
    }
    EXPECT_GT(ruled_out, 1000u);
}

/// Eight oriented boxes, each of which holds `point`.
OrientedNode boxes_with(std::mt19937& random, const Double3& point) {
    std::uniform_real_distribution<double> inside(-1, 1);
    std::uniform_real_distribution<double> exponent(-4, -0.3);
    OrientedNode node{};
    for (std::size_t box = 0; box < kLanes; ++box) {
        const auto r = test::random_pose(random, 0).rotation();
        std::array<double, 3> centre = {point.x, point.y, point.z};
        for (std::size_t k = 0; k < 3; ++k) {
            const double half = std::pow(10, exponent(random));
            const double t = half * (random() % 4 == 0 ? 1 : inside(random));  // often on a face
            for (std::size_t i = 0; i < 3; ++i) {
                centre[i] -= t * r[3 * k + i];
                if (k < 2) node[24 * k + 8 * i + box] = static_cast<float>(r[3 * k + i]);
            }
            node[72 + 8 * k + box] = static_cast<float>(half * (1 + 0x1p-18) + 0x1p-20);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            node[48 + 8 * i + box] = static_cast<float>(centre[i]);
        }
    }
    return node;
}

Double3 moved_back(const Pose& pose, const Double3& p) {
    const auto& r = pose.rotation();
    const Double3 d = {p.x - pose.translation().x, p.y - pose.translation().y,
                       p.z - pose.translation().z};
    return {r[0] * d.x + r[3] * d.y + r[6] * d.z, r[1] * d.x + r[4] * d.y + r[7] * d.z,
            r[2] * d.x + r[5] * d.y + r[8] * d.z};
}

// By construction: boxes that share a point overlap, whatever the axes.
TEST(Kernels, OrientedBoxesWithACommonPointAreNeverSeparated) {
    std::mt19937 random(5);
    Node everything{};
    for (std::size_t i = 0; i < 24; ++i) {
        everything[i] = -2;
        everything[24 + i] = 2;
    }
    std::size_t separated = 0;
    for (int round = 0; round < 3000; ++round) {
        const Pose pose = test::random_pose(random, 0.5);
        const Double3 point = {0.2, -0.3, 0.1};
        const OrientedNode a = boxes_with(random, point);
        const OrientedNode b = boxes_with(random, moved_back(pose, point));
        const OrientedNode elsewhere = boxes_with(random, moved_back(pose, {0.5, 0.1, -0.4}));
        const BoxPlacement placement = placement_of(pose, 6e-6F);
        for_each_table([&](const Table& table) {
            BoxSizes sizes{};
            const auto pairs_with = [&](const OrientedNode& other) {
                const NodeBoxes in_a{everything.data(), a.data()};
                const NodeBoxes in_b{everything.data(), other.data()};
                const BoxChoice all{0xff, 0xff, nullptr};
                BoxDepths depths{};
                const BoxPairs found = table.overlapping_boxes(placement, in_a, in_b, all, sizes);
                EXPECT_EQ(table.overlap_depths(placement, in_a, in_b, all, sizes, depths), found);
                expect_deepest(depths, found);
                return found;
            };
            ASSERT_EQ(pairs_with(b), ~BoxPairs{0}) << round;
            separated += static_cast<unsigned>(std::popcount(~pairs_with(elsewhere)));
        });
    }
    EXPECT_GT(separated, 100'000u);  // boxes around another point are told apart
}

/// Eight cells with an edge of 2^-5 to 1, one of which, `holds`, holds `point`, often on a
/// face.
OctantPlanes cells_with(std::mt19937& random, const Double3& point, unsigned holds) {
    const float edge = std::ldexp(1.0F, -static_cast<int>(random() % 6));
    OctantPlanes cells{};
    cells.half = 0.5F * edge;
    const std::array<double, 3> p = {point.x, point.y, point.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto eighth = static_cast<float>(random() % 9) * 0.125F;  // of the way through
        const auto at = static_cast<float>(p[axis]);
        const float lower = at - (eighth + static_cast<float>(holds >> axis & 1)) * edge;
        for (std::size_t k = 0; k < 3; ++k) {
            cells.plane[axis][k] = lower + static_cast<float>(k) * edge;
        }
    }
    return cells;
}

// By construction: a cell and a box that share a point meet, whether the box is oriented or
// not; and lanes that were not asked for do not.
TEST(Kernels, CellsAndBoxesWithACommonPointAlwaysMeet) {
    constexpr float kSlack = 1.2e-5F;  // of twice the roundings
    std::mt19937 random(6);
    std::size_t met_elsewhere = 0, asked_elsewhere = 0;
    for (int round = 0; round < 3000; ++round) {
        const Pose pose = test::random_pose(random, 0.5);
        const Double3 point = {0.2, -0.3, 0.1};
        const OrientedNode oriented = boxes_with(random, moved_back(pose, point));
        // Around each oriented box, along B's axes.
        Node aligned{};
        for (std::size_t box = 0; box < kLanes; ++box) {
            for (std::size_t i = 0; i < 3; ++i) {
                const float half =
                    oriented[72 + box] + oriented[80 + box] + oriented[88 + box] + 1e-6F;
                aligned[8 * i + box] = oriented[48 + 8 * i + box] - half;
                aligned[24 + 8 * i + box] = oriented[48 + 8 * i + box] + half;
            }
        }
        const unsigned holds = random() % 8;
        const OctantPlanes cells = cells_with(random, point, holds);
        const unsigned some = random() % 256;
        for_each_table([&](const Table& table) {
            for (const float* turned : {oriented.data(), static_cast<const float*>(nullptr)}) {
                BoxesAmongCells boxes{};
                std::array<std::uint8_t, kLanes> met{};
                table.place_among_cells(placement_of(pose, kSlack), {aligned.data(), turned},
                                        boxes);
                table.cells_met(boxes, cells, 0xff, met.data());
                ASSERT_EQ(met[holds], 0xff) << round;
                const std::array<std::uint8_t, kLanes> all = met;
                table.cells_met(boxes, cells, some, met.data());
                for (std::size_t i = 0; i < kLanes; ++i) {
                    ASSERT_EQ(met[i], all[i] & some) << round;
                    met_elsewhere += i == holds ? 0U : static_cast<unsigned>(std::popcount(all[i]));
                    asked_elsewhere += i == holds ? 0 : 8;
                }
            }
        });
    }
    EXPECT_GT(met_elsewhere, asked_elsewhere / 10);
    EXPECT_LT(met_elsewhere, asked_elsewhere * 7 / 10);
}

Corners corners_of(const Leaf& leaf, std::size_t lane, const Pose& pose) {
    Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = transform_point(
            pose, {leaf[24 * i + lane], leaf[24 * i + 8 + lane], leaf[24 * i + 16 + lane]});
    }
    return corners;
}

// The oracle: the exact test on corners moved in double.
TEST(Kernels, TriangleContactsAreCertainOrLeftOpen) {
    std::mt19937 random(6);
    const auto scratch = std::make_unique<LeafScratch>();
    std::size_t crossing = 0, open = 0, all = 0;
    for (int round = 0; round < 1500; ++round) {
        const bool coarse = round % 3 == 0;
        const Leaf a = random_leaf(random, coarse), b = random_leaf(random, coarse);
        const Pose pose = coarse ? Pose() : test::random_pose(random, 0.5);
        const LeafPlacement placement = leaf_placement(pose);
        const LeafPair pair = pair_of(a, b);
        for_each_table([&](const Table& table) {
            scratch->begin();
            const std::size_t count = table.find_contacts(placement, &pair, 1, *scratch);
            std::array<std::array<int, 8>, 8> found{};  // 0: disjoint, 1: open, 2: crossing
            for (std::size_t i = 0; i < count; ++i) {
                const TriangleContactLanes& contact = scratch->found[i];
                ASSERT_EQ(contact.pair, 0);
                ASSERT_EQ(found[contact.a][contact.b], 0) << "named twice";
                found[contact.a][contact.b] = contact.certain ? 2 : 1;
                (contact.certain ? crossing : open) += 1;
            }
            for (std::size_t i = 0; i < kLanes; ++i) {
                for (std::size_t j = 0; j < kLanes; ++j) {
                    const TriangleContact exact =
                        classify_contact(corners_of(a, i, Pose()), corners_of(b, j, pose));
                    if (found[i][j] == 2) {
                        ASSERT_EQ(exact, TriangleContact::cross) << round;
                    }
                    if (found[i][j] == 0) {
                        ASSERT_EQ(exact, TriangleContact::disjoint) << round;
                    }
                    ++all;
                }
            }
        });
    }
    EXPECT_GT(crossing, all / 50);
    EXPECT_GT(open, 0u);
    EXPECT_LT(open, all / 3);
}

TEST(Kernels, FewFineTrianglesAreLeftOpen) {
    std::mt19937 random(7);
    const auto scratch = std::make_unique<LeafScratch>();
    const LeafPlacement placement =
        leaf_placement(Pose::from_quaternion(4, 1, 2, 3, {0.1, 0.2, 0.3}).value());
    for_each_table([&](const Table& table) {
        std::size_t crossing = 0, open = 0;
        for (int round = 0; round < 2000; ++round) {
            const Leaf a = random_leaf(random, false), b = random_leaf(random, false);
            const LeafPair pair = pair_of(a, b);
            scratch->begin();
            const std::size_t count = table.find_contacts(placement, &pair, 1, *scratch);
            for (std::size_t i = 0; i < count; ++i) {
                (scratch->found[i].certain ? crossing : open) += 1;
            }
        }
        EXPECT_GT(crossing, 5000u);
        EXPECT_LT(open, crossing / 500);
    });
}

TEST(Kernels, UnusedLanesAndOtherPairsStayOut) {
    std::mt19937 random(8);
    const auto scratch = std::make_unique<LeafScratch>();
    std::array<Leaf, kLeafBatch> a, b;
    std::array<LeafPair, kLeafBatch> pairs{};
    for (std::size_t i = 0; i < kLeafBatch; ++i) {
        a[i] = random_leaf(random, true);
        b[i] = random_leaf(random, true);
        pairs[i] = pair_of(a[i], b[i]);
        pairs[i].used_a = static_cast<std::uint8_t>(random());
        pairs[i].used_b = static_cast<std::uint8_t>(random());
    }
    const LeafPlacement placement = leaf_placement(Pose());
    // Each leaf in a place of its own, two to a place, and all in one.
    for (const std::uint32_t stride : {1U, 8U, 64U})
        for_each_table([&](const Table& table) {
            for (std::uint32_t i = 0; i < kLeafBatch; ++i) {
                pairs[i].number_a = i * stride;
                pairs[i].number_b = (kLeafBatch - i) * stride;
            }
            scratch->begin();
            const std::size_t count =
                table.find_contacts(placement, pairs.data(), kLeafBatch, *scratch);
            std::size_t expected = 0;
            for (std::size_t p = 0; p < kLeafBatch; ++p) {
                for (std::size_t i = 0; i < kLanes; ++i) {
                    for (std::size_t j = 0; j < kLanes; ++j) {
                        if ((pairs[p].used_a >> i & 1) == 0 || (pairs[p].used_b >> j & 1) == 0)
                            continue;
                        expected += triangles_touch(corners_of(a[p], i, Pose()),
                                                    corners_of(b[p], j, Pose()))
                                        ? 1
                                        : 0;
                    }
                }
            }
            std::size_t touching = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const TriangleContactLanes& c = scratch->found[i];
                ASSERT_NE(pairs[c.pair].used_a >> c.a & 1, 0);
                ASSERT_NE(pairs[c.pair].used_b >> c.b & 1, 0);
                touching += triangles_touch(corners_of(a[c.pair], c.a, Pose()),
                                            corners_of(b[c.pair], c.b, Pose()))
                                ? 1
                                : 0;
            }
            EXPECT_EQ(touching, expected);
            EXPECT_GT(expected, 50u);
        });
}

// By definition: what find_contacts() finds, without what is left out.
TEST(Kernels, OwnContactsAreContactsOfTrianglesWithoutACommonVertex) {
    std::mt19937 random(12);
    const auto scratch = std::make_unique<LeafScratch>();
    const LeafPlacement placement = leaf_placement(Pose());
    std::array<Leaf, kLeafBatch> leaves;
    std::array<std::uint32_t, kLeafBatch * 24> corners;
    std::size_t found = 0, neighbours = 0;
    for (int round = 0; round < 200; ++round) {
        for (Leaf& leaf : leaves) leaf = random_leaf(random, round % 2 == 0);
        // Numbers that floats would not tell apart.
        for (std::uint32_t& number : corners) number = 0x7fffff00 + random() % 60;
        std::array<LeafPair, kLeafBatch> pairs{};
        for (LeafPair& pair : pairs) {
            const auto a = static_cast<std::uint32_t>(random() % kLeafBatch);
            const auto b =
                random() % 4 == 0 ? a : static_cast<std::uint32_t>(random() % kLeafBatch);
            const auto used = static_cast<std::uint8_t>(random());
            pair = {leaves[a].data(), leaves[b].data(), a, b, used, used};
        }
        std::array<CornerNumbers, kLeafBatch> numbers{};
        for (std::size_t i = 0; i < kLeafBatch; ++i) {
            numbers[i] = {&corners[pairs[i].number_a * 24], &corners[pairs[i].number_b * 24]};
        }
        const auto is_left_out = [&](const TriangleContactLanes& c) {
            const LeafPair& pair = pairs[c.pair];
            if (pair.number_a == pair.number_b && c.a >= c.b) return true;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) {
                    if (corners[pair.number_a * 24 + 8 * i + c.a] ==
                        corners[pair.number_b * 24 + 8 * j + c.b]) {
                        return true;
                    }
                }
            }
            return false;
        };
        for_each_table([&](const Table& table) {
            scratch->begin();
            const std::size_t all =
                table.find_contacts(placement, pairs.data(), kLeafBatch, *scratch);
            std::vector<TriangleContactLanes> expected;
            std::copy_if(scratch->found, scratch->found + all, std::back_inserter(expected),
                         [&](const auto& contact) { return !is_left_out(contact); });
            neighbours += all - expected.size();
            const std::size_t count = table.find_own_contacts(placement, pairs.data(), kLeafBatch,
                                                              numbers.data(), *scratch);
            ASSERT_EQ(count, expected.size()) << round;
            for (std::size_t i = 0; i < count; ++i) {
                const TriangleContactLanes& contact = scratch->found[i];
                ASSERT_EQ(contact.pair, expected[i].pair);
                ASSERT_EQ(contact.a, expected[i].a);
                ASSERT_EQ(contact.b, expected[i].b);
                ASSERT_EQ(contact.certain, expected[i].certain);
            }
            found += count;
        });
    }
    EXPECT_GT(found, neighbours / 3);
    EXPECT_GT(neighbours, found / 3);
}

/// A limit and a direction of unit length, or none.
Reach reach_along(const Pose& pose, const Double3& direction, double limit) {
    Reach reach{};
    reach.limit = static_cast<float>(limit);
    const double length = std::hypot(direction.x, direction.y, direction.z);
    if (length == 0) return reach;
    const std::array<double, 3> d = {direction.x / length, direction.y / length,
                                     direction.z / length};
    const auto& r = pose.rotation();
    for (std::size_t i = 0; i < 3; ++i) {
        reach.direction[i] = static_cast<float>(d[i] * (1 - 0x1p-20));
        reach.direction_in_b[i] =
            static_cast<float>((r[i] * d[0] + r[3 + i] * d[1] + r[6 + i] * d[2]) * (1 - 0x1p-20));
    }
    return reach;
}

// By construction: boxes that hold a point each are no further apart than the points.
TEST(Kernels, BoxesAreNoFurtherApartThanPointsInThem) {
    std::mt19937 random(9);
    Node everything{};
    for (std::size_t i = 0; i < 24; ++i) {
        everything[i] = -2;
        everything[24 + i] = 2;
    }
    const Double3 at_a = {0.2, -0.3, 0.1};
    const Double3 at_b = {0.9, 0.5, -0.6};
    const double between = std::hypot(0.7, 0.8, 0.7);
    double tightest = 0;
    for (int round = 0; round < 2000; ++round) {
        const Pose pose = test::random_pose(random, 0.5);
        const OrientedNode a = boxes_with(random, at_a);
        const OrientedNode b = boxes_with(random, moved_back(pose, at_b));
        const BoxPlacement placement = placement_of(pose, 6e-6F);
        for_each_table([&](const Table& table) {
            BoxPairFloats gaps{};
            const NodeBoxes node_a{everything.data(), a.data()};
            const NodeBoxes node_b{everything.data(), b.data()};
            Reach reach = reach_along(pose, {0.7, 0.8, -0.7}, between);
            ASSERT_EQ(
                table.near_boxes(placement, node_a, node_b, {0xff, 0xff, nullptr}, reach, gaps),
                ~BoxPairs{0});
            // What is farther than half as far is to be left out, and nothing else.
            reach.limit /= 2;
            BoxPairs expected = 0;
            for (std::size_t j = 0; j < kLanes; ++j) {
                for (std::size_t i = 0; i < kLanes; ++i) {
                    const float lower = gaps.value[j][i];
                    ASSERT_LE(lower, between);
                    tightest = std::max(tightest, double{lower});
                    expected |= BoxPairs{lower <= reach.limit} << (kLanes * j + i);
                }
            }
            ASSERT_EQ(
                table.near_boxes(placement, node_a, node_b, {0xff, 0xff, nullptr}, reach, gaps),
                expected);
        });
    }
    EXPECT_GT(tightest, 0.9 * between);
}

// The oracle: the distance in double, whose interval is proved elsewhere. What is nearer
// than the certain distance for certain is; most of what is nearer is so for certain.
TEST(Kernels, TrianglesAreNoNearerThanTheirGaps) {
    std::mt19937 random(10);
    const auto scratch = std::make_unique<LeafScratch>();
    std::size_t near = 0, all = 0, certain = 0, nearer = 0;
    double worst = 0;
    for (int round = 0; round < 600; ++round) {
        const bool coarse = round % 3 == 0;
        const Leaf a = random_leaf(random, coarse), b = random_leaf(random, coarse);
        const Pose pose = test::random_pose(random, 4);
        const LeafPlacement placement = leaf_placement(pose);
        const LeafPair pair = pair_of(a, b);
        Reach reach = reach_along(pose, round % 2 == 0 ? pose.translation() : Double3{0, 0, 0},
                                  1 + static_cast<double>(round % 5));
        const float limit = reach.limit;
        reach.certain = 0.75F * limit;
        for_each_table([&](const Table& table) {
            scratch->begin();
            const std::size_t count = table.triangles_within(placement, &pair, 1, reach, *scratch);
            std::array<std::array<float, 8>, 8> lower{};
            for (auto& row : lower) row.fill(1e30F);
            std::array<std::array<bool, 8>, 8> is_certain{};
            for (std::size_t i = 0; i < count; ++i) {
                const TriangleGap& gap = scratch->gap[i];
                ASSERT_LE(gap.lower, limit);
                ASSERT_EQ(gap.pair, 0);
                lower[gap.a][gap.b] = gap.lower;
                is_certain[gap.a][gap.b] = gap.certain;
            }
            for (std::size_t i = 0; i < kLanes; ++i) {
                for (std::size_t j = 0; j < kLanes; ++j) {
                    const Corners s = corners_of(a, i, Pose()), t = corners_of(b, j, pose);
                    const bool touch = triangles_touch(s, t);
                    const double distance = touch ? 0 : triangle_distance(s, t, true).upper;
                    ++all;
                    ASSERT_TRUE(!is_certain[i][j] || distance < reach.certain) << round;
                    certain += is_certain[i][j] ? 1 : 0;
                    nearer += distance < reach.certain ? 1 : 0;
                    if (lower[i][j] > 1e29F) {
                        ASSERT_GT(distance, limit) << round;
                        continue;
                    }
                    ++near;
                    ASSERT_LE(lower[i][j], distance) << round;
                    if (distance > 0.5) worst = std::max(worst, distance - lower[i][j]);
                }
            }
        });
    }
    EXPECT_GT(near, all / 10);
    EXPECT_LT(near, all * 9 / 10);
    EXPECT_GT(certain, nearer * 7 / 10);
    EXPECT_LT(worst, 1e-3);  // a bound of 0 would hold too, and prune nothing
}

/// Eight spheres swept over `sides` sides; flat ones and balls are among them, and
/// sides that run alike.
SweptNode random_swept(std::mt19937& random, std::size_t sides) {
    const double reach = 0.14 + 0.04 * static_cast<double>(sides);  // as many apart as not
    std::uniform_real_distribution<double> place(-reach, reach);
    std::uniform_real_distribution<double> exponent(-1.85, -0.5);
    SweptNode node{};
    for (std::size_t box = 0; box < kLanes; ++box) {
        const Pose pose = random() % 4 == 0 ? Pose() : test::random_pose(random, 0);
        for (std::size_t i = 0; i < 3; ++i) {
            node[8 * i + box] = static_cast<float>(place(random));
            for (std::size_t k = 0; k < 2; ++k) {
                node[32 * (k + 1) + 8 * i + box] = static_cast<float>(pose.rotation()[3 * k + i]);
            }
        }
        node[24 + box] = static_cast<float>(std::pow(10, exponent(random)));
        for (std::size_t k = 0; k < sides; ++k) {
            node[32 * (k + 1) + 24 + box] = static_cast<float>(std::pow(10, exponent(random)));
        }
    }
    return node;
}

/// The middle of a swept sphere as two triangles.
std::array<Corners, 2> middle_of(const SweptNode& node, std::size_t box, const Pose& pose) {
    const auto corner = [&](double first, double second) {
        std::array<double, 3> p{};
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = double{node[8 * i + box]} +
                   first * double{node[56 + box]} * double{node[32 + 8 * i + box]} +
                   second * double{node[88 + box]} * double{node[64 + 8 * i + box]};
        }
        return transform_point(pose, {p[0], p[1], p[2]});
    };
    const Corners first = {corner(-1, -1), corner(1, -1), corner(1, 1)};
    const Corners second = {corner(-1, -1), corner(1, 1), corner(-1, 1)};
    return {first, second};
}

/// How far two swept spheres are apart; negative when they overlap.
double swept_distance(const SweptNode& a, std::size_t i, const SweptNode& b, std::size_t j,
                      const Pose& pose) {
    double least = 1e300;
    for (const Corners& s : middle_of(a, i, Pose())) {
        for (const Corners& t : middle_of(b, j, pose)) {
            const bool touch = triangles_touch(s, t);
            least = std::min(least, touch ? 0 : triangle_distance(s, t, true).lower);
        }
    }
    return least - double{a[24 + i]} - double{b[24 + j]};
}

Node everything() {
    Node node{};
    for (std::size_t i = 0; i < 24; ++i) {
        node[i] = -3;
        node[24 + i] = 3;
    }
    return node;
}

// The oracle: the distance of the middles as triangles, whose interval is proved
// elsewhere. Points and lines are settled up to the slack, rectangles nearly always; the
// tolerance counts once, and not as often as the slack does.
TEST(Kernels, SweptSpheresAreSeparatedWhenTheyAreApart) {
    constexpr float kSlack = 6e-6F;
    const Node around = everything();
    std::mt19937 random(11);
    for (std::size_t sides = 0; sides < 3; ++sides) {
        std::size_t overlapping = 0, apart = 0, separated = 0;
        for (int round = 0; round < 150; ++round) {
            const SweptNode a = random_swept(random, sides), b = random_swept(random, sides);
            const Pose pose =
                round % 5 == 0 ? Pose() : test::random_pose(random, 0.1 * (round % 3));
            BoxPlacement placement = placement_of(pose, kSlack);
            placement.tolerance = tolerance_of(round);
            std::array<std::array<double, kLanes>, kLanes> distance{};
            for (std::size_t j = 0; j < kLanes; ++j) {
                for (std::size_t i = 0; i < kLanes; ++i) {
                    distance[j][i] = swept_distance(a, i, b, j, pose) - double{placement.tolerance};
                    (distance[j][i] > 0 ? apart : overlapping) += available().count;
                }
            }
            for_each_table([&](const Table& table) {
                const NodeBoxes in_a{around.data(), nullptr, a.data()};
                const NodeBoxes in_b{around.data(), nullptr, b.data()};
                const BoxChoice all{0xff, 0xff, nullptr};
                BoxSizes sizes{};
                BoxDepths depths{};
                const BoxPairs found =
                    table.swept[sides].overlapping(placement, in_a, in_b, all, sizes);
                ASSERT_EQ(table.swept[sides].depths(placement, in_a, in_b, all, sizes, depths),
                          found);
                expect_deepest(depths, found);
                for (std::size_t j = 0; j < kLanes; ++j) {
                    for (std::size_t i = 0; i < kLanes; ++i) {
                        const bool kept = (found >> (kLanes * j + i) & 1) != 0;
                        const double d = distance[j][i];
                        if (d <= 0) {
                            ASSERT_TRUE(kept) << sides << ", " << round << ", " << d;
                        }
                        if (sides < 2 && d > 1e-4) {
                            ASSERT_FALSE(kept) << sides << ", " << round << ", " << d;
                        }
                        separated += kept ? 0 : 1;
                    }
                    const double size =
                        3 * double{a[24 + j]} + double{a[56 + j]} + double{a[88 + j]};
                    ASSERT_NEAR(sizes.a[j], size, 1e-5);
                }
            });
        }
        EXPECT_GT(apart, (apart + overlapping) * 3 / 10) << sides;
        EXPECT_LT(apart, (apart + overlapping) * 7 / 10) << sides;
        EXPECT_GT(separated, apart * 97 / 100) << sides;
    }
}

TEST(Kernels, SweptSpheresAreNoFurtherApartThanTheirDistance) {
    const Node around = everything();
    std::mt19937 random(12);
    for (std::size_t sides = 0; sides < 3; ++sides) {
        double bounds = 0, distances = 0;
        for (int round = 0; round < 100; ++round) {
            const SweptNode a = random_swept(random, sides), b = random_swept(random, sides);
            const Pose pose = test::random_pose(random, 1.5);
            const BoxPlacement placement = placement_of(pose, 6e-6F);
            Reach reach =
                reach_along(pose, round % 2 == 0 ? pose.translation() : Double3{0, 0, 0}, 10);
            for_each_table([&](const Table& table) {
                BoxPairFloats gaps{}, fewer{};
                const NodeBoxes node_a{around.data(), nullptr, a.data()};
                const NodeBoxes node_b{around.data(), nullptr, b.data()};
                const BoxChoice all{0xff, 0xff, nullptr};
                reach.limit = 10;
                ASSERT_EQ(table.swept[sides].near(placement, node_a, node_b, all, reach, gaps),
                          ~BoxPairs{0});
                for (std::size_t j = 0; j < kLanes; ++j) {
                    for (std::size_t i = 0; i < kLanes; ++i) {
                        const double d = std::max(0.0, swept_distance(a, i, b, j, pose));
                        ASSERT_LE(gaps.value[j][i], d) << sides << ", " << round;
                        bounds += std::max(0.0F, gaps.value[j][i]);
                        distances += d;
                    }
                }
                // What is farther than the limit or not chosen is left out, and nothing else.
                reach.limit = 0.5F;
                const BoxPairs near = table.swept[sides].near(placement, node_a, node_b,
                                                              {0x7e, 0xf7, nullptr}, reach, fewer);
                for (std::size_t j = 0; j < kLanes; ++j) {
                    for (std::size_t i = 0; i < kLanes; ++i) {
                        const bool is_chosen = i > 0 && i < 7 && j != 3;
                        ASSERT_EQ((near >> (kLanes * j + i) & 1) != 0,
                                  is_chosen && gaps.value[j][i] <= reach.limit);
                    }
                }
            });
        }
        EXPECT_GT(bounds, 0.98 * distances) << sides;
    }
}

/// Blocks of points, on a coarse grid or not; the last point fills the last block.
std::vector<format::HullBlock> random_blocks(std::mt19937& random, std::size_t count, bool coarse) {
    std::uniform_real_distribution<double> fine(-1, 1);
    std::uniform_int_distribution<int> grid(-2, 2);
    std::vector<format::HullBlock> blocks((count + 7) / 8);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double last = 0;
        for (std::size_t i = 0; i < 8 * blocks.size(); ++i) {
            if (i < count) last = coarse ? grid(random) : fine(random);
            blocks[i / 8].at[axis][i % 8] = last;
        }
    }
    return blocks;
}

// The reference is the formula, point by point; every table must give the same bits.
TEST(Kernels, TheFarthestPointIsTheSameForEveryTable) {
    std::mt19937 random(77);
    std::uniform_int_distribution<std::size_t> counts(1, 100);
    int ties = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const bool coarse = trial % 2 == 0;
        const std::size_t count = counts(random);
        const auto blocks = random_blocks(random, count, coarse);
        const Pose pose = coarse ? Pose() : test::random_pose(random, 2);
        const auto d = random_blocks(random, 2, coarse)[0].at;
        MovedDirection from{};
        std::copy_n(pose.rotation().data(), 9, from.rotation);
        const Double3& t = pose.translation();
        const std::array<double, 3> shift = {t.x, t.y, t.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            from.translation[axis] = shift[axis];
            from.direction[axis] = d[axis][0];
            from.origin[axis] = d[axis][1];
        }
        std::uint32_t plain = 0;
        FarthestPoint best = {0, -HUGE_VAL, -HUGE_VAL};
        double height = -HUGE_VAL;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto& at = blocks[i / 8].at;
            const Double3 p = {at[0][i % 8], at[1][i % 8], at[2][i % 8]};
            const double* n = from.direction;
            const double value = (n[0] * p.x + n[1] * p.y) + n[2] * p.z;
            ties += value == height ? 1 : 0;
            if (value > height) plain = i;
            height = std::max(height, value);
            const Double3 q = transform_point(pose, p);
            const double x = (q.x - from.origin[0]) * n[0], y = (q.y - from.origin[1]) * n[1];
            const double z = (q.z - from.origin[2]) * n[2];
            const double far = (x + y) + z;
            if (far > best.value) best.number = i;
            best.value = std::max(best.value, far);
            const double size = (std::fabs(x) + std::fabs(y)) + std::fabs(z);
            best.bound = std::max(best.bound, far + size * (6 * 0x1p-53));
        }
        for_each_table([&](const Table& table) {
            const double* first = blocks[0].at[0].data();
            ASSERT_EQ(table.farthest(first, blocks.size(), from.direction), plain);
            const FarthestPoint found = table.farthest_moved(first, blocks.size(), from);
            ASSERT_EQ(found.number, best.number);
            ASSERT_EQ(found.value, best.value);
            ASSERT_EQ(found.bound, best.bound);
        });
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(ties, 1000);
}

// The reference is the formula, point by point; every table must give the same numbers.
TEST(Kernels, ReachesAreTheSameForEveryTable) {
    std::mt19937 random(78);
    for (int trial = 0; trial < 1000; ++trial) {
        const auto directions = random_blocks(random, 1 + random() % 40, false);
        std::vector<Double3> points(1 + random() % 20);
        for (Double3& p : points) p = test::random_pose(random, 2).translation();
        for_each_table([&](const Table& table) {
            std::vector<double> reaches(8 * directions.size(), HUGE_VAL);
            table.reaches(directions[0].at[0].data(), directions.size(), &points[0].x,
                          points.size(), reaches.data());
            for (std::size_t i = 0; i < reaches.size(); ++i) {
                const auto& at = directions[i / 8].at;
                const Double3 n = {at[0][i % 8], at[1][i % 8], at[2][i % 8]};
                double most = -HUGE_VAL;
                for (const Double3& p : points) most = std::max(most, dot(n, p));
                ASSERT_EQ(reaches[i], most);
            }
        });
        if (HasFatalFailure()) return;
    }
}

/// An edge of small whole numbers, whose heights are exact, or of others.
OneEdge random_edge(std::mt19937& random, bool coarse) {
    OneEdge edge{};
    std::uniform_real_distribution<double> fine(-3, 3);
    const auto number = [&] {
        return coarse ? static_cast<double>(random() % 7) - 3 : fine(random);
    };
    for (double* vector : {edge.along, edge.left, edge.right}) {
        for (std::size_t axis = 0; axis < 3; ++axis) vector[axis] = number();
    }
    edge.length = std::sqrt(edge.along[0] * edge.along[0] + edge.along[1] * edge.along[1] +
                            edge.along[2] * edge.along[2]);
    return edge;
}

// An edge stays unless two of the four corners are on different sides of the plane of both.
TEST(Kernels, EdgesAcrossAreTheSameForEveryTable) {
    std::mt19937 random(79);
    const auto vector = [](const double* p) { return Double3{p[0], p[1], p[2]}; };
    int left_out = 0, at_the_limit = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const bool coarse = trial % 4 < 2;
        const OneEdge edge = random_edge(random, coarse);
        std::array<OneEdge, 16> others;
        std::array<EdgeLanes, 2> lanes;
        for (std::size_t i = 0; i < others.size(); ++i) {
            others[i] = random_edge(random, coarse);
            EdgeLanes& block = lanes[i / 8];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.along[axis][i % 8] = others[i].along[axis];
                block.left[axis][i % 8] = others[i].left[axis];
                block.right[axis][i % 8] = others[i].right[axis];
            }
            block.length[i % 8] = others[i].length;
        }
        const double error = trial % 2 == 0 ? 0 : 0.25;
        std::array<bool, 16> stays;
        for (std::size_t i = 0; i < others.size(); ++i) {
            const Double3 n = cdprep::cross(vector(edge.along), vector(others[i].along));
            const std::array heights = {dot(n, vector(edge.left)), dot(n, vector(edge.right)),
                                        -dot(n, vector(others[i].left)),
                                        -dot(n, vector(others[i].right))};
            const double slack = edge.length * others[i].length * error;
            const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
            stays[i] = !(*most > slack && *least < -slack);
            left_out += stays[i] ? 0 : 1;
            at_the_limit += *most == slack || *least == -slack ? 1 : 0;
        }
        for_each_table([&](const Table& table) {
            std::array<std::uint8_t, 2> across = {0xaa, 0x55};
            table.edges_across(lanes.data(), lanes.size(), edge, error, across.data());
            for (std::size_t i = 0; i < others.size(); ++i) {
                ASSERT_EQ((across[i / 8] >> (i % 8) & 1) != 0, stays[i]) << i;
            }
        });
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(left_out, 10'000);
    EXPECT_GT(at_the_limit, 500);
}

// By the points themselves, in double: between what two sets of points reach along a direction that
// goes with A there is never less than a plane that is not weak promises, however B has moved.
TEST(Kernels, APlaneThatIsNotWeakHasItsGap) {
    std::mt19937 random(31);
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> place(-0.5, 0.5);
    const auto point = [&](const Double3& middle, double size) {
        return Double3{middle.x + size * place(random), middle.y + size * place(random),
                       middle.z + size * place(random)};
    };
    const auto along = [](const Double3& d, const Double3& p) {
        return d.x * p.x + d.y * p.y + d.z * p.z;
    };
    const auto turned_back = [](const Pose& pose, const Double3& d) {
        const auto& r = pose.rotation();
        return Double3{r[0] * d.x + r[3] * d.y + r[6] * d.z, r[1] * d.x + r[4] * d.y + r[7] * d.z,
                       r[2] * d.x + r[5] * d.y + r[8] * d.z};
    };
    constexpr std::size_t kStride = 48;
    std::size_t strong = 0, weak = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Pose before = test::random_pose(random, 0.5);
        const double share = std::ldexp(1, -static_cast<int>(random() % 12));
        const Pose turn = Pose::from_quaternion(1, share * normal(random), share * normal(random),
                                                share * normal(random), {})
                              .value();
        const Pose after =
            relative_pose(Pose::from_quaternion(1, 0, 0, 0, {share * normal(random), 0, 0}).value(),
                          Pose::from_rows([&] {
                              std::array<double, 12> rows{};
                              for (std::size_t i = 0; i < 9; ++i) {
                                  for (std::size_t k = 0; k < 3; ++k) {
                                      rows[i] += turn.rotation()[3 * (i / 3) + k] *
                                                 before.rotation()[3 * k + i % 3];
                                  }
                              }
                              rows[9] = before.translation().x;
                              rows[10] = before.translation().y;
                              rows[11] = before.translation().z;
                              return rows;
                          }())
                              .value());
        const std::size_t count = 1 + random() % 40;
        std::vector<float> rows(11 * kStride, 0.0F);
        std::vector<double> gap(count);
        for (std::size_t i = 0; i < count; ++i) {
            Double3 n = {normal(random), normal(random), normal(random)};
            const double length = std::hypot(n.x, n.y, n.z) * (1 + 0x1p-20);
            const std::array<float, 3> unit = {static_cast<float>(n.x / length),
                                               static_cast<float>(n.y / length),
                                               static_cast<float>(n.z / length)};
            n = {unit[0], unit[1], unit[2]};
            const Double3 seen = turned_back(before, n), now = turned_back(after, n);
            const Double3 m = {static_cast<float>(seen.x), static_cast<float>(seen.y),
                               static_cast<float>(seen.z)};
            const double size = std::ldexp(0.5, -static_cast<int>(random() % 6));
            const Double3 in_a = point({}, 1), in_b = point({}, 1);
            const Double3 c = {static_cast<float>(in_b.x), static_cast<float>(in_b.y),
                               static_cast<float>(in_b.z)};
            double most_a = -HUGE_VAL, least_b = HUGE_VAL, least_now = HUGE_VAL, reach = 0;
            for (int k = 0; k < 12; ++k) {
                const Double3 p = point(in_a, size), q = point(c, size);
                most_a = std::max(most_a, along(n, p));
                least_b = std::min(least_b, along(m, q));
                least_now = std::min(least_now, along(now, q));
                reach = std::max(reach, std::hypot(q.x - c.x, q.y - c.y, q.z - c.z));
            }
            gap[i] = along(n, after.translation()) + least_now - most_a;
            const std::array<double, 11> values = {
                n.x, n.y, n.z, m.x, m.y, m.z, c.x, c.y, c.z, least_b - most_a, reach};
            for (std::size_t row = 0; row < 11; ++row) {
                rows[row * kStride + i] = static_cast<float>(values[row]);
            }
        }
        const double limit = std::max(0.0, place(random));
        // As place_boxes() has it for scales of 1.
        const BoxPlacement placement = placement_of(after, 32 * 0x1p-24F * 4);
        for_each_table([&](const Table& table) {
            std::array<std::uint16_t, kStride + 16> numbers;
            const std::size_t found = table.weak_planes(placement, {rows.data(), kStride}, count,
                                                        static_cast<float>(limit), numbers.data());
            ASSERT_LE(found, count);
            std::vector<bool> is_weak(count, false);
            for (std::size_t i = 0; i < found; ++i) {
                ASSERT_LT(numbers[i], count);
                ASSERT_TRUE(i == 0 || numbers[i - 1] < numbers[i]);
                is_weak[numbers[i]] = true;
            }
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_TRUE(is_weak[i] || gap[i] > static_cast<float>(limit));
                // With B where it was but for a little, a plane proves nearly all there is.
                const bool is_clear = share < 0.001 && gap[i] > limit + 0.01;
                ASSERT_FALSE(is_clear && is_weak[i]);
            }
            weak += found;
            strong += count - found;
        });
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(strong, (strong + weak) / 10);
    EXPECT_GT(weak, (strong + weak) / 10);
}

TEST(Kernels, ScalarIsAlwaysAvailable) {
    EXPECT_GE(available().count, 1u);
    EXPECT_STREQ(available().table[0]->name, "scalar");
}

TEST(Kernels, NeonIsAvailableOnArm64Alone) {
    const Available tables = available();
    const bool has_neon = std::string(tables.table[tables.count - 1]->name) == "neon";
#if defined(__aarch64__) || defined(_M_ARM64)
    EXPECT_TRUE(has_neon);
#else
    EXPECT_FALSE(has_neon);
#endif
}

// The operating system and the compiler agree with what the processor says.
#if defined(CDPREP_HAVE_AVX2) && defined(__GNUC__)
TEST(Kernels, TheProcessorIsAskedAsTheCompilerDoes) {
    const Processor processor = ask_processor();
    const auto is_set = [](int found) { return found != 0; };
    EXPECT_EQ(processor.avx2,
              is_set(__builtin_cpu_supports("avx2")) && is_set(__builtin_cpu_supports("fma")));
    EXPECT_EQ(processor.avx512, is_set(__builtin_cpu_supports("avx512f")) &&
                                    is_set(__builtin_cpu_supports("avx512vl")) &&
                                    is_set(__builtin_cpu_supports("avx512dq")) &&
                                    is_set(__builtin_cpu_supports("avx512cd")) &&
                                    is_set(__builtin_cpu_supports("avx512bw")));
    EXPECT_EQ(processor.bmi2, is_set(__builtin_cpu_supports("bmi2")));
    EXPECT_EQ(processor.is_intel, is_set(__builtin_cpu_is("intel")));
    EXPECT_EQ(processor.is_amd, is_set(__builtin_cpu_is("amd")));
}
#endif

}  // namespace
}  // namespace cdprep::kernels
