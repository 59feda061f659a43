// SPDX-License-Identifier: MIT
#include "cdprep/format/find_damage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "cdprep/format/sections.h"
#include "cdprep/format/verdict.h"
#include "support/changed_sections.h"
#include "support/open_tiny.h"
#include "support/reseal.h"

namespace cdprep::format {
namespace {

using test::AlignedBytes;
using test::damage_of;
using test::with;

AlignedBytes baked_cube() {
    const test::TestMesh cube = test::unit_cube();
    return test::bake_tiny(cube.positions, cube.triangles);
}

AlignedBytes copy_of(const AlignedBytes& file) {
    return AlignedBytes(file.span());
}

std::uint64_t start_of(const AlignedBytes& file, SectionId id) {
    return find_section(file.span(), id).value().offset;
}

DamageKind kind_of(const std::optional<Damage>& damage) {
    return damage ? damage->kind : DamageKind{0};
}

TEST(FindDamage, AcceptsWhatTheBakerMakes) {
    EXPECT_FALSE(damage_of(baked_cube()));
    const test::TestMesh empty;
    EXPECT_FALSE(damage_of(test::bake_tiny(empty.positions, empty.triangles)));
    EXPECT_FALSE(find_deep_damage(baked_cube().span()));
}

TEST(FindDamage, RejectsEveryTruncation) {
    const AlignedBytes file = baked_cube();
    for (std::size_t size = 0; size < file.size(); ++size) {
        // An allocation of exactly that size: a sanitizer sees one byte too many.
        const AlignedBytes cut(std::span(std::as_const(file).span()).first(size));
        ASSERT_TRUE(damage_of(cut)) << "accepted " << size << " bytes";
    }
}

/// Bytes that belong to the user block or to a section.
std::vector<bool> covered_bytes(const AlignedBytes& file) {
    std::vector<bool> covered(file.size(), false);
    const auto cover = [&](std::uint64_t first, std::uint64_t count) {
        for (std::uint64_t i = first; i < first + count; ++i) covered[i] = true;
    };
    cover(0, kUserBlockSize);
    cover(kUserBlockSize + 8, 40);  // the superblock's stamp
    const FileHeader header = read_header(file.span());
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
        SectionEntry entry;
        std::memcpy(&entry, file.span().data() + kSectionTableOffset + i * sizeof entry,
                    sizeof entry);
        cover(entry.offset, entry.count * entry.element_size);
    }
    return covered;
}

TEST(FindDamage, RejectsEveryFlippedBitThatIsNotPadding) {
    AlignedBytes file = baked_cube();
    const std::vector<bool> covered = covered_bytes(file);
    for (std::size_t i = 0; i < file.size(); ++i) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            file.span()[i] ^= std::byte(1U << bit);
            ASSERT_EQ(damage_of(file).has_value(), covered[i]) << "byte " << i << ", bit " << bit;
            file.span()[i] ^= std::byte(1U << bit);
        }
    }
}

TEST(FindDamage, NamesWhatIsForeign) {
    const AlignedBytes file = baked_cube();
    EXPECT_EQ(kind_of(damage_of(AlignedBytes())), DamageKind::too_short);
    EXPECT_EQ(kind_of(damage_of(with(file, 0, 'x'))), DamageKind::bad_magic);
    EXPECT_EQ(kind_of(damage_of(with(file, offsetof(FileHeader, version), kVersion + 1))),
              DamageKind::bad_version);
    EXPECT_EQ(kind_of(damage_of(with(file, offsetof(FileHeader, endian_mark), 0x04030201U))),
              DamageKind::bad_byte_order);
    EXPECT_EQ(kind_of(damage_of(with(file, offsetof(FileHeader, required_features), 1U))),
              DamageKind::unknown_feature);
    AlignedBytes moved = copy_of(file);
    moved.span()[kUserBlockSize + 20] = std::byte{1};
    EXPECT_EQ(kind_of(damage_of(moved)), DamageKind::rewritten);
}

