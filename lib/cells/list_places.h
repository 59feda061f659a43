// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/octree.h"

namespace cdprep {

/// Returns the place of a triangle's reference among all references, if a sorted list names the
/// triangle.
inline std::optional<std::uint32_t> find_reference(std::span<const std::uint32_t> references,
                                                   std::uint32_t first, std::uint32_t count,
                                                   std::uint32_t triangle) {
    const auto list = references.subspan(first, count);
    const auto at = std::lower_bound(list.begin(), list.end(), triangle,
                                     [](std::uint32_t reference, std::uint32_t wanted) {
                                         return (reference & ~format::kSharedReference) < wanted;
                                     });
    if (at == list.end() || (*at & ~format::kSharedReference) != triangle) return std::nullopt;
    return first + static_cast<std::uint32_t>(at - list.begin());
}

/// Finds a reference that is not marked correctly. `places` are all references that name one
/// triangle.
inline std::optional<format::Damage> find_wrong_mark(std::span<const std::byte> file,
                                                     format::SectionId id,
                                                     std::span<const std::uint32_t> references,
                                                     const std::vector<std::uint32_t>& places) {
    for (const std::uint32_t place : places) {
        const std::uint32_t reference = references[place];
        const bool marked = (reference & format::kSharedReference) != 0;
        if (marked != (places.size() > 1)) {
            return format::wrong_fact(file, id, place, reference,
                                      reference ^ format::kSharedReference);
        }
    }
    return std::nullopt;
}

}  // namespace cdprep
