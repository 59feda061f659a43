// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/page/scene_geometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace cdprep::report {
namespace {

/// The triangles of a model, by their source numbers.
struct SourceMesh {
    std::vector<Double3> positions;
    std::vector<format::Triangle> triangles;
    std::vector<std::uint32_t> numbers;  ///< ascending
};

std::vector<Double3> positions_of(const MeshView& mesh) {
    if (!mesh.positions_f64.empty()) {
        return {mesh.positions_f64.begin(), mesh.positions_f64.end()};
    }
    std::vector<Double3> positions;
    positions.reserve(mesh.positions_f32.size());
    for (const Float3& p : mesh.positions_f32) positions.push_back({p.x, p.y, p.z});
    return positions;
}

SourceMesh source_mesh(const Model& model) {
    const auto triangles = model.mesh().triangles;
    const auto numbers = model.source().triangle;
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    const bool is_numbered = numbers.size() == triangles.size();
    if (is_numbered) std::ranges::sort(order, {}, [&](std::uint32_t i) { return numbers[i]; });
    SourceMesh mesh{positions_of(model.mesh()), {}, {}};
    for (const std::uint32_t i : order) {
        mesh.triangles.push_back(triangles[i]);
        mesh.numbers.push_back(is_numbered ? numbers[i] : i);
    }
    return mesh;
}

/// Half the box of a model after a rotation.
Double3 rotated_half(const std::array<double, 9>& r, const Double3& half) {
    const auto row = [&](std::size_t i) {
        return std::abs(r[i]) * half.x + std::abs(r[i + 1]) * half.y + std::abs(r[i + 2]) * half.z;
    };
    return {row(0), row(3), row(6)};
}

/// Draws the models of a scene.
class Drawer {
public:
    Drawer(const scenes::SceneFile& file, std::span<const scenes::SceneModel> models,
           const SceneFrames& frames, std::span<const scenes::ChangingObjects> changing)
        : file_(file),
          frames_(frames),
          lit_(models.size()),
          halves_(models.size()),
          shapes_(file.objects.size(), kUnshaped) {
        scene_.models.resize(models.size());
        for (std::uint32_t i = 0; i < frames.objects(); ++i) {
            scene_.models[file.objects[i].model].is_drawn = true;
        }
        for (std::size_t i = 0; i < models.size(); ++i) measure(i, models[i]);
        measure_shapes(changing);
    }

    SceneGeometry draw(std::span<const scenes::SceneModel> models, std::size_t most) {
        find_frame();
        std::vector<std::size_t> sizes;
        for (const ModelDrawing& model : scene_.models) {
            sizes.push_back(model.is_drawn ? model.triangles : 0);
        }
        const std::vector<std::size_t> shares = share_triangles(sizes, most);
        find_lit();
        for (std::size_t i = 0; i < models.size(); ++i) {
            if (scene_.models[i].is_drawn) draw_model(i, *models[i].model, shares[i]);
        }
        return std::move(scene_);
    }

private:
    /// Finds the centre of a model and half its box.
    void measure(std::size_t number, const scenes::SceneModel& model) {
        ModelDrawing& drawing = scene_.models[number];
        if (!model.model) {
            drawing.is_drawn = false;
            return;
        }
        const SourceMesh mesh = source_mesh(*model.model);
        drawing.triangles = model.model->triangle_count();
        const auto frame = find_page_frame(mesh.positions, mesh.triangles);
        if (!frame) {
            drawing.is_drawn = false;
            return;
        }
        drawing.centre = frame->centre;
        const auto half = [&](std::size_t axis) {
            return std::ldexp(static_cast<double>(frame->half_box[axis]), frame->exponent);
        };
        halves_[number] = {half(0), half(1), half(2)};
    }

    /// Finds how far the shapes of objects reach from the middle of their models, in all frames.
    void measure_shapes(std::span<const scenes::ChangingObjects> changing) {
        reaches_.resize(changing.size());
        for (const ShownFrame& shown : frames_.frames()) {
            for (const ShownShape& shape : shown.shapes) {
                Double3& reach = reaches_[shape.changing];
                for (std::size_t i = 0; i + 2 < shape.positions.size(); i += 3) {
                    const auto away = [&](std::size_t axis) {
                        return double{std::abs(shape.positions[i + axis])};
                    };
                    reach = {std::max(reach.x, away(0)), std::max(reach.y, away(1)),
                             std::max(reach.z, away(2))};
                }
            }
        }
        for (std::uint32_t i = 0; i < changing.size(); ++i) {
            if (!frames_.live_models()[i].is_drawn) continue;
            for (const std::uint32_t object : changing[i].objects) shapes_[object] = i;
        }
    }

    /// Half the box of an object, about the middle of its model.
    [[nodiscard]] Double3 half_of(std::uint32_t object) const {
        const Double3& half = halves_[file_.objects[object].model];
        if (shapes_[object] == kUnshaped) return half;
        const Double3& reach = reaches_[shapes_[object]];
        return {std::max(half.x, reach.x), std::max(half.y, reach.y), std::max(half.z, reach.z)};
    }