// Every 32-bit word of header and table at 0, 1, the maximum and off by one: an
// answer or an acceptance, but never a read outside (the sanitizer would tell).
TEST(FindDamage, SurvivesEveryHeaderFieldAtItsLimits) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t end =
        kSectionTableOffset + read_header(file.span()).section_count * sizeof(SectionEntry);
    std::size_t refused = 0, tried = 0;
    for (std::uint64_t at = 0; at < end; at += 4) {
        std::uint32_t now = 0;
        std::memcpy(&now, file.span().data() + at, sizeof now);
        for (const std::uint32_t value : {0U, 1U, 0x7fffffffU, 0xffffffffU, now - 1, now + 1}) {
            if (value == now) continue;
            ++tried;
            refused += damage_of(with(file, at, value)) ? 1 : 0;
        }
    }
    EXPECT_GT(refused, tried / 2);
}

TEST(FindDamage, CountsCannotWrapAround) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t count_at = kSectionTableOffset + offsetof(SectionEntry, count);
    const std::uint64_t offset_at = kSectionTableOffset + offsetof(SectionEntry, offset);
    for (const std::uint64_t count :
         {~std::uint64_t{0}, std::uint64_t{1} << 62, (~std::uint64_t{0}) / sizeof(Float3) + 2}) {
        EXPECT_EQ(kind_of(damage_of(with(file, count_at, count))), DamageKind::bad_section);
    }
    for (const std::uint64_t offset :
         {~std::uint64_t{63}, std::uint64_t{64}, std::uint64_t{4097}}) {
        EXPECT_EQ(kind_of(damage_of(with(file, offset_at, offset))), DamageKind::bad_section);
    }
}

TEST(FindDamage, SectionsMayNotShareBytes) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t second = kSectionTableOffset + sizeof(SectionEntry);
    const std::uint64_t first_offset = start_of(file, SectionId::positions_f32);
    EXPECT_EQ(kind_of(damage_of(with(file, second + offsetof(SectionEntry, offset), first_offset))),
              DamageKind::bad_section);
}

TEST(FindDamage, IndicesMustLieInRange) {
    const AlignedBytes file = baked_cube();
    const auto bad = [&](SectionId id) {
        return kind_of(damage_of(with(file, start_of(file, id), 99U)));
    };
    EXPECT_EQ(bad(SectionId::triangles), DamageKind::bad_index);
    EXPECT_EQ(bad(SectionId::source_triangle), DamageKind::bad_index);
    EXPECT_EQ(bad(SectionId::components), DamageKind::bad_index);
}

TEST(FindDamage, NumbersMustBeFinite) {
    const AlignedBytes file = baked_cube();
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(kind_of(damage_of(with(file, start_of(file, SectionId::positions_f32), value))),
                  DamageKind::bad_number);
        EXPECT_EQ(kind_of(damage_of(with(file, start_of(file, SectionId::bvh_nodes), value))),
                  DamageKind::bad_number);
    }
}

// The largest and the smallest mesh have the extreme exponents, by hand: 2^1000 * 2^-1002 is 1/4,
// and so is 2^-1074 * 2^1072.
TEST(FindDamage, FrameExponentsAreThoseOfABake) {
    const std::vector<Triangle> triangle = {{{0, 1, 2}}};
    const auto exponent_of = [&](double low, double high) {
        const std::vector<Double3> corners = {{low, low, 0}, {high, low, 0}, {low, high, 0}};
        const AlignedBytes file = test::bake_tiny(corners, triangle, {.double_precision = true});
        EXPECT_FALSE(find_deep_damage(file.span()));
        return read_header(file.span()).frame_exponent;
    };
    EXPECT_EQ(exponent_of(-kMaxCoordinate, kMaxCoordinate), kMinFrameExponent);
    EXPECT_EQ(exponent_of(0, std::numeric_limits<double>::denorm_min()), kMaxFrameExponent);
    EXPECT_EQ(exponent_of(0, 0), 0);
    const AlignedBytes cube = baked_cube();
    const auto kind_with = [&](std::int32_t exponent) {
        return kind_of(damage_of(with(cube, offsetof(FileHeader, frame_exponent), exponent)));
    };
    EXPECT_EQ(kind_with(kMinFrameExponent), DamageKind{0});
    EXPECT_EQ(kind_with(kMaxFrameExponent), DamageKind{0});
    for (const std::int32_t wrong :
         {kMinFrameExponent - 1, kMaxFrameExponent + 1, -1100, 1100,
          std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()}) {
        EXPECT_EQ(kind_with(wrong), DamageKind::bad_header) << wrong;
    }
}

