// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/box_pyramid.h"

namespace cdprep::convex {

BoxPyramid::BoxPyramid(const mesh::Mesh& mesh) : mesh_(mesh) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (i % kWidth == 0) boxes.push_back(box_of_triangle(i));
        for (const std::uint32_t v : mesh.triangles[i].vertex) {
            boxes.back().take_in(mesh.positions[v]);
        }
    }
    while (!boxes.empty()) {
        levels_.push_back(boxes);
        if (boxes.size() == 1) return;
        std::vector<Box> above;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (i % kWidth == 0) above.push_back(boxes[i]);
            above.back().take_in(boxes[i].lower);
            above.back().take_in(boxes[i].upper);
        }
        boxes = std::move(above);
    }
}

}  // namespace cdprep::convex
