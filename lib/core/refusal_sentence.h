// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "cdprep/model.h"

namespace cdprep {

/// The properties of a model that decide which queries it serves.
struct Contents {
    SectionSet sections;
    bool has_exact_leaves;
    bool is_balanced;
};

/// Returns the reason why `contents` do not serve the first unserved query of `asks`. The sentence
/// names the file, the query, every missing section and the remedy. If the table of needs lacks all
/// of `asks`, it says that this version does not know the query.
[[nodiscard]] std::string refusal_sentence(std::string_view file, Ask asks,
                                           const Contents& contents, Refusal::Reason reason);

}  // namespace cdprep
