// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/api.h"

namespace cdprep {

/// Receives one sentence when a C++ query is called but the model or the workspace cannot serve it.
/// This is an error of the caller that the query's result cannot report. The handler may log the
/// sentence, write a dump or end the program. If it returns, the program is aborted.
using PreconditionHandler = void (*)(const char* sentence);

/// Sets the process-wide handler and returns the previous one. Null sets the default, which prints
/// the sentence to standard error. Any thread may call this function. The handler is the library's
/// only mutable global. The C API never calls the handler; it returns CDPREP_BAD_ARGUMENT instead.
CDPREP_API PreconditionHandler set_precondition_handler(PreconditionHandler handler) noexcept;

}  // namespace cdprep
