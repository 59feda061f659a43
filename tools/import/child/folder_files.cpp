// SPDX-License-Identifier: GPL-3.0-or-later
#include "folder_files.h"

#include <assimp/IOStream.hpp>
#include <cstring>

namespace cdprep::import {

bool FolderFiles::Exists(const char* name) const {
    if (files_.find(name)) return true;
    files_.note_missing(name);
    return false;
}

Assimp::IOStream* FolderFiles::Open(const char* name, const char* mode) {
    const bool reads = std::strchr(mode, 'r') && !std::strchr(mode, '+');
    Assimp::IOStream* const stream =
        reads && Exists(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
    if (stream) files_.note_opened(name, stream->FileSize());
    return stream;
}

}  // namespace cdprep::import
