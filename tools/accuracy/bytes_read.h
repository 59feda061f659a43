// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "cdprep/advanced/query_counts.h"
#include "cdprep/model.h"
#include "cdprep/workspace.h"

namespace cdprep::study {

/// Bytes of two models' hierarchies that were read for these counts, at most: of each pair of
/// nodes both with their tight bounds, of each pair of leaves both, of each pair of triangles
/// that float could not decide, or that was measured, both with their corners. What is read
/// again counts again.
[[nodiscard]] double bytes_read(const QueryCounts& counts, const Model& a, const Model& b) noexcept;

/// The same in the mean of the cases, each asked once with this workspace. 0 without any.
[[nodiscard]] double mean_bytes_read(const Model& a, const Model& b, Workspace& workspace,
                                     std::size_t cases,
                                     const std::function<void(std::size_t number)>& ask);

}  // namespace cdprep::study
