// SPDX-License-Identifier: GPL-3.0-or-later
#include "input_files.h"

#include <string_view>
#include <system_error>

#include "import/mesh_endings.h"
#include "memory_limit.h"

namespace cdprep::import {
namespace {

namespace fs = std::filesystem;

/// Returns the file name: "arm.lwo" for "C:\models\arm.lwo". Paths from other systems keep their
/// separators.
std::string_view last_part(std::string_view name) {
    const std::size_t separator = name.find_last_of("/\\");
    return separator == std::string_view::npos ? name : name.substr(separator + 1);
}

}  // namespace

InputFiles::InputFiles(const fs::path& main_file) : main_file_(fs::weakly_canonical(main_file)) {}

std::optional<fs::path> InputFiles::find(const fs::path& name) const {
    std::error_code error;
    const fs::path path = fs::weakly_canonical(name, error);
    if (error || !fs::is_regular_file(path, error)) return std::nullopt;
    const fs::path inside = path.lexically_relative(main_file_.parent_path());
    if (inside.empty() || *inside.begin() == "..") return std::nullopt;
    return path;
}

void InputFiles::note_opened(const fs::path& path, std::uint64_t size) {
    const fs::path canonical = fs::weakly_canonical(path);
    if (!counted_.insert(canonical).second) return;
    note_part(size);
    if (canonical == main_file_) return;
    opened_.insert(canonical.lexically_relative(main_file_.parent_path()).string());
}

void InputFiles::note_part(std::uint64_t size) {
    bytes_ += size;
    allow_memory_for(bytes_);
}

void InputFiles::note_missing(const std::string& name) {
    if (has_mesh_ending(name)) missing_.push_back(name);
}

std::string InputFiles::missing_meshes() const {
    std::set<std::string_view> read = {last_part(main_file_.native())};
    for (const std::string& name : opened_) read.insert(last_part(name));
    std::string names;
    for (const std::string& name : missing_) {
        if (!read.insert(last_part(name)).second) continue;
        names += (names.empty() ? "" : ", ") + std::string(last_part(name));
    }
    return names;
}

}  // namespace cdprep::import
