// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "validate/ci_reports.h"
#include "validate/validation_run.h"

namespace cdprep::report {

enum class ValidationFormat : std::uint8_t { text, json, ndjson, sarif, junit };

/// Writes the report of a run file by file, so that only one is in memory. Each call returns the
/// next bytes.
class ValidationWriter {
public:
    ValidationWriter(ValidationFormat format, ValidationRun run)
        : format_(format), run_(std::move(run)), sarif_(run_) {}

    [[nodiscard]] std::string head() const;
    [[nodiscard]] std::string add(const ValidationReport& report);

    /// Returns the end of the report. Call it once, after the last file. The exit code is the
    /// highest of the files.
    [[nodiscard]] std::string tail();

    /// Records for tail() that not all files were examined.
    void set_interrupted(int exit);

    [[nodiscard]] const ValidationTotals& totals() const noexcept {
        return totals_;
    }

private:
    ValidationFormat format_;
    ValidationRun run_;
    Sarif sarif_;
    ValidationTotals totals_;
};

}  // namespace cdprep::report
