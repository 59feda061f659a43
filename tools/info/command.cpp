// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "cdprep/advanced/find_falsehood.h"
#include "cdprep/cells/find_list_damage.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"
#include "cli/command.h"
#include "cli/open_for.h"
#include "cli/program_threads.h"
#include "command_line/command_page.h"
#include "decompose/surface/contact_arrays.h"
#include "info/false_fact.h"
#include "info/find_cover_falsehood.h"
#include "info/info_report.h"

namespace cdprep::cli {
namespace {

struct Arguments {
    std::filesystem::path file;
    std::string format = "text";
    bool deep = false;
};

std::vector<format::SectionEntry> table_of(std::span<const std::byte> file,
                                           const format::FileHeader& header) {
    std::vector<format::SectionEntry> entries(header.section_count);
    if (!entries.empty()) {
        std::memcpy(entries.data(), file.data() + format::kSectionTableOffset,
                    entries.size() * sizeof(format::SectionEntry));
    }
    return entries;
}

/// Returns a message about content that is safe to query but not right, or nothing.
std::string find_false_content(const std::string& file, const Model& model) {
    const std::span<const std::byte> bytes = model.bytes();
    auto damage = format::find_deep_damage(bytes);
    if (!damage) damage = find_list_damage(bytes, model);
    if (!damage) damage = find_hull_falsehood(bytes, model);
    if (!damage) damage = convex::find_cover_falsehood(bytes, model);
    if (!damage) damage = convex::find_convexity_falsehood(bytes, model);
    if (!damage) damage = find_piece_falsehood(bytes, model);
    if (damage) return format::damage_sentence(file, *damage);
    const Threads threads(0);
    const auto fact = find_false_fact(model, threads.parallel_for());
    return fact ? false_fact_sentence(file, *fact) : "";
}

Exit run(const Arguments& arguments) {
    const Result<Model> opened = Model::open(arguments.file);
    if (!opened) return fail("info", baked_first(arguments.file, opened.error()));
    const Model& model = opened.value();
    const std::string file = arguments.file.string();
    if (arguments.deep) {
        const std::string false_content = find_false_content(file, model);
        if (!false_content.empty()) return fail("info", {ErrorCode::unreadable, false_content});
    }
    const std::vector<format::SectionEntry> table = table_of(model.bytes(), model.header());
    std::cout << (arguments.format == "json" ? report::info_json(file, model, table)
                                             : report::info_text(file, model, table));
    return Exit::success;
}

}  // namespace

void add_info(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command = app.add_command("info", "Show the content of a baked file");
    command.set_notes("", {"cdprep info arm.cdp.h5", "cdprep info arm.cdp.h5 --deep"});
    command.add_option("file", arguments->file, "A baked file (.cdp.h5)").required();
    command
        .add_flag("--deep", arguments->deep,
                  "Prove that the content is correct; opening the file proves only that it is safe")
        .group("Report");
    add_report_format(command, arguments->format);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
