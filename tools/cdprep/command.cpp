// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"

#include <cmath>
#include <iostream>

#include "report/printable.h"

namespace cdprep::cli {

Exit exit_for(ErrorCode code) {
    switch (code) {
        case ErrorCode::bad_argument:
            return Exit::usage;
        case ErrorCode::unreadable:
            return Exit::unreadable;
        case ErrorCode::unwritable:
            return Exit::unwritable;
        case ErrorCode::over_budget:
            return Exit::over_budget;
        case ErrorCode::interrupted:
            return Exit::interrupted;
        default:
            return Exit::internal;
    }
}

Exit fail(const char* command, const Error& error) {
    std::cerr << "cdprep " << command << ": " << report::printable(error.message) << '\n';
    return exit_for(error.code);
}

CLI::Validator is_length() {
    return {[](std::string& word) -> std::string {
                double length = 0;
                const bool is_number = CLI::detail::lexical_cast(word, length);
                if (is_number && std::isfinite(length) && length >= 0) return "";
                return "'" + report::printable(word) + "' is not a finite number of 0 or more.";
            },
            ""};
}

}  // namespace cdprep::cli
