// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cdprep::cli {

/// Whether a shell would expand it: it has one of * ? [.
[[nodiscard]] bool is_pattern(const std::string& text);

/// What is there that a pattern matches, sorted: *, ? and [...] within a name, ** for any
/// number of folders. As in a shell, names that begin with a dot must be asked for with
/// one. Folders that cannot be read match nothing.
[[nodiscard]] std::vector<std::filesystem::path> expand_pattern(const std::string& pattern);

}  // namespace cdprep::cli
