// SPDX-License-Identifier: MIT
#include "command_line/command_line.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace cdprep::cli {
namespace {

/// A program with one command that has an option of each kind.
class EmptyValue : public ::testing::Test {
protected:
    EmptyValue() {
        const Command command = program_.root().add_command("make", "Make a thing");
        command.add_option("input", inputs_, "The inputs");
        command.add_option("-o,--output", output_, "The output");
        command.add_flag("--strict", strict_, "Be strict");
        command.callback([this] { is_run_ = true; });
        program_.add_hidden("--hidden", [this](const std::string&) {
            is_run_ = true;
            return Exit::success;
        });
    }

    /// Returns the message about the command line; "" if it is valid.
    std::string message(std::vector<const char*> arguments) {
        arguments.insert(arguments.begin(), "p");
        testing::internal::CaptureStderr();
        exit_ = program_.parse(static_cast<int>(arguments.size()), arguments.data());
        return testing::internal::GetCapturedStderr();
    }

    Program program_{"p", "1", "A program"};
    std::vector<std::string> inputs_;
    std::string output_;
    bool strict_ = false;
    bool is_run_ = false;
    std::optional<Exit> exit_;
};

// The next argument could be a file: the output would replace it.
TEST_F(EmptyValue, IsRefusedAfterAnEqualsSignAsAfterASpace) {
    for (const std::vector<const char*>& arguments :
         {std::vector<const char*>{"make", "--output=", "a", "b"},
          {"make", "--output", "", "a", "b"},
          {"make", "a", "--output="}}) {
        EXPECT_EQ(message(arguments), "p make: --output: the value is empty.\n");
        EXPECT_EQ(exit_, Exit::usage);
    }
    EXPECT_EQ(message({"make", "-o=", "a"}), "p make: -o: the value is empty.\n");
    EXPECT_EQ(message({"make", "--strict=", "a"}), "p make: --strict: the value is empty.\n");
    EXPECT_FALSE(is_run_);
}

TEST_F(EmptyValue, IsRefusedForOptionsOfTheProgram) {
    EXPECT_EQ(message({"--config", "", "make"}), "p make: --config: the value is empty.\n");
    EXPECT_EQ(message({"--config=", "make"}), "p: --config: the value is empty.\n");
    EXPECT_NE(message({"--hidden", ""}), "");
    EXPECT_EQ(exit_, Exit::usage);
    EXPECT_FALSE(is_run_);
}

TEST_F(EmptyValue, IsNoInputWithAnEqualsSign) {
    EXPECT_EQ(message({"make", "--output=x=", "--", "--b=", "a="}), "");
    EXPECT_EQ(output_, "x=");
    EXPECT_EQ(inputs_, (std::vector<std::string>{"--b=", "a="}));
    EXPECT_TRUE(is_run_);
}

}  // namespace
}  // namespace cdprep::cli
