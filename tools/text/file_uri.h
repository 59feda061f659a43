// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace cdprep::report {

/// Returns a reference to a file in the form of RFC 3986: relative if the file lies below
/// `folder`, else file:///... . `folder` must be absolute; `path` may be relative to it. Dots are
/// resolved by their spelling; the disk is not read.
[[nodiscard]] std::string file_uri(const std::filesystem::path& path,
                                   const std::filesystem::path& folder);

}  // namespace cdprep::report
