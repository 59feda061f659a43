// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cdprep::cli {

/// Returns true if a shell would expand `text`: it contains one of * ? [.
[[nodiscard]] bool is_pattern(const std::string& text);

/// Returns the existing paths that match a pattern, sorted. *, ? and [...] match within a
/// name; ** matches any number of folders. As in a shell, only a pattern that begins with a
/// dot matches a name that does. Folders that cannot be read match nothing.
[[nodiscard]] std::vector<std::filesystem::path> expand_pattern(const std::string& pattern);

}  // namespace cdprep::cli
