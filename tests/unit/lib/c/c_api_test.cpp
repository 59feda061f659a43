// SPDX-License-Identifier: MIT
#include "c_api.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "cdprep/cdprep.h"
#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "support/c_lanes.h"
#include "support/c_models.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/run_threads.h"
#include "support/scratch_folder.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

AlignedBytes baked_cube() {
    const TestMesh cube = unit_cube();
    return bake_tiny(cube.positions, cube.triangles);
}

/// Asks everything that needs no more than a plain bake.
void ask_all(const cdprep_model* cube) {
    const CWorkspace workspace;
    for (const char* wrong : {ask_pairs(cube, workspace.get()), ask_points(cube, workspace.get()),
                              read_geometry(cube)}) {
        EXPECT_EQ(wrong, nullptr) << wrong;
    }
}

// By hand: cubes of side 1, moved along x.
TEST(CApi, AProgramInC99GetsTheAnswers) {
    const AlignedBytes file = baked_cube();
    ask_all(CModel(file).get());
}

// The same cube as above, however it gets into memory.
TEST(CApi, EveryModeOfOpeningGivesTheSameAnswers) {
    const AlignedBytes file = baked_cube();
    const ScratchFolder folder;
    const std::string path = (folder.path() / "cube.cdp.h5").string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(file.span().data()),
               static_cast<std::streamsize>(file.size()));
    for (const std::uint32_t mode : {CDPREP_MAP, CDPREP_COPY, CDPREP_MAP_TRUSTED}) {
        cdprep_open_options options;
        cdprep_open_options_init(&options, sizeof options);
        options.mode = mode;
        cdprep_model* model = nullptr;
        cdprep_error error;
        ASSERT_EQ(cdprep_model_open(path.c_str(), &options, &model, &error), CDPREP_OK)
            << error.message;
        ask_all(model);
        cdprep_model_close(model);
    }
}

// The C API takes names in UTF-8 everywhere, also where the system has wide ones.
TEST(CApi, OpensAFileBeyondAsciiInEveryMode) {
    const ScratchFolder folder;
    const std::u8string name = u8"W\u00fcrfel \u7acb \U0001f4e6.cdp.h5";
    const std::filesystem::path path = folder.path() / name;
    std::filesystem::rename(folder.write("cube", baked_cube().span()), path);
    const std::u8string whole = path.u8string();
    const std::string text(whole.begin(), whole.end()), missing = text + ".none";
    const std::string named(name.begin(), name.end());
    for (const std::uint32_t mode : {CDPREP_MAP, CDPREP_COPY, CDPREP_MAP_TRUSTED}) {
        cdprep_open_options options;
        cdprep_open_options_init(&options, sizeof options);
        options.mode = mode;
        cdprep_model* model = nullptr;
        cdprep_error error;
        ASSERT_EQ(cdprep_model_open(text.c_str(), &options, &model, &error), CDPREP_OK)
            << error.message;
        cdprep_model_close(model);
        EXPECT_EQ(cdprep_model_open(missing.c_str(), &options, &model, &error), CDPREP_UNREADABLE);
        EXPECT_NE(std::string(error.message).find(named), std::string::npos) << error.message;
    }
}

// The same cube as above, never a file. Floats, as tiny bakes have them.
TEST(CApi, ABuiltCubeIsAskedLikeABakedOne) {
    const TestMesh cube = unit_cube();
    std::vector<float> floats;
    for (const Double3& p : cube.positions) {
        for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(x));
    }
    cdprep_build_options options = build_options_of(cube);
    options.precision = CDPREP_SINGLE;
    const CWorkspace workspace;
    ask_all(CBuilt(options, workspace.get()).get());
    options.precision = CDPREP_AS_GIVEN;
    options.positions = nullptr;
    options.positions_f32 = floats.data();
    ask_all(CBuilt(options, workspace.get()).get());
}

