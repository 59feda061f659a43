// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "command_line/command_line.h"

namespace cdprep::cli {
namespace {

/// Returns the number that an option with whole_from(1, 100) reads, or nothing if it refuses.
std::optional<std::uint32_t> whole(const char* word) {
    std::uint32_t number = 7;
    const Program program("p", "1", "A program");
    program.root()
        .add_command("run", "Run")
        .add_option("--number", number, "A number")
        .check(whole_from(1, 100));
    const std::array<const char*, 4> arguments = {"p", "run", "--number", word};
    testing::internal::CaptureStderr();
    const auto exit = program.parse(arguments.size(), arguments.data());
    const std::string message = testing::internal::GetCapturedStderr();
    if (!exit) return number;
    EXPECT_EQ(*exit, Exit::usage);
    EXPECT_NE(message.find("--number"), std::string::npos) << message;
    return std::nullopt;
}

// C reads "010" as eight.
TEST(WholeFrom, ReadsDecimalDigitsOnly) {
    EXPECT_EQ(whole("10"), 10U);
    EXPECT_EQ(whole("010"), 10U);
    EXPECT_EQ(whole("0099"), 99U);
    for (const char* word : {"0x10", "+5", " 5", "5 ", "5.0", "1e1", "101", "0", "-1", "",
                             "99999999999999999999999"}) {
        EXPECT_EQ(whole(word), std::nullopt) << word;
    }
}

// A script that forgot to set a variable gives an empty word.
TEST(Options, RefuseAnEmptyValue) {
    std::string text;
    std::filesystem::path path;
    double number = 1;
    const Program program("p", "1", "A program");
    const Command command = program.root().add_command("run", "Run");
    command.add_option("--text", text, "A text");
    command.add_option("--path", path, "A path");
    command.add_option("--number", number, "A number");
    command.add_option("input", path, "An input");
    const auto exit_of = [&](std::vector<const char*> arguments) {
        arguments.insert(arguments.begin(), {"p", "run"});
        testing::internal::CaptureStderr();
        const auto exit = program.parse(static_cast<int>(arguments.size()), arguments.data());
        const std::string message = testing::internal::GetCapturedStderr();
        EXPECT_EQ(exit.has_value(), message.find("the value is empty.") != std::string::npos)
            << message;
        return exit;
    };
    for (const char* option : {"--text", "--path", "--number"}) {
        EXPECT_EQ(exit_of({option, ""}), Exit::usage) << option;
        EXPECT_EQ(exit_of({option, "1"}), std::nullopt) << option;
    }
    EXPECT_EQ(exit_of({""}), Exit::usage);
}

}  // namespace
}  // namespace cdprep::cli
