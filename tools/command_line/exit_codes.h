// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/result.h"

namespace cdprep::cli {

/// The result of the process. Scripts rely on the numbers; those of errors are the codes of errors.
enum class Exit : int {
    success = 0,
    findings = 1,
    usage = static_cast<int>(ErrorCode::bad_argument),
    unreadable = static_cast<int>(ErrorCode::unreadable),
    unwritable = static_cast<int>(ErrorCode::unwritable),
    over_budget = static_cast<int>(ErrorCode::over_budget),
    internal = static_cast<int>(ErrorCode::internal),
    interrupted = static_cast<int>(ErrorCode::interrupted),
};

struct ExitText {
    Exit code;
    const char* text;
};

/// The only list of exit codes. Manuals and documents are generated from it.
inline constexpr std::array<ExitText, 8> kExitTexts = {{
    {Exit::success, "success"},
    {Exit::findings, "findings: a defect, or a goal that was not reached"},
    {Exit::usage, "invalid arguments"},
    {Exit::unreadable, "input not readable"},
    {Exit::unwritable, "output not written"},
    {Exit::over_budget, "limit of memory, size or time exceeded"},
    {Exit::internal, "internal error"},
    {Exit::interrupted, "interrupted, or the output pipe was closed"},
}};

}  // namespace cdprep::cli