// A copy does not depend on what becomes of the bytes, nor on where they begin.
TEST(CApi, ACopyOutlivesItsBytes) {
    const AlignedBytes file = baked_cube();
    std::vector<std::byte> bytes(file.size() + 1);
    std::memcpy(bytes.data() + 1, file.span().data(), file.size());
    cdprep_open_options options;
    cdprep_open_options_init(&options, sizeof options);
    options.mode = CDPREP_COPY;
    cdprep_model* model = nullptr;
    ASSERT_EQ(cdprep_model_open_memory(bytes.data() + 1, file.size(), &options, &model, nullptr),
              CDPREP_OK);
    std::fill(bytes.begin(), bytes.end(), std::byte{0xff});
    ask_all(model);
    cdprep_model_close(model);
}

// Written by hand: what C reads must be what was stored.
TEST(CApi, ReadsWhatWasFoundWhenAModelWasBaked) {
    const format::Verdict stored{
        format::verdict_closed, format::promise_simple_solid, 2, 0, 3, -4, 5, 0, 6.5, 7.5};
    const std::array<std::uint32_t, 2> from = {7, format::kMadeByRepair};
    format::FileHeader facts{};
    facts.triangle_count = 2;
    const AlignedBytes file = assemble(
        facts, {as_section(SectionId::verdicts, std::span<const format::Verdict>(&stored, 1)),
                as_section(SectionId::repaired_from, std::span<const std::uint32_t>(from))});
    const CModel model(file);
    cdprep_model_info info{};
    ASSERT_EQ(cdprep_model_describe(model.get(), &info, nullptr), CDPREP_OK);
    EXPECT_EQ(info.verdicts, 1u);
    cdprep_verdict read{};
    cdprep_error error{};
    EXPECT_EQ(cdprep_model_verdict(model.get(), 1, &read, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error.why, CDPREP_WHY_OUT_OF_RANGE);
    ASSERT_EQ(cdprep_model_verdict(model.get(), 0, &read, nullptr), CDPREP_OK);
    EXPECT_EQ(read.promises, static_cast<std::uint32_t>(CDPREP_PROMISE_SIMPLE_SOLID));
    EXPECT_EQ(read.euler, -4);
    EXPECT_EQ(read.volume, 7.5);
    cdprep_array array{};
    constexpr auto kRepairedFrom = static_cast<std::uint32_t>(SectionId::repaired_from);
    ASSERT_EQ(cdprep_model_section(model.get(), kRepairedFrom, &array, nullptr), CDPREP_OK);
    ASSERT_EQ(array.count, 2u);
    EXPECT_EQ(static_cast<const std::uint32_t*>(array.data)[1], UINT32_MAX);
}

// Written by hand: two nodes, three groups, one material, and no more.
TEST(CApi, ReadsNamesAndTextsThatThereAre) {
    std::array<format::Instance, 2> nodes{};
    nodes[0].name = 1;
    nodes[0].triangle_count = nodes[1].triangle_count = nodes[1].first_triangle = 1;
    const auto as_names = [](SectionId id, const std::string& names) {
        return as_section(id, std::span<const char>(names));
    };
    const std::string provenance = R"({"source":"arm"})", findings = "{}";
    const std::string node_names("arm\0leg\0", 8), groups("a\0\0c\0", 5), material("oak\0", 4);
    format::FileHeader facts{};
    facts.triangle_count = 2;
    const AlignedBytes file = assemble(
        facts,
        {as_section(SectionId::instances, std::span<const format::Instance>(nodes)),
         as_names(SectionId::instance_names, node_names), as_names(SectionId::group_names, groups),
         as_names(SectionId::material_names, material), as_names(SectionId::provenance, provenance),
         as_names(SectionId::findings, findings)});
    const CModel model(file);
    const auto text = [&](std::uint32_t kind, std::uint32_t number) -> std::string {
        const char* begin = nullptr;
        std::size_t length = 0;
        cdprep_error error{};
        if (cdprep_model_text(model.get(), kind, number, &begin, &length, &error) == CDPREP_OK) {
            return {begin, length};
        }
        return "refused";
    };
    using Texts = std::vector<std::string>;
    const auto first_four = [&](std::uint32_t kind) {
        return Texts{text(kind, 0), text(kind, 1), text(kind, 2), text(kind, 3)};
    };
    EXPECT_EQ(first_four(CDPREP_INSTANCE_NAME), (Texts{"leg", "arm", "refused", "refused"}));
    EXPECT_EQ(first_four(CDPREP_GROUP_NAME), (Texts{"a", "", "c", "refused"}));
    EXPECT_EQ(first_four(CDPREP_MATERIAL_NAME), (Texts{"oak", "refused", "refused", "refused"}));
    EXPECT_EQ(first_four(CDPREP_PROVENANCE), (Texts{provenance, "refused", "refused", "refused"}));
    EXPECT_EQ(first_four(CDPREP_FINDINGS), (Texts{findings, "refused", "refused", "refused"}));
    EXPECT_EQ(text(CDPREP_MATERIAL_NAME + 1, 0), "refused");
}

/// A thread for every task, as a C program has them; counts the tasks.
void run_on_threads(void* tasks, std::size_t count, cdprep_task task, const void* work) {
    *static_cast<std::size_t*>(tasks) += count;
    run_threads(count, [&](std::size_t i) { task(work, i); });
}

// The law of batches: what is asked at once is answered as one by one.
TEST(CApi, ManyLanesGetTheAnswersOfOne) {
    const TestMesh ball = icosphere(4), ring = torus(0.3, 0.1, 120, 60);
    const AlignedBytes a = bake_tiny(ball.positions, ball.triangles);
    const AlignedBytes b = bake_tiny(ring.positions, ring.triangles);
    std::size_t tasks = 0;
    cdprep_workspace_options options;
    cdprep_workspace_options_init(&options, sizeof options);
    options.run = run_on_threads;
    options.context = &tasks;
    const char* wrong = ask_many(CModel(a).get(), CModel(b).get(), &options);
    EXPECT_EQ(wrong, nullptr) << wrong;
    EXPECT_GT(tasks, 8u * 7u);
}

// The same law, whatever the caller's threads do.
TEST(CApi, TasksThatAreLeftOutOrRepeatedChangeNothing) {
    const TestMesh ball = icosphere(4), ring = torus(0.3, 0.1, 120, 60);
    const AlignedBytes a = bake_tiny(ball.positions, ball.triangles);
    const AlignedBytes b = bake_tiny(ring.positions, ring.triangles);
    cdprep_workspace_options options;
    cdprep_workspace_options_init(&options, sizeof options);
    options.run = run_badly;
    const char* wrong = ask_many(CModel(a).get(), CModel(b).get(), &options);
    EXPECT_EQ(wrong, nullptr) << wrong;
}

// By hand: cubes of side 1.
TEST(CApi, HullsOfACubeAreAsFarApartAsItIsMoved) {
    const AlignedBytes file = with_hulls(baked_cube());
    const char* wrong = ask_hulls(CModel(file).get());
    EXPECT_EQ(wrong, nullptr) << wrong;
}

// By hand: faces, edges and corners of cubes of side 1.
TEST(CApi, ContactsOfCubesAreWhereTheyAreMoved) {
    const AlignedBytes file = with_contacts(with_one_piece(baked_cube()));
    const CWorkspace workspace;
    const char* wrong = ask_contacts(CModel(file).get(), workspace.get());
    EXPECT_EQ(wrong, nullptr) << wrong;
}

// By hand: a cube in one of edge 4, 1.5 from the nearest way out, with surfaces far apart.
TEST(CApi, ACubeInASolidCubeIsPushedOut) {
    const auto baked = [](const TestMesh& mesh) {
        return with_contacts(
            with_one_piece(bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true})));
    };
    const AlignedBytes small_file = baked(unit_cube());
    const AlignedBytes large_file = baked(moved_by(unit_cube(), 4, {0, 0, 0}));
    const CModel small(small_file), large(large_file);
    const CWorkspace workspace;
    cdprep_pair pair;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = large.get();
    pair.b = small.get();
    pair.pose_b.rows[9] = 2.5;
    pair.pose_b.rows[10] = pair.pose_b.rows[11] = 1.5;
    cdprep_contact contact;
    cdprep_contact_list list = {&contact, 1, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(cdprep_contacts(&pair, nullptr, workspace.get(), &list, nullptr), CDPREP_OK);
    EXPECT_EQ(list.count, 0u);
    pair.body = CDPREP_SOLID;
    EXPECT_EQ(cdprep_contacts(&pair, nullptr, workspace.get(), &list, nullptr), CDPREP_OK);
    ASSERT_EQ(list.count, 1u);
    EXPECT_EQ(contact.flags,
              static_cast<std::uint32_t>(CDPREP_CONTACT_OVERLAP | CDPREP_CONTACT_DEEP));
    EXPECT_NEAR(contact.normal[0], 1, 1e-12);
    EXPECT_NEAR(contact.lower, -1.5, 1e-12);
    EXPECT_EQ(contact.id >> 32, CDPREP_NONE);
}

