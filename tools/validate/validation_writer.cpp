// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/validation_writer.h"

#include "validate/ci_reports.h"
#include "validate/validation_json.h"
#include "validate/validation_text.h"

namespace cdprep::report {

std::string ValidationWriter::head() const {
    switch (format_) {
        case ValidationFormat::json:
            return validation_json_head(run_);
        case ValidationFormat::sarif:
            return sarif_.head();
        case ValidationFormat::junit:
            return junit_head();
        default:
            return "";
    }
}

std::string ValidationWriter::add(const ValidationReport& report) {
    const bool is_first = totals_.files == 0;
    totals_.add(report);
    switch (format_) {
        case ValidationFormat::json:
            return (is_first ? "" : ",\n") + validation_json_mesh(report, run_);
        case ValidationFormat::ndjson:
            return validation_ndjson(report, run_);
        case ValidationFormat::sarif:
            return sarif_.add(report);
        case ValidationFormat::junit:
            return junit_suite(report, run_);
        default:
            return validation_text(report, run_);
    }
}

std::string ValidationWriter::tail() {
    switch (format_) {
        case ValidationFormat::json:
            return validation_json_tail(totals_);
        case ValidationFormat::ndjson:
            return "";
        case ValidationFormat::sarif:
            return sarif_.tail(totals_);
        case ValidationFormat::junit:
            return junit_tail();
        default:
            return totals_text(totals_);
    }
}

void ValidationWriter::set_interrupted(int exit) {
    totals_.interrupted = true;
    totals_.exit = exit;
}

}  // namespace cdprep::report
