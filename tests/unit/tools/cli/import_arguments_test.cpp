// SPDX-License-Identifier: MIT
#include "cli/import_arguments.h"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace cdprep::cli {
namespace {

TEST(ImportArguments, GiveEveryOption) {
    ImportArguments arguments;
    arguments.memory_bytes = 11;
    arguments.file_bytes = 12;
    arguments.seconds = 13;
    arguments.unit = "cm";
    arguments.up_axis = "y";
    arguments.allow_empty = true;
    const import::ImportOptions options = arguments.options();
    EXPECT_EQ(options.memory_bytes, 11U);
    EXPECT_EQ(options.file_bytes, 12U);
    EXPECT_EQ(options.time, std::chrono::seconds(13));
    EXPECT_EQ(options.metres_per_unit, 0.01);
    EXPECT_EQ(options.up_axis, format::UpAxis::y);
    EXPECT_TRUE(options.allow_empty);
}

TEST(ImportArguments, KnowEveryUnitAndAxis) {
    ImportArguments arguments;
    const std::map<std::string, double> metres = {
        {"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"in", 0.0254}, {"ft", 0.3048}};
    for (const auto& [unit, length] : metres) {
        arguments.unit = unit;
        EXPECT_EQ(arguments.options().metres_per_unit, length) << unit;
    }
    arguments.up_axis = "z";
    EXPECT_EQ(arguments.options().up_axis, format::UpAxis::z);
}

TEST(ImportArguments, KeepTheDefaultsWhereNothingWasGiven) {
    const import::ImportOptions options = ImportArguments().options();
    const import::ImportOptions defaults;
    EXPECT_EQ(options.memory_bytes, defaults.memory_bytes);
    EXPECT_EQ(options.file_bytes, defaults.file_bytes);
    EXPECT_EQ(options.time, defaults.time);
    EXPECT_FALSE(options.metres_per_unit);
    EXPECT_FALSE(options.up_axis);
    EXPECT_FALSE(options.allow_empty);
}

TEST(ImportArguments, RefuseOutputsThatTheInputRefersTo) {
    const ImportArguments arguments;
    const import::ImportOptions options = arguments.options({"", "a/report", "a/page"});
    EXPECT_FALSE(options.find_conflict("a/buffer.bin"));
    const std::optional<Error> conflict = options.find_conflict("a/./page");
    ASSERT_TRUE(conflict);
    EXPECT_EQ(conflict->code, ErrorCode::bad_argument);
    EXPECT_FALSE(arguments.options().find_conflict("a/page"));
}

}  // namespace
}  // namespace cdprep::cli
