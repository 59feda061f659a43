// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>

#include "cdprep/format/octree.h"
#include "section_view.h"

namespace cdprep::format {

inline Damage missing_section(SectionId id) noexcept {
    return {DamageKind::missing_section, id, kSectionTableOffset, 0, 1};
}

/// Finds the first missing section of a group of which a file must have all or none.
inline std::optional<Damage> find_gap(std::span<const std::byte> file,
                                      std::span<const SectionId> sections) noexcept {
    std::optional<Damage> gap;
    bool has_some = false;
    for (const SectionId id : sections) {
        if (find_section(file, id)) {
            has_some = true;
        } else if (!gap) {
            gap = missing_section(id);
        }
    }
    return has_some ? gap : std::nullopt;
}

/// Finds damage in a leaf's references, which must lie in the section. They must name existing
/// triangles and rise.
inline std::optional<Damage> find_bad_list(const SectionView<std::uint32_t>& references,
                                           std::uint64_t first, std::uint64_t count,
                                           std::uint64_t triangle_count) noexcept {
    assert(first <= references.count() && count <= references.count() - first);
    std::uint64_t least = 0;
    for (std::uint64_t i = first; i < first + count; ++i) {
        const std::uint32_t triangle = references[i] & ~kSharedReference;
        if (triangle >= triangle_count) {
            return references.damage(DamageKind::bad_index, i, triangle, triangle_count - 1);
        }
        if (triangle < least) {
            return references.damage(DamageKind::bad_order, i, triangle, least);
        }
        least = std::uint64_t{triangle} + 1;
    }
    return std::nullopt;
}

}  // namespace cdprep::format
