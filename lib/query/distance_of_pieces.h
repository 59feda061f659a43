// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/pairs.h"

namespace cdprep {

/// As distance(), through Structure::pieces.
[[nodiscard]] std::optional<Distance> distance_of_pieces(const Pair& pair, Workspace& workspace,
                                                         const DistanceOptions& options) noexcept;

/// As within(), through Structure::pieces. Requires that `tolerance` is at least 0 and no model is
/// empty.
[[nodiscard]] bool pieces_are_within(const Pair& pair, double tolerance,
                                     Workspace& workspace) noexcept;

}  // namespace cdprep
