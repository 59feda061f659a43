// SPDX-License-Identifier: MIT
// Every set of sections that a bake or a build can have, and every question: the answer of a bake
// that has everything, or the refusal. There is no third outcome.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/ask.h"
#include "cdprep/cells.h"
#include "cdprep/format/sections.h"
#include "support/c_models.h"
#include "support/c_questions.h"
#include "support/cpp_questions.h"
#include "support/every_structure.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

/// In every bake, whatever it serves.
constexpr SectionSet kAlways = {SectionId::bounds, SectionId::provenance, SectionId::verdicts,
                                SectionId::findings};

TestMesh cube_of(double lower, double size) {
    TestMesh cube = unit_cube();
    for (Double3& p : cube.positions) {
        p = {lower + size * p.x, lower + size * p.y, lower + size * p.z};
    }
    return cube;
}

/// A bake with everything.
AlignedBytes whole(const TestMesh& mesh) {
    const AlignedBytes plain = bake_tiny(mesh.positions, mesh.triangles);
    const format::MassProperties mass = {1, 6, {0.5, 0.5, 0.5}, {1, 1, 1, 0, 0, 0}};
    const AlignedBytes solid =
        with_sections(with_every_structure(with_contacts(with_one_piece(plain))),
                      {as_section(SectionId::mass_properties,
                                  std::span<const format::MassProperties>(&mass, 1))});
    return with_hulls(solid);
}

/// The same file with those of its sections alone.
AlignedBytes only(const AlignedBytes& file, SectionSet kept) {
    std::vector<TinySection> sections;
    for (std::uint32_t number = 1; number < 64; ++number) {
        const SectionId id{number};
        const auto entry = format::find_section(file.span(), id);
        if (!entry || !kept.contains(id)) continue;
        const auto bytes = file.span().subspan(entry->offset, entry->count * entry->element_size);
        sections.push_back({id, {bytes.begin(), bytes.end()}});
    }
    return assemble(format::read_header(file.span()), sections);
}

bool is_less(SectionSet a, SectionSet b) {
    for (std::uint32_t number = 0; number < 64; ++number) {
        const bool in_a = a.contains(SectionId{number}), in_b = b.contains(SectionId{number});
        if (in_a != in_b) return in_b;
    }
    return false;
}

bool is_structure(const Needs& row) {
    return std::string(row.bake_option).starts_with("--structures");
}

/// What a bake can be asked to serve: every union of effects, each once, without structures; and
/// every structure beside the default effects, alone and together.
std::vector<SectionSet> bakes() {
    std::vector<SectionSet> effects, structures;
    for (const Needs& row : needs()) {
        SectionSet sections = row.needed;
        sections.insert(row.used);
        if (row.vertices != Vertices::none) {
            sections.insert({SectionId::positions_f32, SectionId::triangles});
        }
        // Structures are baked by another option, whole or not at all.
        if (!is_structure(row)) sections.erase(SectionId::tetra_tree);
        (is_structure(row) ? structures : effects).push_back(sections);
    }
    std::set<SectionSet, decltype(&is_less)> unions(is_less);
    unions.insert(kAlways);
    for (const SectionSet effect : effects) {
        std::vector<SectionSet> more(unions.begin(), unions.end());
        for (SectionSet sections : more) {
            sections.insert(effect);
            unions.insert(sections);
        }
    }
    std::vector<SectionSet> all(unions.begin(), unions.end());
    SectionSet plain = sections_for(Ask::collide | Ask::overlap | Ask::inside), both = plain;
    for (const SectionSet structure : structures) {
        SectionSet with_one = plain;
        with_one.insert(structure);
        both.insert(structure);
        all.push_back(with_one);
        SectionSet with_little = sections_for(Ask::closest);
        with_little.insert(structure);
        all.push_back(with_little);
    }
    all.push_back(both);
    return all;
}

/// Inside, crossing, apart.
constexpr std::array<double, 3> kPlaces = {0, 0.5, 3};

struct Counts {
    std::size_t answered = 0;
    std::size_t refused = 0;
};

