// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace cdprep::report {

/// Returns a reference to a file as RFC 3986 writes it: relative when the file lies
/// below `folder`, which must be absolute; file:///... when it does not. `path` may be
/// relative to `folder`; dots are resolved by their spelling, the disk is not looked at.
[[nodiscard]] std::string file_uri(const std::filesystem::path& path,
                                   const std::filesystem::path& folder);

}  // namespace cdprep::report
