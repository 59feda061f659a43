// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/import_arguments.h"
#include "cli/output_path.h"
#include "command_line/command_line.h"

#include <chrono>
#include <map>
#include <optional>

namespace cdprep::cli {
namespace {

constexpr int kMostSeconds = 1'000'000;

const std::map<std::string, double> kMetresPerUnit = {
    {"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"in", 0.0254}, {"ft", 0.3048}};

}  // namespace

// Qualified in full: clang-format takes a line that starts with "import" for a module import.
cdprep::import::ImportOptions ImportArguments::options(
    const std::vector<std::filesystem::path>& outputs) const {
    import::ImportOptions options;
    options.memory_bytes = memory_bytes;
    options.file_bytes = file_bytes;
    options.time = std::chrono::seconds(seconds);
    options.allow_empty = allow_empty;
    if (!unit.empty()) options.metres_per_unit = kMetresPerUnit.at(unit);
    if (!up_axis.empty()) options.up_axis = up_axis == "y" ? format::UpAxis::y : format::UpAxis::z;
    options.find_conflict = [outputs](const std::filesystem::path& file) -> std::optional<Error> {
        for (const std::filesystem::path& output : outputs) {
            if (auto error = find_replaced_input(file, output)) return error;
        }
        return std::nullopt;
    };
    return options;
}

void add_import_arguments(const Command& command, ImportArguments& arguments) {
    const char* const group = "Import";
    command
        .add_option("--unit", arguments.unit,
                    "Length unit of the mesh, instead of the one that the file states")
        .type_name("UNIT")
        .check(one_of({"mm", "cm", "m", "in", "ft"}))
        .group(group);
    command
        .add_option("--up-axis", arguments.up_axis,
                    "Axis that points up, instead of the one that the file states")
        .type_name("AXIS")
        .check(one_of({"y", "z"}))
        .group(group);
    command.add_flag("--allow-empty", arguments.allow_empty, "Accept a file without triangles")
        .group(group);
    command
        .add_option("--import-memory", arguments.memory_bytes,
                    "Memory limit of an import, such as 2GB. Default: 8GB")
        .type_name("SIZE")
        .check(size_to_petabyte())
        .group(group);
    command
        .add_option("--import-file-size", arguments.file_bytes,
                    "Size limit of an imported file, such as 4GB. Default: 16GB")
        .type_name("SIZE")
        .check(size_to_petabyte())
        .group(group);
    command
        .add_option("--import-time", arguments.seconds,
                    "Time limit of the process that imports formats other than OBJ, STL, PLY and "
                    "OFF. Default: 300")
        .type_name("SECONDS")
        .check(whole_from(1, kMostSeconds))
        .group(group);
}

}  // namespace cdprep::cli
