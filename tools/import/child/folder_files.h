// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace cdprep::import {

/// The files that an imported file may name: those of its own folder and below,
/// for reading only. Adds the bytes of every file that is opened to `input_bytes`.
class FolderFiles : public Assimp::DefaultIOSystem {
public:
    FolderFiles(const std::filesystem::path& main_file, std::uint64_t& input_bytes);

    bool Exists(const char* name) const override;
    Assimp::IOStream* Open(const char* name, const char* mode) override;

private:
    [[nodiscard]] bool is_allowed(const char* name) const;

    std::filesystem::path folder_;
    std::uint64_t& input_bytes_;
};

}  // namespace cdprep::import
