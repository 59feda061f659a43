// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "cdprep/cells/find_list_damage.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"
#include "command.h"
#include "convex/contact_arrays.h"
#include "convex/find_cover_falsehood.h"
#include "core/damage_sentence.h"
#include "core/mapped_file.h"
#include "false_fact.h"
#include "hull/find_hull_falsehood.h"
#include "open_for.h"
#include "pieces/find_piece_falsehood.h"
#include "program_threads.h"
#include "report/info_report.h"

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

Exit run(const Arguments& arguments) {
    const Result<MappedFile> mapped = MappedFile::map(arguments.file);
    if (!mapped) return fail("info", mapped.error());
    const std::span<const std::byte> bytes = mapped.value().bytes();
    const std::string file = arguments.file.string();
    const Result<Model> opened = Model::open(bytes, {.name = file});
    if (!opened) return fail("info", baked_first(arguments.file, opened.error()));
    if (arguments.deep) {
        auto damage = format::find_deep_damage(bytes);
        if (!damage) damage = find_list_damage(bytes, opened.value());
        if (!damage) damage = find_hull_falsehood(bytes, opened.value());
        if (!damage) damage = convex::find_cover_falsehood(bytes, opened.value());
        if (!damage) damage = convex::find_convexity_falsehood(bytes, opened.value());
        if (!damage) damage = find_piece_falsehood(bytes, opened.value());
        if (damage) {
            return fail("info", {ErrorCode::unreadable, damage_sentence(file, *damage)});
        }
        const Threads threads(0);
        if (const auto fact = find_false_fact(opened.value(), threads.parallel_for())) {
            return fail("info", {ErrorCode::unreadable,
                                 false_fact_sentence(arguments.file.string(), *fact)});
        }
    }
    const Model& model = opened.value();
    const std::vector<format::SectionEntry> table = table_of(bytes, model.header());
    std::cout << (arguments.format == "json" ? report::info_json(file, model, table)
                                             : report::info_text(file, model, table));
    return Exit::success;
}

}  // namespace

void add_info(CLI::App& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("info", "Show what a baked file holds and promises");
    command->add_option("file", arguments->file, "A .cdp.h5 file")->required();
    command->add_flag("--deep", arguments->deep, "Prove that the content is right, not only safe");
    add_report_format(*command, arguments->format);
    command->callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
