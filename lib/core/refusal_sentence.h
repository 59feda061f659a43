// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "cdprep/model.h"

namespace cdprep {

/// What a model is made of, as far as needs depend on it.
struct Contents {
    SectionSet sections;
    bool has_exact_leaves;
    bool is_closed;
};

/// Returns why `contents` do not serve the first of `asks` that they do not serve: the name of the
/// file, the question, every section that it lacks, and the way out. Requires that there is one.
[[nodiscard]] std::string refusal_sentence(std::string_view file, Ask asks,
                                           const Contents& contents, Refusal::Reason reason);

}  // namespace cdprep
