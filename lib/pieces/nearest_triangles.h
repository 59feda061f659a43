// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/contacts.h"
#include "pieces/contact_side.h"
#include "walk/find_contact.h"

namespace cdprep {

/// Finds the two triangles of two pieces, of which none touch, that are nearest to each other as
/// far as triangle_distance() tells; of several the first, by A's and then by B's. `start` are
/// two of them, which are near each other. In tree order.
[[nodiscard]] TreePair nearest_triangles(const ContactSide& a, const ContactSide& b,
                                         const TreePair& start, Degenerate degenerate) noexcept;

}  // namespace cdprep
