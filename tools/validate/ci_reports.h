// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validate/validation_run.h"

namespace cdprep::report {

/// The parts of a JUnit report: the head, the files, the tail.
///
/// A file is a test suite, and each rule is a test case in it. A test case fails if its findings
/// make the run fail. With lesser findings it passes and lists them as output. It is skipped if
/// the rule is off. A file that could not be read is an error.
[[nodiscard]] std::string junit_head();
[[nodiscard]] std::string junit_suite(const ValidationReport& report, const ValidationRun& run);
[[nodiscard]] std::string junit_tail();

/// A SARIF 2.1.0 log, step by step: the head, then one file after the other, then the tail.
///
/// Each place of an error or warning is a result. Its artifact is the file; its node, triangles and
/// vertices are logical locations. There are no line numbers. If a finding has more places than are
/// kept, one more result gives the number of the rest. A note is one result, with its count. A file
/// that could not be read is a notification of the invocation.
class Sarif {
public:
    explicit Sarif(ValidationRun run) : run_(std::move(run)) {}

    [[nodiscard]] std::string head() const;
    [[nodiscard]] std::string add(const ValidationReport& report);
    [[nodiscard]] std::string tail(const ValidationTotals& totals) const;

private:
    ValidationRun run_;
    bool is_first_ = true;                    ///< no result written yet
    std::vector<std::string> artifacts_;      ///< one per file
    std::vector<std::string> notifications_;  ///< files that could not be read, and remarks
};

}  // namespace cdprep::report
