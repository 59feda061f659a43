// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/severity_name.h"

namespace cdprep::report {

const char* severity_name(mesh::Severity severity) noexcept {
    switch (severity) {
        case mesh::Severity::off:
            return "off";
        case mesh::Severity::note:
            return "note";
        case mesh::Severity::warning:
            return "warning";
        case mesh::Severity::error:
            break;
    }
    return "error";
}

std::optional<mesh::Severity> find_severity(std::string_view word) noexcept {
    if (word == "off") return mesh::Severity::off;
    if (word == "note") return mesh::Severity::note;
    if (word == "warn" || word == "warning") return mesh::Severity::warning;
    if (word == "error") return mesh::Severity::error;
    return std::nullopt;
}

}  // namespace cdprep::report
