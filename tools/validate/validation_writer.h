// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "validate/ci_reports.h"
#include "validate/validation_run.h"

namespace cdprep::report {

enum class ValidationFormat : std::uint8_t { text, json, ndjson, sarif, junit };

/// Writes the report of a run file by file, so that no more than one is held: each call
/// returns the next bytes of it.
class ValidationWriter {
public:
    ValidationWriter(ValidationFormat format, ValidationRun run)
        : format_(format), run_(std::move(run)), sarif_(run_) {}

    [[nodiscard]] std::string head() const;
    [[nodiscard]] std::string add(const ValidationReport& report);

    /// Call once, after the last file. The exit code is the highest of the files'.
    [[nodiscard]] std::string tail();

    /// Tells the tail that not all files were looked at.
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
