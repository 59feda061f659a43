// SPDX-License-Identifier: MIT
// A mesh that changes its shape each frame, and which of its triangles overlap a static one.
//
//     sample_deforming
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "cdprep/live_model.h"
#include "cdprep/pairs.h"

namespace {

struct Mesh {
    std::vector<cdprep::Double3> positions;
    std::vector<cdprep::format::Triangle> triangles;
};

/// A ring about the z axis: n times n squares, two triangles each.
Mesh ring(std::uint32_t n, double radius, double tube) {
    Mesh mesh;
    const double step = 2 * std::numbers::pi / n;
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const std::uint32_t row = i / n, column = i % n;
        const double around = step * row, across = step * column;
        const double r = radius + tube * std::cos(across);
        mesh.positions.push_back(
            {r * std::cos(around), r * std::sin(around), tube * std::sin(across)});
        const std::uint32_t a = i, b = row * n + (i + 1) % n;  // the next across
        const std::uint32_t c = (a + n) % (n * n), d = (b + n) % (n * n);
        mesh.triangles.push_back({{a, c, b}});
        mesh.triangles.push_back({{b, c, d}});
    }
    return mesh;
}

/// Memory that starts where a model may: at a multiple of 64 bytes.
struct alignas(cdprep::format::kSectionAlignment) Line {
    std::byte bytes[cdprep::format::kSectionAlignment];
};

}  // namespace

int main() {
    const Mesh fixed = ring(64, 1, 0.3), rest = ring(64, 1, 0.2);

    // A model that stays as it is: from a mesh to arrays, from arrays to its bytes.
    const auto arrays = cdprep::build::build_model(fixed.positions, fixed.triangles);
    const auto list = arrays.value().sections();
    std::vector<Line> fixed_room(cdprep::build::image_size(list.sections()).value() / sizeof(Line));
    const auto image = cdprep::build::build_image(arrays.value().facts, list.sections(),
                                                  std::as_writable_bytes(std::span(fixed_room)));
    const auto fixed_model = cdprep::Model::open(image.value());

    // A model whose vertices move: it has plain boxes, which are quick to refit.
    const auto moving = cdprep::build::build_model(rest.positions, rest.triangles,
                                                   {.bounds = cdprep::build::BvhBounds::aligned});
    std::vector<Line> room(cdprep::LiveModel::bytes(moving.value()).value() / sizeof(Line));
    auto object = cdprep::LiveModel::in(std::as_writable_bytes(std::span(room)), moving.value());
    if (!fixed_model || !object) return 1;

    cdprep::Workspace workspace;
    std::vector<cdprep::TrianglePair> pairs(100'000);         // yours: nothing below allocates
    std::vector<cdprep::Double3> positions = rest.positions;  // yours: write the new shape here
    for (int frame = 0; frame < 100; ++frame) {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            positions[i].x = rest.positions[i].x + 0.03 * frame * rest.positions[i].z;  // a shear
        }
        const auto fitted = object.value().refit(positions);
        if (!fitted) {
            std::cerr << fitted.error().message << '\n';  // a vertex that is NaN, say: by number
            return 1;
        }
        const std::size_t count = cdprep::overlaps(
            {object.value().model(), fixed_model.value(), cdprep::Placement::b_moves({})},
            workspace, pairs);
        if (frame % 11 == 0) std::cout << "frame " << frame << ": " << count << " pairs\n";
    }
}
