// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/validation_run.h"

#include <algorithm>

namespace cdprep::report {

void ValidationTotals::add(const ValidationReport& report) {
    ++files;
    exit = std::max(exit, report.exit);
    known += report.known + (report.known_error ? 1 : 0);
    if (report.error) {
        ++unreadable;
        return;
    }
    if (report.exit != 0) ++failed;
    for (const Judgement& judgement : report.judgements) {
        if (judgement.severity == mesh::Severity::error) errors += judgement.fresh;
        if (judgement.severity == mesh::Severity::warning) warnings += judgement.fresh;
        if (judgement.severity == mesh::Severity::note) notes += judgement.fresh;
    }
}

}  // namespace cdprep::report
