// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "cdprep/advanced/query_counts.h"
#include "cdprep/model.h"
#include "cdprep/workspace.h"

namespace cdprep::study {

/// Returns an upper bound of the bytes that a query with these counts read of two models' BVHs.
/// Each pair of nodes counts both with their tight bounds, and each pair of leaves counts both.
/// Each pair of triangles that float could not decide, or whose distance was measured, counts both
/// with their corners. Data that is read again counts again.
[[nodiscard]] double bytes_read(const QueryCounts& counts, const Model& a, const Model& b) noexcept;

/// Returns the mean of bytes_read() over the cases, or 0 without cases. Runs each case once with
/// this workspace.
[[nodiscard]] double mean_bytes_read(const Model& a, const Model& b, Workspace& workspace,
                                     std::size_t cases,
                                     const std::function<void(std::size_t number)>& ask);

}  // namespace cdprep::study
