// SPDX-License-Identifier: MIT
#include "export/engine.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "support/scratch_folder.h"

namespace cdprep::cli {
namespace {

const EngineForm& form_of(const char* name) {
    const EngineForm* form = find_engine(name);
    EXPECT_NE(form, nullptr) << name;
    return *form;
}

TEST(Engine, EachNameHasAForm) {
    std::set<std::string> names;
    for (const std::string& name : engine_names()) {
        EXPECT_TRUE(names.insert(name).second);
        EXPECT_EQ(form_of(name.c_str()).name, name);
    }
    EXPECT_EQ(names, (std::set<std::string>{"gazebo", "godot", "json", "mujoco", "unity", "unreal",
                                            "urdf"}));
    EXPECT_EQ(find_engine("Godot"), nullptr);
}

// Numbers have as many digits as the last: names of parts sort as their numbers.
TEST(Engine, PartsHaveTheNamesThatEnginesKnow) {
    EXPECT_EQ(part_name(form_of("unreal"), "bolt", 0, 3), "UCX_bolt_00");
    EXPECT_EQ(part_name(form_of("unreal"), "bolt", 7, 101), "UCX_bolt_007");
    EXPECT_EQ(part_name(form_of("godot"), "bolt", 99, 100), "bolt_99-convcolonly");
    EXPECT_EQ(part_name(form_of("unity"), "bolt", 1, 3), "bolt_01");
    EXPECT_EQ(part_name(form_of("mujoco"), "bolt", 1, 3), "bolt_01");
    EXPECT_EQ(part_name(form_of("json"), "bolt", 1, 3), "bolt_01");
    EXPECT_EQ(part_name(form_of("urdf"), "bolt", 1, 3), "collider_01");
    EXPECT_EQ(part_name(form_of("gazebo"), "bolt", 1, 3), "collider_01");
}

TEST(Engine, OutputsHaveTheNameOfTheInput) {
    const test::ScratchFolder folder;
    const auto input = folder.write("bolt.v2.cdp.h5", std::string_view("x"));
    for (const auto& [name, output] :
         {std::pair("godot", "bolt.v2.glb"), std::pair("mujoco", "bolt.v2.xml"),
          std::pair("gazebo", "bolt.v2.sdf"), std::pair("urdf", "bolt.v2.urdf"),
          std::pair("json", "bolt.v2.json")}) {
        EXPECT_EQ(output_for(form_of(name), input, {}).value(), folder.path() / output);
        EXPECT_EQ(output_for(form_of(name), input, folder.path()).value(), folder.path() / output);
        EXPECT_EQ(exported_name(input, folder.path() / output), "bolt.v2");
    }
    EXPECT_EQ(output_for(form_of("mujoco"), input, "a b.MJCF").value(), "a b.MJCF");
    EXPECT_EQ(exported_name(input, "a b.MJCF"), "a_b");
    EXPECT_EQ(output_for(form_of("json"), input, "-").value(), "-");
    EXPECT_EQ(exported_name(input, "-"), "bolt.v2");
}

void expect_refused(const Result<std::filesystem::path>& output, const char* word) {
    ASSERT_FALSE(output.ok());
    EXPECT_EQ(output.error().code, ErrorCode::bad_argument);
    EXPECT_NE(output.error().message.find(word), std::string::npos) << output.error().message;
}

// A GLB beside a baked file may be its source.
TEST(Engine, NoOutputReplacesWhatNoArgumentNames) {
    const test::ScratchFolder folder;
    const auto input = folder.write("bolt.cdp.h5", std::string_view("x"));
    const auto source = folder.write("bolt.glb", std::string_view("source"));
    expect_refused(output_for(form_of("unity"), input, {}), "bolt.glb");
    expect_refused(output_for(form_of("unity"), input, folder.path()), "bolt.glb");
    EXPECT_EQ(output_for(form_of("unity"), input, source).value(), source);
    std::filesystem::create_directory(folder.path() / "game");
    const auto again = folder.write("game/bolt.glb", std::string_view("of the last build"));
    EXPECT_EQ(output_for(form_of("unity"), input, folder.path() / "game").value(), again);
}

TEST(Engine, OutputsEndAsTheEngineReads) {
    const test::ScratchFolder folder;
    const auto input = folder.write("bolt.cdp.h5", std::string_view("x"));
    expect_refused(output_for(form_of("unity"), input, "bolt.fbx"), ".glb");
    expect_refused(output_for(form_of("mujoco"), input, "bolt.urdf"), ".xml or .mjcf");
    expect_refused(output_for(form_of("unity"), input, "-"), ".glb");
    expect_refused(output_for(form_of("json"), input, input), "is an input");
}

}  // namespace
}  // namespace cdprep::cli
