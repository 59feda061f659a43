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

}  // namespace
}  // namespace cdprep::cli