// Two leaves: boxes 0 and 1 are used, the other six are not.
TEST(FindDamage, BoxesLieInTheFrameAndAreOrdered) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t nodes = start_of(file, SectionId::bvh_nodes);
    const auto damage_with = [&](bool is_upper, std::uint64_t axis, std::uint64_t box, float x) {
        const std::uint64_t row = is_upper ? offsetof(BvhNode, upper) : offsetof(BvhNode, lower);
        return damage_of(with(file, nodes + row + 4 * (axis * kBvhWidth + box), x));
    };
    const float above = std::nextafter(1.0F, 2.0F);
    for (std::uint64_t axis = 0; axis < 3; ++axis) {
        for (std::uint64_t box = 0; box < kBvhWidth; ++box) {
            for (const bool is_upper : {false, true}) {
                for (const float wrong : {-above, above, -1e30F, 1e30F}) {
                    const auto damage = damage_with(is_upper, axis, box, wrong);
                    ASSERT_EQ(kind_of(damage), DamageKind::bad_box) << axis << " " << box;
                    EXPECT_EQ(damage->section, SectionId::bvh_nodes);
                    EXPECT_EQ(damage->at, nodes);
                    EXPECT_EQ(damage->found, box);
                }
                const float nan = std::numeric_limits<float>::quiet_NaN();
                EXPECT_EQ(kind_of(damage_with(is_upper, axis, box, nan)), DamageKind::bad_number);
            }
            const bool is_used = box < 2;
            EXPECT_EQ(damage_with(false, axis, box, -1).has_value(), false);
            EXPECT_EQ(damage_with(true, axis, box, 1).has_value(), false);
            EXPECT_EQ(damage_with(false, axis, box, 1).has_value(), is_used);
            EXPECT_EQ(damage_with(true, axis, box, -1).has_value(), is_used);
        }
    }
}

TEST(FindDamage, CountsMustMatchTheHeader) {
    int asked = 0;
    const AlignedBytes file = baked_cube();
    for (std::uint32_t i = 0; i < read_header(file.span()).section_count; ++i) {
        const std::uint64_t at =
            kSectionTableOffset + i * sizeof(SectionEntry) + offsetof(SectionEntry, count);
        std::uint64_t count = 0;
        std::memcpy(&count, file.span().data() + at, sizeof count);
        if (count < 2) continue;
        ++asked;
        const DamageKind kind = kind_of(damage_of(with(file, at, count - 1)));
        EXPECT_TRUE(kind == DamageKind::bad_count) << "entry " << i;
    }
    EXPECT_GE(asked, 5);
}

TEST(FindDamage, PositionsAndTrianglesNeedEachOther) {
    const test::TestMesh cube = test::unit_cube();
    const AlignedBytes file =
        test::bake_tiny(cube.positions, cube.triangles, {.leave_out = {SectionId::positions_f32}});
    EXPECT_EQ(kind_of(damage_of(file)), DamageKind::missing_section);
    const AlignedBytes no_triangles =
        test::bake_tiny(cube.positions, cube.triangles, {.leave_out = {SectionId::triangles}});
    EXPECT_EQ(kind_of(damage_of(no_triangles)), DamageKind::missing_section);
}

std::vector<test::TinySection> names_and_runs(std::uint32_t first, std::uint32_t count, char end) {
    std::vector<test::TinySection> sections;
    const NamedRun run{first, count, 0, 0};
    const auto* bytes = reinterpret_cast<const std::byte*>(&run);
    sections.push_back({SectionId::group_runs, {bytes, bytes + sizeof run}});
    sections.push_back({SectionId::group_names, {std::byte{'g'}, std::byte(end)}});
    return sections;
}

std::vector<test::TinySection> verdicts_of(const std::vector<Verdict>& verdicts) {
    const auto bytes = std::as_bytes(std::span(verdicts));
    return {{SectionId::verdicts, {bytes.begin(), bytes.end()}}};
}

