// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "cdprep/result.h"
#include "write/output_file.h"

namespace cdprep::cli {

/// Where a report goes piece by piece: a file that appears when it is whole, or standard
/// output.
class ReportOutput {
public:
    /// An empty path means standard output. Fails with `unwritable`.
    [[nodiscard]] static Result<ReportOutput> open(const std::filesystem::path& path);

    [[nodiscard]] bool is_file() const noexcept {
        return file_.has_value();
    }

    [[nodiscard]] Result<Done> append(std::string_view text);

    /// Call once, after the last piece. Without it no file appears.
    [[nodiscard]] Result<Done> finish();

private:
    std::optional<write::OutputFile> file_;
    std::uint64_t size_ = 0;
};

}  // namespace cdprep::cli
