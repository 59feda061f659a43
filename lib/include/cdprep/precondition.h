// SPDX-License-Identifier: MIT
#pragma once

namespace cdprep {

/// Called with one sentence when a C++ question is asked that its model cannot serve: the caller's
/// mistake, which no answer could report. It may log the sentence, write a dump or end the
/// program. When it returns, the program is aborted.
using PreconditionHandler = void (*)(const char* sentence);

/// Sets the handler of the whole program and returns the one before. Null sets the default, which
/// prints the sentence on standard error. Any thread may call it. This handler is the library's
/// only mutable global; the C API never calls it, but returns CDPREP_BAD_ARGUMENT.
PreconditionHandler set_precondition_handler(PreconditionHandler handler) noexcept;

}  // namespace cdprep
