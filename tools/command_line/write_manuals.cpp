// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/write_manuals.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "command_line/exit_codes.h"

namespace cdprep::cli {
namespace {

/// Returns the escaped text of a table cell: a bar would end it, a star might begin emphasis.
std::string cell(const std::string& text) {
    std::string out;
    for (const char letter : text) {
        if (letter == '|' || letter == '*' || letter == '<') out += '\\';
        out += letter;
    }
    return out;
}

std::string code(const OptionEntry& option) {
    std::string text;
    for (const std::string& name : option.names) text += (text.empty() ? "`" : ", `") + name + "`";
    const bool is_option = option.names.front().starts_with('-');
    return is_option && !option.value.empty() ? text + " " + option.value : text;
}

std::string table(const std::string& title, const std::vector<OptionEntry>& options) {
    if (options.empty()) return "";
    std::string text = "\n| " + title + " | |\n| --- | --- |\n";
    for (const OptionEntry& option : options) {
        text += "| " + code(option) + " | " + cell(full_text(option)) + " |\n";
    }
    return text;
}

}  // namespace

std::string command_tables(const std::vector<CommandPage>& pages) {
    std::string text =
        "# Commands\n\n"
        "Generated from the options of the program: `cdprep --write-manuals FOLDER`.\n\n"
        "| exit code | meaning |\n| --- | --- |\n";
    for (const ExitText& each : kExitTexts) {
        text += "| " + std::to_string(static_cast<int>(each.code)) + " | " + each.text + " |\n";
    }
    for (const CommandPage& page : pages) {
        text +=
            "\n## " + page.name + "\n\n" + page.summary + ".\n\n```\n" + page.usage() + "\n```\n";
        if (!page.commands.empty()) {
            text += "\n| Command | |\n| --- | --- |\n";
            for (const auto& [name, summary] : page.commands) {
                text += "| `" + name + "` | " + cell(summary) + ". |\n";
            }
        }
        text += table("Input", page.inputs);
        for (const OptionGroup& group : page.groups) text += table(group.title, group.options);
        if (!page.notes.empty()) text += "\n" + page.notes + "\n";
        if (!page.examples.empty()) {
            text += "\n```\n";
            for (const std::string& example : page.examples) text += example + "\n";
            text += "```\n";
        }
    }
    return text;
}

std::optional<Error> write_manuals(const std::filesystem::path& folder,
                                   const std::vector<CommandPage>& pages,
                                   const std::string& version) {
    std::error_code failed;
    std::filesystem::create_directories(folder / "man", failed);
    if (!failed) std::filesystem::create_directories(folder / "completion", failed);
    bool is_written = !failed;
    const auto write = [&](const std::filesystem::path& name, const std::string& text) {
        std::ofstream file(folder / name, std::ios::binary);
        is_written = is_written && (file << text).flush();
    };
    for (const CommandPage& page : pages) {
        std::string name = page.name;
        std::ranges::replace(name, ' ', '-');
        write("man/" + name + ".1", man_page(page, version));
    }
    write("completion/cdprep.bash", bash_completion(pages));
    write("completion/_cdprep", zsh_completion(pages));
    write("completion/cdprep.fish", fish_completion(pages));
    write("COMMANDS.md", command_tables(pages));
    if (is_written) return std::nullopt;
    return Error{ErrorCode::unwritable,
                 folder.string() + ": the manuals cannot be written. Choose another folder."};
}

}  // namespace cdprep::cli
