// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/import_arguments.h"
#include "cli/usage.h"

#include <chrono>
#include <map>

namespace cdprep::cli {
namespace {

constexpr int kMostSeconds = 1'000'000;

const std::map<std::string, double> kMetresPerUnit = {
    {"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"in", 0.0254}, {"ft", 0.3048}};

}  // namespace

// Spelled out: clang-format takes a line that starts with "import" for a module's.
cdprep::import::ImportOptions ImportArguments::options() const {
    import::ImportOptions options;
    options.memory_bytes = memory_bytes;
    options.file_bytes = file_bytes;
    options.time = std::chrono::seconds(seconds);
    options.allow_empty = allow_empty;
    if (!unit.empty()) options.metres_per_unit = kMetresPerUnit.at(unit);
    if (!up_axis.empty()) options.up_axis = up_axis == "y" ? format::UpAxis::y : format::UpAxis::z;
    return options;
}

void add_import_arguments(CLI::App& command, ImportArguments& arguments) {
    command
        .add_option("--unit", arguments.unit,
                    "Unit of the mesh: mm, cm, m, in or ft. Default: what the file says")
        ->check(one_of({"mm", "cm", "m", "in", "ft"}));
    command
        .add_option("--up-axis", arguments.up_axis,
                    "Axis that points up: y or z. Default: what the file says")
        ->check(one_of({"y", "z"}));
    command.add_flag("--allow-empty", arguments.allow_empty, "Accept files without a triangle");
    command
        .add_option("--import-memory", arguments.memory_bytes,
                    "Most memory an import may use, such as 2GB")
        ->transform(size_to_petabyte());
    command
        .add_option("--import-file-size", arguments.file_bytes,
                    "Largest file to import, such as 4GB")
        ->transform(size_to_petabyte());
    command.add_option("--import-time", arguments.seconds, "Most seconds an import may take")
        ->check(whole_from(1, kMostSeconds));
}

}  // namespace cdprep::cli
