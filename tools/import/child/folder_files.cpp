// SPDX-License-Identifier: GPL-3.0-or-later
#include "folder_files.h"

#include <assimp/IOStream.hpp>
#include <cstring>
#include <system_error>

namespace cdprep::import {

FolderFiles::FolderFiles(const std::filesystem::path& main_file, std::uint64_t& input_bytes)
    : folder_(std::filesystem::weakly_canonical(main_file).parent_path()),
      input_bytes_(input_bytes) {}

bool FolderFiles::is_allowed(const char* name) const {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::weakly_canonical(name, error);
    if (error || !std::filesystem::is_regular_file(path, error)) return false;
    const std::filesystem::path inside = path.lexically_relative(folder_);
    return !inside.empty() && *inside.begin() != "..";
}

bool FolderFiles::Exists(const char* name) const {
    return is_allowed(name);
}

Assimp::IOStream* FolderFiles::Open(const char* name, const char* mode) {
    const bool reads = std::strchr(mode, 'r') && !std::strchr(mode, '+');
    if (!reads || !is_allowed(name)) return nullptr;
    Assimp::IOStream* const stream = DefaultIOSystem::Open(name, mode);
    if (stream) input_bytes_ += stream->FileSize();
    return stream;
}

}  // namespace cdprep::import
