// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace cdprep::test {

/// Returns the folder of the large test models, beside a checkout or in $CDPREP_SHARED. The models
/// are not part of the repository, because they are not ours. Returns nothing if the folder has no
/// subfolder `part`.
[[nodiscard]] inline std::optional<std::filesystem::path> shared_models(const char* part) {
    const char* const chosen = std::getenv("CDPREP_SHARED");
    const std::filesystem::path beside =
        std::filesystem::path(__FILE__).parent_path() / "../../../shared";
    const std::filesystem::path folder =
        (chosen != nullptr ? std::filesystem::path(chosen) : beside) / "models";
    if (!std::filesystem::is_directory(folder / part)) return std::nullopt;
    return folder;
}

}  // namespace cdprep::test
