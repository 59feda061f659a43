// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/geometry.h"

namespace cdprep::build {

/// Sets bit i of `words`, 64 a word, if the corners of triangle i are exactly collinear; otherwise
/// clears it.
void mark_degenerate(std::span<const format::Double3> positions,
                     std::span<const format::Triangle> triangles, std::span<std::uint64_t> words,
                     ParallelFor parallel_for);
void mark_degenerate(std::span<const format::Float3> positions,
                     std::span<const format::Triangle> triangles, std::span<std::uint64_t> words,
                     ParallelFor parallel_for);

}  // namespace cdprep::build
