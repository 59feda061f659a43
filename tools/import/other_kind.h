// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cdprep::import {

/// Says what a file is that is no mesh, or in a format that nobody here reads, and what to do:
/// "is a web page, not a mesh. ...". Nothing for all others. Looks at the first bytes and at the
/// name's ending.
[[nodiscard]] std::optional<std::string> find_other_kind(std::string_view bytes,
                                                         const std::filesystem::path& path);

}  // namespace cdprep::import
