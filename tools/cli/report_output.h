// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "cdprep/result.h"
#include "write/output_file.h"

namespace cdprep::cli {

/// The destination of a report that is written step by step: a file or standard output. The
/// file appears only when it is complete.
class ReportOutput {
public:
    /// Opens a file, or standard output for an empty path. Fails with `unwritable`.
    [[nodiscard]] static Result<ReportOutput> open(const std::filesystem::path& path);

    [[nodiscard]] bool is_file() const noexcept {
        return file_.has_value();
    }

    [[nodiscard]] Result<Done> append(std::string_view text);

    /// Completes the report. Call once, after the last append(); without the call no file appears.
    [[nodiscard]] Result<Done> finish();

private:
    std::optional<write::OutputFile> file_;
    std::uint64_t size_ = 0;
};

}  // namespace cdprep::cli
