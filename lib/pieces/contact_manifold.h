// SPDX-License-Identifier: MIT
#pragma once

#include "pieces/contact_side.h"

namespace cdprep {

/// Fills in the points of a contact from its normal, features and points: those of the face of
/// the one piece that stands across the normal and of the other's that faces it most, clipped by
/// it, as far as they are within the tolerance; the contact's own points where no face stands
/// across.
void add_manifold(const ContactSide& a, const ContactSide& b, const PieceFeature& feature_a,
                  const PieceFeature& feature_b, double tolerance, Contact& contact) noexcept;

}  // namespace cdprep
