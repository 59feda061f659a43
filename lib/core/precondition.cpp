// SPDX-License-Identifier: MIT
#include "cdprep/precondition.h"

#include <atomic>
#include <cassert>
#include <cstdio>
#include <cstdlib>

#include "core/require.h"

namespace cdprep {
namespace {

void print(const char* sentence) {
    std::fputs(sentence, stderr);
    std::fputs("\n", stderr);
}

std::atomic<PreconditionHandler> handler_of_program = print;

}  // namespace

PreconditionHandler set_precondition_handler(PreconditionHandler handler) noexcept {
    return handler_of_program.exchange(handler == nullptr ? print : handler);
}

void stop_with(const char* sentence) noexcept {
    assert(sentence != nullptr);
    handler_of_program.load()(sentence);
    std::abort();
}

void refuse(const Model& model, Ask asks) noexcept {
    assert(!model.serves(asks));
    stop_with(model.refusal(asks)->message.c_str());
}

}  // namespace cdprep
