// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/api.h"

namespace cdprep {

/// Receives a message if a C++ function finds that one of its preconditions does not hold. For
/// example, the model or the workspace cannot serve a query. This is an error of the caller that
/// the function's result cannot report. The message is one or more whole sentences, and is valid
/// only during the call. The handler may log it, write a dump or end the program. If the handler
/// returns, the program is aborted.
using PreconditionHandler = void (*)(const char* sentence);

/// Sets the process-wide handler and returns the previous one. Null sets the default, which prints
/// the message to standard error. Any thread may call this function. The handler is the library's
/// only mutable global. The C API never calls the handler; it returns CDPREP_BAD_ARGUMENT instead.
CDPREP_API PreconditionHandler set_precondition_handler(PreconditionHandler handler) noexcept;

/// Calls the handler with one or more whole sentences, then aborts the program. The library calls
/// this function where a precondition does not hold.
[[noreturn]] CDPREP_API void stop_with(const char* sentence) noexcept;

}  // namespace cdprep