class NeedsMatrix : public testing::Test {
protected:
    NeedsMatrix() : outer_(whole(cube_of(0, 1))), inner_(whole(cube_of(0.375, 0.25))) {}

    /// Asks everything of a bake with these sections.
    void ask_all(SectionSet sections, Counts& counts) {
        const AlignedBytes outer = only(outer_, sections), inner = only(inner_, sections);
        const CModel a(outer), b(inner);
        ask_all(a.get(), b.get(), counts);
    }
    /// Asks everything of two models of the same meshes.
    void ask_all(const cdprep_model* a, const cdprep_model* b, Counts& counts) {
        const CModel all_a(outer_), all_b(inner_);
        cdprep_model_info info{};
        ASSERT_EQ(cdprep_model_describe(a, &info, nullptr), CDPREP_OK);
        for (const double x : kPlaces) {
            const CScene scene = {a, b, x, workspace_.get()};
            const CScene expected = {all_a.get(), all_b.get(), x, workspace_.get()};
            for (const CQuestion& question : c_questions()) {
                const CAnswer answer = question.ask(scene);
                const bool is_served = (info.serves & question.needs) == question.needs;
                (is_served ? counts.answered : counts.refused) += 1;
                if (is_served) {
                    EXPECT_EQ(answer.code, CDPREP_OK) << question.name;
                    EXPECT_TRUE(answer.bytes == question.ask(expected).bytes)
                        << question.name << " at " << x;
                } else {
                    EXPECT_EQ(answer.code, CDPREP_BAD_ARGUMENT) << question.name;
                    EXPECT_EQ(answer.why, CDPREP_WHY_NOT_BAKED) << question.name;
                    EXPECT_TRUE(answer.is_unknown) << question.name;
                }
            }
        }
    }

    /// The same in C++, where a refusal stops the program: each question once with each set of
    /// needs that it lacks, for a test that dies is slow.
    void ask_all_in_cpp(SectionSet sections, Counts& counts) {
        const AlignedBytes outer = only(outer_, sections), inner = only(inner_, sections);
        const Model a = *Model::open(outer.span()), b = *Model::open(inner.span());
        const Model all_a = *Model::open(outer_.span()), all_b = *Model::open(inner_.span());
        const Ask serves = a.asks() & b.asks();
        Workspace workspace(cells());
        for (const Question& question : questions()) {
            if (!contains(serves, question.needs)) {
                const auto lacks = static_cast<std::uint32_t>(without(question.needs, serves));
                if (!refused_.insert({question.name, lacks}).second) continue;
                ++counts.refused;
                EXPECT_DEATH((void)question.ask({a, b, 0.5, workspace}),
                             "Bake the mesh again with --")
                    << question.name;
                continue;
            }
            for (const double x : kPlaces) {
                ++counts.answered;
                EXPECT_TRUE(question.ask({a, b, x, workspace}) ==
                            question.ask({all_a, all_b, x, workspace}))
                    << question.name << " at " << x;
            }
        }
    }

    AlignedBytes outer_, inner_;
    CWorkspace workspace_;
    std::set<std::pair<std::string, std::uint32_t>> refused_;
};

// The law of needs: what a file lacks is refused, and never answered differently.
TEST_F(NeedsMatrix, EveryBakeGivesTheAnswerOfAWholeOneOrRefuses) {
    const std::vector<SectionSet> all = bakes();
    EXPECT_GT(all.size(), 25u);
    Counts counts;
    for (const SectionSet sections : all) ask_all(sections, counts);
    EXPECT_GT(counts.answered, all.size() * 20) << "few questions were answered";
    EXPECT_GT(counts.refused, all.size() * 20) << "few questions were refused";
}

TEST_F(NeedsMatrix, InCppTooItAnswersOrStops) {
    Counts counts;
    for (const SectionSet sections : bakes()) ask_all_in_cpp(sections, counts);
    EXPECT_GT(counts.answered, 30 * questions().size());
    EXPECT_GT(counts.refused, questions().size());
}

