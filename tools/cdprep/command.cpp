// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"

#include <iostream>

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
    std::cerr << "cdprep " << command << ": " << error.message << '\n';
    return exit_for(error.code);
}

}  // namespace cdprep::cli
