// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "c/call.h"
#include "cdprep/c/model.h"
#include "cdprep/model.h"

namespace cdprep::c {

inline void store(const Double3& p, double* numbers) noexcept {
    numbers[0] = p.x;
    numbers[1] = p.y;
    numbers[2] = p.z;
}

/// Returns the number of vertices if their positions are open, otherwise 0.
[[nodiscard]] inline std::uint32_t count_positions(const Model& model) noexcept {
    const bool has_any = !model.mesh().positions_f32.empty() || !model.mesh().positions_f64.empty();
    return has_any ? model.vertex_count() : 0;
}

[[nodiscard]] inline Double3 position_of(const Model& model, std::uint32_t vertex) noexcept {
    if (model.mesh().positions_f32.empty()) return model.mesh().positions_f64[vertex];
    const format::Float3& p = model.mesh().positions_f32[vertex];
    return {p.x, p.y, p.z};
}

/// Returns the source number of a vertex.
[[nodiscard]] inline std::uint32_t source_vertex_of(const Model& model,
                                                    std::uint32_t vertex) noexcept {
    const auto source = model.source().vertex;
    return source.empty() ? vertex : source[vertex];
}

/// Sets the counts to 0, and refuses arrays that are null but have room.
inline int begin_mesh(Call& call, cdprep_mesh* mesh) noexcept {
    if (const int code = call.need(mesh, {"mesh"})) return code;
    mesh->vertex_count = 0;
    mesh->triangle_count = 0;
    if (mesh->positions == nullptr && mesh->vertex_room > 0) {
        return call.need(nullptr, Name{"mesh"}.of("positions"));
    }
    if (mesh->triangles == nullptr && mesh->triangle_room > 0) {
        return call.need(nullptr, Name{"mesh"}.of("triangles"));
    }
    return CDPREP_OK;
}

/// Fills a mesh element by element. The caller sets the counts.
class MeshWriter {
public:
    explicit MeshWriter(const cdprep_mesh& mesh) noexcept : mesh_(mesh) {}

    [[nodiscard]] bool has_room_for_vertex() const noexcept {
        return vertices_ < mesh_.vertex_room;
    }
    [[nodiscard]] bool has_room_for_triangle() const noexcept {
        return triangles_ < mesh_.triangle_room;
    }
    void add_vertex(const Double3& position, std::uint32_t number) noexcept {
        assert(has_room_for_vertex());
        store(position, mesh_.positions + 3 * vertices_);
        if (mesh_.vertices != nullptr) mesh_.vertices[vertices_] = number;
        ++vertices_;
    }
    void add_triangle(const std::array<std::uint32_t, 3>& vertex) noexcept {
        assert(has_room_for_triangle());
        for (std::size_t i = 0; i < 3; ++i) mesh_.triangles[3 * triangles_ + i] = vertex[i];
        ++triangles_;
    }

private:
    const cdprep_mesh& mesh_;
    std::size_t vertices_ = 0;
    std::size_t triangles_ = 0;
};

}  // namespace cdprep::c