TEST(CApi, ListsOfContactsTellWhatALimitLeftOut) {
    const AlignedBytes file = with_contacts(with_one_piece(baked_cube()));
    const CModel cube(file);
    const Model same = Model::open(file.span()).value();
    const CWorkspace workspace;
    Workspace own;
    cdprep_pair pair;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = pair.b = cube.get();
    pair.pose_b.rows[9] = 0.5;
    const Placement half =
        Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, {0.5, 0, 0}).value());
    unsigned unsearched = 0;
    for (const std::uint64_t work : {0U, 1U, 40U, 1000U}) {
        cdprep_contact_options options;
        cdprep_contact_options_init(&options, sizeof options);
        options.work = work;
        std::array<cdprep_contact, 4> contacts;
        cdprep_contact_list list = {contacts.data(), contacts.size(), 0, 0, 0, 0, 0, 0};
        EXPECT_EQ(cdprep_contacts(&pair, &options, workspace.get(), &list, nullptr), CDPREP_OK);
        std::array<Contact, 4> room;
        const ContactsVerdict verdict =
            cdprep::contacts({same, same, half}, own, room, {.most = options.most, .work = work});
        EXPECT_EQ(list.count, verdict.count) << work;
        EXPECT_EQ(list.found, verdict.found) << work;
        EXPECT_EQ(list.computed, verdict.computed) << work;
        EXPECT_EQ(list.work, verdict.work) << work;
        EXPECT_EQ(list.complete == CDPREP_YES, verdict.complete) << work;
        EXPECT_EQ(list.searched == CDPREP_YES, verdict.searched) << work;
        unsearched += verdict.searched ? 0U : 1U;
    }
    EXPECT_GE(unsearched, 1U);
    EXPECT_LE(unsearched, 2U);
}

TEST(Workspace, MayLiveInTheCallersMemory) {
    const TestMesh cube = unit_cube();
    const AlignedBytes file = bake_tiny(cube.positions, cube.triangles);
    const auto model = Model::open(file.span());
    ASSERT_TRUE(model);
    AlignedBytes memory(Workspace::size());
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(memory.span().data()) % Workspace::alignment(), 0u);
    EXPECT_FALSE(Workspace::in_memory(memory.span().first(Workspace::size() - 1)));
    EXPECT_FALSE(Workspace::in_memory(memory.span().subspan(1)));
    auto workspace = Workspace::in_memory(memory.span());
    ASSERT_TRUE(workspace);
    const Placement still = Placement::b_moves(Pose());
    EXPECT_TRUE(collide({model.value(), model.value(), still}, *workspace).hit == Answer::yes);
}

}  // namespace
}  // namespace cdprep::test
