// SPDX-License-Identifier: MIT
#include "command_line/command_page.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cdprep::cli {
namespace {

using Lines = std::vector<std::string>;

CommandPage page_with(const std::string& notes, const Lines& examples) {
    const Program program("p", "1", "A program");
    program.root().set_notes(notes, examples);
    return page_of(program.root(), "p");
}

// By definition: what set_notes() was given.
TEST(CommandPage, HasTheNotesAndTheExamples) {
    for (const char* notes : {"", "One line.", "A paragraph.\n\nAnother one."}) {
        for (const Lines& examples : {Lines{}, Lines{"p a"}, Lines{"p a", "p b -o c"}}) {
            const CommandPage page = page_with(notes, examples);
            EXPECT_EQ(page.notes, notes);
            EXPECT_EQ(page.examples, examples);
        }
    }
}

TEST(CommandPage, NotesMayHoldTheWordThatTitlesTheExamples) {
    for (const char* notes : {"Examples: none here.", "See Examples: below.\n\nMore.",
                              "First.\n\nExamples: of words.\n\nLast.", "First.\nExamples:"}) {
        for (const Lines& examples : {Lines{}, Lines{"p Examples:", "p b"}}) {
            const CommandPage page = page_with(notes, examples);
            EXPECT_EQ(page.notes, notes);
            EXPECT_EQ(page.examples, examples);
        }
    }
}

TEST(CommandPage, ShowsTheWordsOfAChoiceAndOfAList) {
    std::string shape, steps;
    const Program program("p", "1", "A program");
    program.root().add_option("--shape", shape, "A shape").check(one_of({"box", "hull"}));
    program.root().add_option("--steps", steps, "Steps").check(list_of({"weld", "orient"}));
    const CommandPage page = page_of(program.root(), "p");
    const auto entry = [&](const std::string& name) {
        for (const OptionGroup& group : page.groups) {
            for (const OptionEntry& option : group.options) {
                if (option.names.front() == name) return option;
            }
        }
        ADD_FAILURE() << name;
        return OptionEntry{};
    };
    EXPECT_EQ(entry("--shape").words, (Lines{"box", "hull"}));
    EXPECT_FALSE(entry("--shape").is_list);
    EXPECT_EQ(full_text(entry("--shape")), "A shape. [box or hull]");
    EXPECT_EQ(entry("--steps").words, (Lines{"weld", "orient"}));
    EXPECT_TRUE(entry("--steps").is_list);
    EXPECT_EQ(full_text(entry("--steps")), "Steps. [a list of weld, orient]");
}

}  // namespace
}  // namespace cdprep::cli
