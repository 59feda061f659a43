// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

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

}  // namespace cdprep::report
