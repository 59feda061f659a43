// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace cdprep::test {

/// The folder of large test models, beside a checkout or in $CDPREP_SHARED; they are not ours to
/// keep here. Nothing where it has no folder `part`.
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
