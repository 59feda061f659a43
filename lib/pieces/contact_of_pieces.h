// SPDX-License-Identifier: MIT
#pragma once

#include "pieces/contact_side.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// What all pairs of pieces of a question share.
struct ContactQuestion {
    const Placement* placement;
    ContactOptions options;
    Degenerate degenerate;
    QueryCounts* counts;  ///< or null
};

/// Answers for one pair of pieces, of which two triangles are within the tolerance.
[[nodiscard]] Contact contact_of_pieces(const ContactSide& a, const ContactSide& b,
                                        const NearPieces& near,
                                        const ContactQuestion& question) noexcept;

}  // namespace cdprep
