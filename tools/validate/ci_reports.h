// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validate/validation_run.h"

namespace cdprep::report {

/// A JUnit report is the head, the files, and the tail.
///
/// A file is a test suite and each rule a test case in it: a failure when it found
/// something that makes the run fail, passed with its findings as output when it found
/// less, skipped when it is off. A file that could not be read is an error.
[[nodiscard]] std::string junit_head();
[[nodiscard]] std::string junit_suite(const ValidationReport& report, const ValidationRun& run);
[[nodiscard]] std::string junit_tail();

/// A SARIF 2.1.0 log, in pieces: the head, then one file after the other, then the tail.
///
/// A place is a result with the file as artifact and its node, triangles and vertices as
/// logical locations; there are no lines to name. Of a finding with more places than are
/// kept, one result more says how many. A file that could not be read is a notification
/// of the invocation.
class Sarif {
public:
    explicit Sarif(ValidationRun run) : run_(std::move(run)) {}

    [[nodiscard]] std::string head() const;
    [[nodiscard]] std::string add(const ValidationReport& report);
    [[nodiscard]] std::string tail(const ValidationTotals& totals) const;

private:
    ValidationRun run_;
    bool is_first_ = true;                    ///< result
    std::vector<std::string> artifacts_;      ///< one a file
    std::vector<std::string> notifications_;  ///< of files that could not be read, and remarks
};

}  // namespace cdprep::report
