// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "bake/bake_options.h"
#include "cdprep/result.h"
#include "cli/program_threads.h"

namespace cdprep::scenes {

/// A folder of baked files of meshes. Files are never removed.
class BakeCache {
public:
    explicit BakeCache(std::filesystem::path folder);

    /// Returns the baked file of a mesh. Bakes it unless the folder has one of the same mesh,
    /// options and version. The files that the mesh refers to must be the same too. Each file is
    /// hashed once, since a glTF file has many models. Creates the folder if it does not exist.
    [[nodiscard]] Result<std::filesystem::path> find_or_bake(
        const std::filesystem::path& mesh, const cli::BakeOptions& options,
        const cli::Threads& threads, const std::function<void(const char*)>& begins);

private:
    [[nodiscard]] Result<std::uint64_t> hash_of_file(const std::filesystem::path& path,
                                                     std::uint64_t max_bytes);
    [[nodiscard]] bool is_bake_of(const std::filesystem::path& baked,
                                  const std::filesystem::path& mesh, const std::string& origin,
                                  std::uint64_t max_bytes);

    std::filesystem::path folder_;
    std::map<std::filesystem::path, std::uint64_t> hashes_;  ///< of files that were hashed before
};

}  // namespace cdprep::scenes