TEST(FindDamage, VerdictsAreOfAllTrianglesAndThenOfParts) {
    FileHeader facts{};
    facts.triangle_count = 12;
    const auto of = [](std::uint32_t triangles, std::uint32_t first, double area) {
        return Verdict{verdict_closed, promise_surface, triangles, first, 0, 2, 0, 0, area, 1};
    };
    const auto kind = [&](const std::vector<Verdict>& verdicts) {
        return kind_of(damage_of(test::assemble(facts, verdicts_of(verdicts))));
    };
    EXPECT_FALSE(damage_of(test::assemble(facts, verdicts_of({of(12, 0, 6)}))));
    EXPECT_FALSE(
        damage_of(test::assemble(facts, verdicts_of({of(12, 0, 6), of(8, 0, 4), of(4, 8, 2)}))));
    // Triangles that repeat a corner belong to no component.
    EXPECT_FALSE(damage_of(test::assemble(facts, verdicts_of({of(12, 0, 6), of(8, 0, 4)}))));
    EXPECT_EQ(kind({}), DamageKind::bad_count);
    EXPECT_EQ(kind({of(11, 0, 6)}), DamageKind::bad_count);
    EXPECT_EQ(kind({of(12, 0, 6), of(8, 0, 4), of(5, 8, 2)}), DamageKind::bad_count);
    const auto behind = damage_of(test::assemble(facts, verdicts_of({of(12, 12, 6)})));
    EXPECT_EQ(kind_of(behind), DamageKind::bad_index);
    EXPECT_EQ(behind->limit, 11U);
    EXPECT_EQ(kind({of(12, 0, std::numeric_limits<double>::infinity())}), DamageKind::bad_number);
}

TEST(FindDamage, RunsCoverAllTrianglesAndNamesEnd) {
    FileHeader facts{};
    facts.triangle_count = 12;
    EXPECT_FALSE(damage_of(test::assemble(facts, names_and_runs(0, 12, '\0'))));
    EXPECT_EQ(kind_of(damage_of(test::assemble(facts, names_and_runs(1, 11, '\0')))),
              DamageKind::bad_order);
    EXPECT_EQ(kind_of(damage_of(test::assemble(facts, names_and_runs(0, 11, '\0')))),
              DamageKind::bad_order);
    EXPECT_EQ(kind_of(damage_of(test::assemble(facts, names_and_runs(0, 12, 'x')))),
              DamageKind::bad_order);
}

TEST(FindDamage, LooksOnlyAtWhatIsWanted) {
    AlignedBytes file = baked_cube();
    file.span()[start_of(file, SectionId::source_vertex)] ^= std::byte{1};
    EXPECT_EQ(kind_of(damage_of(file)), DamageKind::bad_checksum);
    EXPECT_FALSE(damage_of(file, {SectionId::positions_f32, SectionId::triangles}));
}

TEST(FindDeepDamage, SeesABoxThatLostItsTriangle) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t upper = start_of(file, SectionId::bvh_nodes) + offsetof(BvhNode, upper);
    EXPECT_EQ(kind_of(find_deep_damage(with(file, upper, -2.0F).span())), DamageKind::bad_box);
}

TEST(FindDeepDamage, SeesALeafThatLostACorner) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t leaf = start_of(file, SectionId::bvh_leaves);
    EXPECT_EQ(kind_of(find_deep_damage(with(file, leaf, 0.25F).span())), DamageKind::bad_fact);
    const std::uint64_t half = leaf + offsetof(BvhLeaf, half);
    EXPECT_EQ(kind_of(find_deep_damage(with(file, half, 0.0F).span())), DamageKind::bad_fact);
}

// One leaf about the origin, in a frame of exponent 0: its corners are the same numbers whether
// they are model coordinates or not. One tenth is no float.
TEST(FindDeepDamage, SeesLeavesThatLoseWhatTheFlagSaysTheyKeep) {
    const double a = 0.25;
    const double b = 0.1;
    const std::vector<Double3> corners = {{a, 0, 0},  {-a, 0, 0}, {0, a, 0},
                                          {0, -a, 0}, {0, 0, b},  {0, 0, -b}};
    const std::vector<Triangle> triangles = {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}},
                                             {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}};
    const AlignedBytes file = test::bake_tiny(corners, triangles, {.double_precision = true});
    EXPECT_FALSE(find_deep_damage(file.span()));
    ASSERT_EQ(read_header(file.span()).frame_exponent, 0);
    const std::uint32_t flags = read_header(file.span()).flags;
    ASSERT_EQ(flags & model_exact_leaves, 0U);
    const AlignedBytes forged = with(file, offsetof(FileHeader, flags), flags | model_exact_leaves);
    const auto damage = find_deep_damage(forged.span());
    ASSERT_TRUE(damage);
    EXPECT_EQ(damage->kind, DamageKind::bad_fact);
    EXPECT_EQ(damage->section, SectionId::bvh_leaves);
}