    /// Finds the box of all objects in all frames, as that of two triangles at its corners.
    void find_frame() {
        bool is_first = true;
        Double3 low{};
        Double3 high{};
        for (const ShownFrame& shown : frames_.frames()) {
            for (const ObjectPose& moved : shown.moved) {
                const std::uint32_t model = file_.objects[moved.object].model;
                if (!scene_.models[model].is_drawn) continue;
                const Double3 middle = transform_point(moved.pose, scene_.models[model].centre);
                const Double3 half = rotated_half(moved.pose.rotation(), half_of(moved.object));
                if (std::exchange(is_first, false)) low = high = middle;
                low = {std::min(low.x, middle.x - half.x), std::min(low.y, middle.y - half.y),
                       std::min(low.z, middle.z - half.z)};
                high = {std::max(high.x, middle.x + half.x), std::max(high.y, middle.y + half.y),
                        std::max(high.z, middle.z + half.z)};
            }
        }
        const std::array<Double3, 2> box = {low, high};
        const std::array<format::Triangle, 1> triangle = {{{{0, 1, 1}}}};
        if (const auto frame = find_page_frame(box, triangle)) scene_.frame = *frame;
    }

    /// Finds the triangles of each model that are lit in some frame.
    void find_lit() {
        for (const ShownFrame& shown : frames_.frames()) {
            for (const LitTriangles& one : shown.lit) {
                std::vector<std::uint32_t>& lit = lit_[file_.objects[one.object].model];
                lit.insert(lit.end(), one.triangles.begin(), one.triangles.end());
            }
        }
        for (std::vector<std::uint32_t>& lit : lit_) {
            std::ranges::sort(lit);
            lit.erase(std::unique(lit.begin(), lit.end()), lit.end());
        }
    }

    void draw_model(std::size_t number, const Model& model, std::size_t share) {
        ModelDrawing& drawing = scene_.models[number];
        SourceMesh mesh = source_mesh(model);
        PageFrame frame{drawing.centre, scene_.frame.exponent, {}};
        const Double3& half = halves_[number];
        drawing.half = frame.from_model(
            {drawing.centre.x + half.x, drawing.centre.y + half.y, drawing.centre.z + half.z});
        if (mesh.triangles.size() <= share) {
            std::vector<std::uint32_t> all(mesh.triangles.size());
            std::iota(all.begin(), all.end(), 0);
            drawing.drawn = draw_triangles(mesh.positions, mesh.triangles, frame, all);
            drawing.numbers = std::move(mesh.numbers);
            return;
        }
        drawing.is_exact = false;
        draw_coarse(drawing, mesh, frame, share);
        draw_lit(drawing, mesh, frame, lit_[number], share);
    }

    /// The cells are those of the model's own box, and their corners are then in the scene's unit.
    static void draw_coarse(ModelDrawing& drawing, const SourceMesh& mesh, const PageFrame& frame,
                            std::size_t share) {
        const auto own = find_page_frame(mesh.positions, mesh.triangles);
        const double cells = std::sqrt(static_cast<double>(share) / 6);
        drawing.drawn = coarse_triangles(mesh.positions, mesh.triangles, *own, {},
                                         static_cast<std::uint32_t>(std::clamp(cells, 4.0, 256.0)));
        const int shift = own->exponent - frame.exponent;
        for (float& x : drawing.drawn.positions) x = std::ldexp(x, shift);
    }

    static void draw_lit(ModelDrawing& drawing, const SourceMesh& mesh, const PageFrame& frame,
                         std::span<const std::uint32_t> lit, std::size_t share) {
        for (const std::uint32_t number : lit) {
            const auto at = std::ranges::lower_bound(mesh.numbers, number);
            if (at == mesh.numbers.end() || *at != number) continue;
            if (drawing.numbers.size() == share) {
                ++drawing.lit_left_out;
                continue;
            }
            drawing.numbers.push_back(number);
            const auto place = static_cast<std::size_t>(at - mesh.numbers.begin());
            for (const std::uint32_t vertex : mesh.triangles[place].vertex) {
                const std::array<float, 3> corner = frame.from_model(mesh.positions[vertex]);
                drawing.lit.insert(drawing.lit.end(), corner.begin(), corner.end());
            }
        }
    }

    const scenes::SceneFile& file_;
    const SceneFrames& frames_;
    std::vector<std::vector<std::uint32_t>> lit_;  ///< source numbers, by model
    std::vector<Double3> halves_;                  ///< of the models' boxes, model units
    std::vector<Double3> reaches_;                 ///< by live model
    static constexpr std::uint32_t kUnshaped = 0xffffffffU;
    std::vector<std::uint32_t> shapes_;  ///< by object: its live model, or kUnshaped
    SceneGeometry scene_;
};

}  // namespace

SceneGeometry draw_scene(const scenes::SceneFile& file, std::span<const scenes::SceneModel> models,
                         const SceneFrames& frames,
                         std::span<const scenes::ChangingObjects> changing, std::size_t most) {
    return Drawer(file, models, frames, changing).draw(models, most);
}

std::array<double, 4> quaternion_of(const std::array<double, 9>& r) noexcept {
    const double trace = r[0] + r[4] + r[8];
    // Each of w, x, y, z times the greatest of them, times 4.
    std::array<double, 4> q{};
    if (trace >= r[0] && trace >= r[4] && trace >= r[8]) {
        q = {1 + trace, r[7] - r[5], r[2] - r[6], r[3] - r[1]};
    } else if (r[0] >= r[4] && r[0] >= r[8]) {
        q = {r[7] - r[5], 1 + r[0] - r[4] - r[8], r[1] + r[3], r[2] + r[6]};
    } else if (r[4] >= r[8]) {
        q = {r[2] - r[6], r[1] + r[3], 1 - r[0] + r[4] - r[8], r[5] + r[7]};
    } else {
        q = {r[3] - r[1], r[2] + r[6], r[5] + r[7], 1 - r[0] - r[4] + r[8]};
    }
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double divisor = q[0] < 0 ? -length : length;
    for (double& x : q) x /= divisor;
    return q;
}

}  // namespace cdprep::report
