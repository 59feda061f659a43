// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace cdprep::import {

/// The files that one import reads: the requested file, and the files to which it refers. Those
/// must lie in its folder or below.
class InputFiles {
public:
    explicit InputFiles(const std::filesystem::path& main_file);

    /// Returns the path of `name` inside the folder. Returns nothing if it lies elsewhere, is
    /// missing, or is not a regular file.
    [[nodiscard]] std::optional<std::filesystem::path> find(
        const std::filesystem::path& name) const;

    /// Records that a file was opened, for the first time or again. The import's memory limit
    /// grows with its bytes.
    void note_opened(const std::filesystem::path& path, std::uint64_t size);

    /// Counts the unpacked bytes of a part of an archive.
    void note_part(std::uint64_t size);

    /// Records a reference to a file that cannot be read.
    void note_missing(const std::string& name);

    /// Returns the references to meshes that were not read, as "part.lwo, arm.lwo"; empty if there
    /// are none. Importers try several folders for one reference, so only the file name counts.
    [[nodiscard]] std::string missing_meshes() const;

    [[nodiscard]] std::uint64_t bytes() const noexcept {
        return bytes_;
    }
    /// Returns all opened files except the main file, relative to its folder, sorted.
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
