// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace cdprep::import {

/// The files that one import reads: the one that was asked for, and those it refers to, which must
/// lie in its folder or below.
class InputFiles {
public:
    explicit InputFiles(const std::filesystem::path& main_file);

    /// The path of `name` inside the folder; nothing when it lies elsewhere, is missing, or is no
    /// regular file.
    [[nodiscard]] std::optional<std::filesystem::path> find(
        const std::filesystem::path& name) const;

    /// Notes that a file was opened, once or again. The memory that the import may use grows with
    /// its bytes.
    void note_opened(const std::filesystem::path& path, std::uint64_t size);

    /// Counts the unpacked bytes of a part of an archive.
    void note_part(std::uint64_t size);

    /// Notes that a file was referred to and cannot be read.
    void note_missing(const std::string& name);

    /// References to meshes that were read under no name, "part.lwo, arm.lwo"; empty without any.
    /// Importers try several folders for one reference, so its last part decides.
    [[nodiscard]] std::string missing_meshes() const;

    [[nodiscard]] std::uint64_t bytes() const noexcept {
        return bytes_;
    }
    /// All but the main file, relative to its folder, sorted.
    [[nodiscard]] std::vector<std::string> opened() const {
        return {opened_.begin(), opened_.end()};
    }

private:
    std::filesystem::path main_file_;
    std::set<std::filesystem::path> counted_;
    std::set<std::string> opened_;
    std::vector<std::string> missing_;
    std::uint64_t bytes_ = 0;
};

}  // namespace cdprep::import
