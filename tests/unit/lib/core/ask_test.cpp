// SPDX-License-Identifier: MIT
// What a model serves follows from its sections: the expected answers are read off the table of
// needs by hand.
#include "cdprep/ask.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <string>
#include <utility>

#include "support/open_tiny.h"

#include "cdprep/precondition.h"
#include "core/require.h"

namespace cdprep {
namespace {

using test::AlignedBytes;
using test::bake_tiny;
using test::TinyOptions;

AlignedBytes baked_cube(SectionSet leave_out = {}, bool double_precision = false) {
    const test::TestMesh cube = test::unit_cube();
    return bake_tiny(cube.positions, cube.triangles,
                     {.double_precision = double_precision, .leave_out = leave_out});
}

Ask asks_of(const AlignedBytes& file) {
    const Result<Model> opened = Model::open(file.span());
    return opened ? opened.value().asks() : Ask::nothing;
}

// Each row is one bit; a name of two rows would make --effects ambiguous.
TEST(Needs, EveryRowHasABitAndANameOfItsOwn) {
    Ask seen = Ask::nothing;
    std::set<std::string> names;
    for (const Needs& row : needs()) {
        EXPECT_EQ(std::popcount(static_cast<std::uint32_t>(row.ask)), 1) << row.name;
        EXPECT_FALSE(contains(seen, row.ask)) << row.name;
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_EQ(find_needs(row.ask), &row);
        EXPECT_EQ(find_needs(std::string_view(row.name)), &row);
        seen = seen | row.ask;
    }
    EXPECT_EQ(known_asks(), seen);
}

// A bake opens and writes what the table names; served_by() must then agree.
TEST(Needs, TheSectionsOfAnAskServeIt) {
    for (const Needs& row : needs()) {
        EXPECT_TRUE(contains(served_by(sections_for(row.ask), false), row.ask)) << row.name;
        EXPECT_EQ(missing_sections(row.ask, sections_for(row.ask), false), SectionSet{})
            << row.name;
    }
}

// Every section that a row needs is needed: without it the ask is not served.
TEST(Needs, AnAskIsNotServedWithoutAnyOneSectionThatItNeeds) {
    int asked = 0;
    for (const Needs& row : needs()) {
        for (std::uint32_t number = 1; number < 64; ++number) {
            const SectionId id{number};
            if (!row.needed.contains(id)) continue;
            ++asked;
            SectionSet sections = sections_for(row.ask);
            sections.erase(id);
            EXPECT_FALSE(contains(served_by(sections, false), row.ask)) << row.name << number;
            EXPECT_TRUE(missing_sections(row.ask, sections, false).contains(id)) << row.name;
        }
    }
    EXPECT_GT(asked, 50);
}

// Leaves that hold the corners without loss serve for positions and triangles; others do not.
TEST(Needs, ExactLeavesServeForCorners) {
    const SectionSet leaves = {SectionId::bvh_nodes, SectionId::bvh_leaves};
    EXPECT_TRUE(contains(served_by(leaves, true), Ask::collide));
    EXPECT_FALSE(contains(served_by(leaves, false), Ask::collide));
    EXPECT_FALSE(contains(served_by(leaves, true), Ask::solid));
}

// A complete tiny bake has a BVH, numbers and components, but no pieces, octrees or hulls.
TEST(Asks, OfATinyBakeAreThoseOfItsSections) {
    const Ask all = Ask::collide | Ask::overlap | Ask::distance | Ask::within | Ask::inside |
                    Ask::ray | Ask::closest | Ask::touch | Ask::corners | Ask::solid |
                    Ask::continuous | Ask::self | Ask::deform | Ask::tear | Ask::haptic;
    EXPECT_EQ(asks_of(baked_cube()), all);
    EXPECT_EQ(asks_of(baked_cube({}, true)), all);
    EXPECT_EQ(asks_of(baked_cube({SectionId::components})), without(all, Ask::solid));
    EXPECT_EQ(asks_of(baked_cube({SectionId::source_triangle})),
              Ask::collide | Ask::inside | Ask::solid);
    EXPECT_EQ(asks_of(baked_cube({SectionId::bvh_leaves})),
              Ask::inside | Ask::ray | Ask::closest | Ask::touch | Ask::corners | Ask::solid);
}

TEST(Asks, AreServedAsOneSet) {
    const auto open = test::open_tiny(baked_cube({SectionId::components}));
    EXPECT_TRUE(open.model.serves(Ask::nothing));
    EXPECT_TRUE(open.model.serves(Ask::collide | Ask::ray));
    EXPECT_FALSE(open.model.serves(Ask::collide | Ask::solid));
}

TEST(OpenForAsks, FailsWithTheMissingSectionsAndTheOptionThatAddsThem) {
    const AlignedBytes file = baked_cube({SectionId::bvh_leaves});
    const auto opened = Model::open(file.span(), OpenOptions{.asks = Ask::overlap, .name = "c"});
    ASSERT_FALSE(opened.ok());
    EXPECT_EQ(opened.error().code, ErrorCode::bad_argument);
    EXPECT_EQ(opened.error().message,
              "c: overlap needs section bvh_leaves, which is missing. Bake the mesh again with "
              "--effects overlap.");
}

TEST(OpenForAsks, OpensWhatIsNeededAndUsedAndNothingElse) {
    const AlignedBytes file = baked_cube();
    const auto opened = Model::open(file.span(), OpenOptions{.asks = Ask::ray});
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    EXPECT_TRUE(opened.value().serves(Ask::ray));
    EXPECT_FALSE(opened.value().sections().contains(SectionId::bvh_leaves));
    EXPECT_FALSE(opened.value().serves(Ask::collide));
}

TEST(Refusal, TellsWhatWasNotOpenedFromWhatWasNotBaked) {
    const AlignedBytes file = baked_cube({SectionId::components});
    const auto opened = Model::open(file.span(), sections_for(Ask::ray));
    ASSERT_TRUE(opened.ok());
    const auto not_opened = opened.value().refusal(Ask::collide);
    ASSERT_TRUE(not_opened);
    EXPECT_EQ(not_opened->reason, Refusal::Reason::not_opened);
    EXPECT_EQ(not_opened->message,
              "memory: collide needs section bvh_leaves, which was not opened. Open the model for "
              "this query.");
    const auto not_baked = opened.value().refusal(Ask::collide | Ask::solid);
    ASSERT_TRUE(not_baked);
    EXPECT_EQ(not_baked->reason, Refusal::Reason::not_baked);
    EXPECT_EQ(not_baked->message,
              "memory: solid needs section components, which is missing. Bake the mesh again with "
              "--effects collide.");
    EXPECT_FALSE(opened.value().refusal(Ask::ray));
}

TEST(Refusal, KnowsThatOnlyBalancedMeshesHaveMass) {
    const auto cube = test::open_tiny(baked_cube());
    EXPECT_NE(cube.model.refusal(Ask::response)->message.find("with --effects response"),
              std::string::npos);
    const std::vector<Double3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<test::Triangle> one = {{{0, 1, 2}}};
    const auto sheet = test::open_tiny(corners, one);
    EXPECT_NE(sheet.model.refusal(Ask::response)->message.find("--repair closed"),
              std::string::npos);
}

TEST(Refusal, OfABitThatThisVersionDoesNotKnowSaysSo) {
    const auto open = test::open_tiny(baked_cube());
    const auto refused = open.model.refusal(Ask{1U << 29});
    ASSERT_TRUE(refused);
    EXPECT_NE(refused->message.find("does not know"), std::string::npos);
}

// Flags of leaves mean nothing where there are none: what is missing is the corners.
TEST(Refusal, OfAnEmptyModelNamesTheMissingSections) {
    const auto empty = bake_tiny({}, {});
    const auto opened = Model::open(
        empty.span(), {SectionId::bvh_nodes, SectionId::bvh_leaves, SectionId::source_triangle});
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    const auto refused = opened->refusal(Ask::overlap);
    ASSERT_TRUE(refused);
    EXPECT_NE(refused->message.find("positions, triangles"), std::string::npos) << refused->message;
}

// Contacts look up corners by number, also where leaves hold the corners without loss.
TEST(Needs, ContactsAreNotServedWithoutTriangles) {
    SectionSet sections = sections_for(Ask::contacts);
    sections.erase(SectionId::triangles);
    EXPECT_FALSE(contains(served_by(sections, true), Ask::contacts));
}

TEST(Refusal, OfAModelThatWasMovedAwayIsASentence) {
    auto open = test::open_tiny(baked_cube());
    const Model taken = std::move(open.model);
    EXPECT_TRUE(taken.serves(Ask::collide));
    EXPECT_FALSE(open.model.serves(Ask::collide));  // NOLINT: what is left is asked on purpose
    EXPECT_TRUE(open.model.refusal(Ask::collide));
}

using RequireDeathTest = ::testing::Test;

TEST(RequireDeathTest, StopsWithTheSentenceInEveryBuild) {
    const auto open = test::open_tiny(baked_cube({SectionId::bvh_leaves}));
    EXPECT_DEATH(require(open.model, Ask::collide),
                 "memory: collide needs section bvh_leaves, which is missing");
}

TEST(RequireDeathTest, CallsTheHandlerOfTheProgramFirst) {
    const auto open = test::open_tiny(baked_cube({SectionId::bvh_leaves}));
    const auto ask = [&] {
        set_precondition_handler([](const char*) { std::fputs("handled\n", stderr); });
        require(open.model, Ask::collide);
    };
    EXPECT_DEATH(ask(), "handled");
}

TEST(PreconditionHandler, IsReturnedWhenItIsReplaced) {
    const PreconditionHandler mine = [](const char*) {};
    const PreconditionHandler before = set_precondition_handler(mine);
    EXPECT_NE(before, mine);
    EXPECT_EQ(set_precondition_handler(nullptr), mine);
    EXPECT_EQ(set_precondition_handler(before), before);
}

}  // namespace
}  // namespace cdprep
