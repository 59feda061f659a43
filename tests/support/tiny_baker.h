// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "support/aligned_bytes.h"

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/section_set.h"

namespace cdprep::test {

using format::Double3;
using format::SectionId;
using format::Triangle;

struct TinyOptions {
    bool double_precision = false;  ///< positions_f64 instead of positions_f32
    /// The alignment of section starts; a multiple of format::kSectionAlignment.
    std::uint64_t section_alignment = format::kSectionAlignment;
    format::SectionSet leave_out = {};  ///< sections that are not written
    build::BvhBounds bounds = build::BvhOptions{}.bounds;
    build::Quality quality = build::Quality::best;
};

/// The id and bytes of one section.
struct TinySection {
    SectionId id;
    std::vector<std::byte> bytes;
};

/// Makes a complete file image in memory as the format requires, but without HDF5: user block,
/// a superblock of zeros, then the sections. Keeps the sharing of vertices unchanged. Positions
/// must be finite.
[[nodiscard]] AlignedBytes bake_tiny(std::span<const Double3> positions,
                                     std::span<const Triangle> triangles,
                                     const TinyOptions& options = {});

/// Makes the same with an existing BVH over these triangles.
[[nodiscard]] AlignedBytes bake_tiny(std::span<const Double3> positions,
                                     std::span<const Triangle> triangles, const build::Bvh& bvh,
                                     const TinyOptions& options = {});

/// Lays out sections after a user block with these facts. This is the last step of bake_tiny(),
/// for tests that change a section first.
[[nodiscard]] AlignedBytes assemble(const format::FileHeader& facts,
                                    const std::vector<TinySection>& sections,
                                    std::uint64_t section_alignment = format::kSectionAlignment);

}  // namespace cdprep::test