TEST(FindDeepDamage, SeesAnOrientedBoxThatIsTooSmallOrCrooked) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t node = start_of(file, SectionId::oriented_nodes);
    const std::uint64_t half = node + offsetof(OrientedNode, half);
    EXPECT_EQ(kind_of(find_deep_damage(with(file, half, 0.0F).span())), DamageKind::bad_box);
    EXPECT_EQ(kind_of(find_deep_damage(with(file, node, 0.5F).span())), DamageKind::bad_box);
}

AlignedBytes cube_with(build::BvhBounds bounds) {
    const test::TestMesh cube = test::unit_cube();
    return test::bake_tiny(cube.positions, cube.triangles, {.bounds = bounds});
}

TEST(FindDeepDamage, SeesASweptSphereThatIsTooSmallOrCrooked) {
    for (const auto bounds : {build::BvhBounds::swept_points, build::BvhBounds::swept_lines,
                              build::BvhBounds::swept_rectangles}) {
        const AlignedBytes file = cube_with(bounds);
        EXPECT_FALSE(find_deep_damage(file.span()));
        const std::uint64_t node = start_of(file, SectionId::swept_nodes);
        const std::uint64_t radius = node + offsetof(SweptNode, radius);
        const std::uint64_t axis = node + offsetof(SweptNode, side);
        EXPECT_EQ(kind_of(find_deep_damage(with(file, radius, 0.0F).span())), DamageKind::bad_box);
        EXPECT_EQ(kind_of(find_deep_damage(with(file, node, 0.9F).span())), DamageKind::bad_box);
        const std::array<std::array<float, 8>, 3> skew = {{{0.6F}, {0.8002F}, {0}}};
        AlignedBytes crooked = copy_of(file);
        for (std::size_t i = 0; i < 3; ++i) {
            crooked = with(crooked, axis + sizeof(float) * kBvhWidth * i, skew[i][0]);
        }
        EXPECT_EQ(kind_of(find_deep_damage(crooked.span())), DamageKind::bad_box);
    }
}

TEST(FindDamage, SweptSpheresHaveUnitAxesAndTheSidesOfTheirKind) {
    const AlignedBytes file = cube_with(build::BvhBounds::swept_lines);
    const std::uint64_t node = start_of(file, SectionId::swept_nodes);
    const std::uint64_t radius = node + offsetof(SweptNode, radius);
    const std::uint64_t side = node + offsetof(SweptNode, side);
    const std::uint64_t half = side + offsetof(SweptSide, half);
    EXPECT_FALSE(damage_of(with(file, radius, 2.0F)));
    EXPECT_FALSE(damage_of(with(file, half, 2.0F)));
    for (const auto& [at, wrong] :
         {std::pair{radius, -1.0F}, std::pair{radius, std::numeric_limits<float>::infinity()},
          std::pair{node, std::numeric_limits<float>::quiet_NaN()}, std::pair{side, 3.0F},
          std::pair{half, -1.0F}, std::pair{half + sizeof(SweptSide), 1.0F}}) {
        EXPECT_EQ(kind_of(damage_of(with(file, at, wrong))), DamageKind::bad_number) << at - node;
    }
}

TEST(FindDamage, LeavesNameHowManyTrianglesTheyHold) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t count = start_of(file, SectionId::bvh_leaves) + offsetof(BvhLeaf, count);
    for (const std::uint32_t wrong : {0u, 7u, 9u, 0xffffffffu}) {
        EXPECT_EQ(kind_of(damage_of(with(file, count, wrong))), DamageKind::bad_count);
    }
}

TEST(FindDeepDamage, SeesASourceTriangleNamedTwice) {
    const AlignedBytes file = baked_cube();
    const std::uint64_t at = start_of(file, SectionId::source_triangle);
    std::uint32_t second = 0;
    std::memcpy(&second, file.span().data() + at + 4, sizeof second);
    EXPECT_EQ(kind_of(find_deep_damage(with(file, at, second).span())), DamageKind::bad_fact);
}

}  // namespace
}  // namespace cdprep::format
