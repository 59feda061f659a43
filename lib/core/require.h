// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/precondition.h"

namespace cdprep {

/// Stops the program with the sentence of Model::refusal(). Requires that there is one.
[[noreturn]] CDPREP_API void refuse(const Model& model, Ask asks) noexcept;

/// Stops the program, in every build, if the model does not serve the query. Every C++ query begins
/// with this call. Costs one AND.
inline void require(const Model& model, Ask asks) noexcept {
    if (!model.serves(asks)) [[unlikely]]
        refuse(model, asks);
}

/// As above for two models, in one test.
inline void require(const Model& a, const Model& b, Ask asks) noexcept {
    if (!contains(a.asks() & b.asks(), asks)) [[unlikely]] {
        refuse(a.serves(asks) ? b : a, asks);
    }
}

/// Stops the program, in every build, if a batch has no workspace.
inline void require_workspaces(std::size_t count) noexcept {
    if (count == 0) [[unlikely]]
        stop_with("A batch needs at least one workspace.");
}

}  // namespace cdprep
