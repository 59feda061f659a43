// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/output_path.h"

#include <sys/stat.h>

#include <cstdio>
#include <iostream>
#include <system_error>

#include "command_line/command_line.h"
#include "write/output_file.h"

namespace cdprep::cli {

std::filesystem::path without_links(const std::filesystem::path& path) {
    std::error_code unknown;
    const std::filesystem::path whole = std::filesystem::absolute(path, unknown);
    if (unknown) return path;
    const std::filesystem::path file = std::filesystem::weakly_canonical(whole, unknown);
    return unknown ? whole.lexically_normal() : file;
}

std::filesystem::path named_file(const std::filesystem::path& path) {
    return without_links(write::followed(path));
}

std::filesystem::path shortened(const std::filesystem::path& path) {
    const std::filesystem::path normal = path.lexically_normal();
    std::error_code failure;
    const bool is_same = std::filesystem::equivalent(path, normal, failure);
    // Where neither exists, either may be named.
    const bool are_missing = failure && !std::filesystem::exists(path, failure) &&
                             !std::filesystem::exists(normal, failure);
    return is_same || are_missing ? normal : path;
}

UsedFiles::UsedFiles() {
    add_input(settings_file());
}

bool UsedFiles::add(const std::filesystem::path& path) {
    struct stat known = {};
    const bool is_there = ::stat(path.c_str(), &known) == 0;
    const bool is_new_name = names_.insert(named_file(path)).second;
    return (!is_there || files_.emplace(known.st_dev, known.st_ino).second) && is_new_name;
}

void UsedFiles::add_input(const std::filesystem::path& path) {
    if (!path.empty()) add(path);
}

Result<Done> UsedFiles::add_output(const std::filesystem::path& path) {
    if (path.empty() || add(path)) return Done{};
    return Error{ErrorCode::bad_argument,
                 path.string() +
                     " is an input or another output, and would be replaced. Choose another name."};
}

std::optional<Error> find_replaced_input(const std::filesystem::path& input,
                                         const std::filesystem::path& output) {
    UsedFiles used;
    used.add_input(input);
    const Result<Done> added = used.add_output(output);
    return added ? std::nullopt : std::optional(added.error());
}

Result<write::MeshFormat> mesh_output(const std::filesystem::path& input,
                                      const std::filesystem::path& output) {
    if (const auto error = find_replaced_input(input, output)) return *error;
    if (output == "-") return write::MeshFormat::obj;
    if (const auto format = write::mesh_format_of(output)) return *format;
    return Error{ErrorCode::bad_argument,
                 output.string() + ": a mesh can be written as .obj, .ply, .stl or .off only."};
}

Result<Done> write_mesh(const std::filesystem::path& output, write::MeshFormat format,
                        const write::MeshArrays& mesh) {
    if (output != "-") return write::write_mesh_file(output, format, mesh);
    return write_bytes(output, write::bytes_of(format, mesh));
}

Result<Done> write_bytes(const std::filesystem::path& output, std::string_view bytes) {
    if (output != "-") return write::write_whole(output, bytes);
    // Not through std::cout, which --quiet redirects.
    const bool is_whole = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    if (is_whole && std::fflush(stdout) == 0) return Done{};
    return Error{ErrorCode::unwritable,
                 "standard output cannot be written; the result is incomplete."};
}

std::ostream& report_stream(const std::filesystem::path& output) {
    return output == "-" ? std::cerr : std::cout;
}

}  // namespace cdprep::cli