/// What builds are asked for: everything, each question alone, and every two of them.
std::vector<std::uint32_t> builds() {
    std::vector<std::uint32_t> singles, all = {0};
    for (const Needs& row : needs()) {
        const auto ask = static_cast<std::uint32_t>(row.ask);
        cdprep_build_options options;
        cdprep_build_options_init(&options, sizeof options);
        options.ask = ask;
        std::size_t size = 0;
        if (cdprep_model_build_size(&options, &size, nullptr) == CDPREP_OK) singles.push_back(ask);
    }
    for (const std::uint32_t one : singles) {
        for (const std::uint32_t other : singles) {
            if (one <= other) all.push_back(one | other);
        }
    }
    return all;
}

// The same law for models that were never a file.
TEST_F(NeedsMatrix, EveryBuildGivesTheAnswerOfAWholeBakeOrRefuses) {
    const TestMesh outer = cube_of(0, 1), inner = cube_of(0.375, 0.25);
    const std::vector<std::uint32_t> all = builds();
    EXPECT_EQ(all.size(), 1u + 15u * 16u / 2u);
    Counts counts;
    for (const std::uint32_t ask : all) {
        cdprep_build_options a = build_options_of(outer), b = build_options_of(inner);
        a.ask = b.ask = ask;
        const CBuilt built_a(a, workspace_.get()), built_b(b, workspace_.get());
        cdprep_model_info info{};
        ASSERT_EQ(cdprep_model_describe(built_a.get(), &info, nullptr), CDPREP_OK);
        EXPECT_EQ(info.serves & ask, ask);
        ask_all(built_a.get(), built_b.get(), counts);
    }
    EXPECT_GT(counts.answered, all.size() * 20) << "few questions were answered";
    EXPECT_GT(counts.refused, all.size() * 20) << "few questions were refused";
}

// What was baked but not asked for at opening is refused too, with another reason.
TEST_F(NeedsMatrix, WhatWasNotAskedForAtOpeningIsRefused) {
    for (const Needs& row : needs()) {
        const auto ask = static_cast<std::uint32_t>(row.ask);
        const CModel a(outer_, ask), b(inner_, ask);
        cdprep_model_info info{};
        ASSERT_EQ(cdprep_model_describe(a.get(), &info, nullptr), CDPREP_OK);
        EXPECT_NE(info.serves & ask, 0u) << row.name;
        for (const CQuestion& question : c_questions()) {
            const CAnswer answer = question.ask({a.get(), b.get(), 0.5, workspace_.get()});
            const bool is_served = (info.serves & question.needs) == question.needs;
            EXPECT_EQ(answer.code, is_served ? CDPREP_OK : CDPREP_BAD_ARGUMENT)
                << row.name << ": " << question.name;
            EXPECT_EQ(answer.why, is_served ? 0 : CDPREP_WHY_NOT_OPENED) << question.name;
        }
    }
}

// By hand: a cube of 0.25 within one of 1. Files without components answered NO.
TEST_F(NeedsMatrix, ASolidInASolidIsFoundOrRefused) {
    for (const Ask effect : {Ask::collide, Ask::overlap, Ask::distance, Ask::contacts}) {
        SectionSet sections = sections_for(effect);
        sections.insert(kAlways);
        const AlignedBytes outer = only(outer_, sections), inner = only(inner_, sections);
        const CModel a(outer), b(inner);
        cdprep_pair pair = pair_of({a.get(), b.get(), 0, nullptr});
        pair.body = CDPREP_SOLID;
        cdprep_collision found{};
        const int code = cdprep_collide(&pair, workspace_.get(), &found, nullptr);
        if (effect == Ask::collide) {
            EXPECT_EQ(code, CDPREP_OK);
            EXPECT_EQ(found.hit, CDPREP_YES);
            EXPECT_EQ(found.containment, CDPREP_YES);
        } else {
            EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
            EXPECT_EQ(found.hit, CDPREP_UNKNOWN);
        }
    }
}

}  // namespace
}  // namespace cdprep::test
