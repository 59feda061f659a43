// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/octree.h"
#include "section_view.h"

namespace cdprep::format {

/// Finds damage in the boxes of a tree's nodes, if the file has them and they are wanted. There
/// must be one for each node, in the frame, and none may end before it begins.
inline std::optional<Damage> find_bad_cell_box(std::span<const std::byte> file, SectionId id,
                                               SectionSet wanted, std::uint64_t nodes) noexcept {
    if (!wanted.contains(id) || !find_section(file, id)) return std::nullopt;
    const SectionView<CellBox> boxes(file, id, wanted);
    if (boxes.count() != nodes) return boxes.damage(DamageKind::bad_count, 0, boxes.count(), nodes);
    for (std::uint64_t i = 0; i < nodes; ++i) {
        const CellBox box = boxes[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float lower = box.lower[axis];
            const float upper = box.upper[axis];
            if (!(lower >= -1 && lower <= upper && upper <= 1)) {
                return boxes.damage(DamageKind::bad_box, i, i, 0);
            }
        }
    }
    return std::nullopt;
}

}  // namespace cdprep::format
