// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/mesh_arrays.h"
#include "cdprep/advanced/section_list.h"
#include "cdprep/format/api.h"
#include "cdprep/result.h"

namespace cdprep::build {

/// The precision in which a model stores positions.
enum class Precision : std::uint8_t {
    single_precision,  ///< as floats; a value that is not a float is rounded to the nearest one
    double_precision,
};

/// The arrays of a model that queries read. `cdprep bake` makes the same arrays from a mesh. It
/// always adds bounds, verdicts, findings and notes about the imported file. Its options add hulls,
/// pieces, octrees, tetra-trees and mass properties.
struct ModelArrays {
    format::FileHeader facts{};
    Bvh bvh;
    Precision precision = Precision::double_precision;
    std::vector<format::Float3> positions_f32;   ///< with single_precision; else empty
    std::vector<format::Double3> positions_f64;  ///< with double_precision; else empty
    std::vector<format::Triangle> triangles;     ///< tree order
    std::vector<std::uint32_t> source_vertex;    ///< per vertex: its number in the input
    std::vector<std::uint64_t> degenerate_bits;  ///< empty when no triangle is degenerate
    std::vector<format::Component> components;

    /// Returns views of the wanted arrays, for build_image(). The views are valid while this object
    /// lives and is not moved.
    ///
    ///     arrays.sections(sections_for(Ask::overlap | Ask::ray))
    [[nodiscard]] CDPREP_API SectionList
    sections(format::SectionSet wanted = format::SectionSet::all()) const;
};

/// The properties of a model that will be built.
struct PlannedModel {
    std::uint32_t vertex_count = 0;  ///< including vertices that no triangle uses
    std::uint32_t triangle_count = 0;
    Precision precision = Precision::double_precision;
    BvhBounds bounds = BvhBounds::oriented;
    format::SectionSet wanted = format::SectionSet::all();
};

/// Returns an upper bound of image_size() for the arrays that build_model() builds from any mesh
/// with these counts. The bound is the size for a mesh with degenerate triangles, and with as many
/// used vertices and components as possible. Takes O(1) time. Never allocates.
///
///     std::span<std::byte> room = arena.allocate(build::image_size_bound(planned), 64);
///     const auto arrays = build::build_model(positions, triangles, {.bounds = planned.bounds});
///     const auto image = build::build_image(arrays.value().facts,
///                                           arrays.value().sections(planned.wanted).sections(),
///                                           room);
[[nodiscard]] CDPREP_API std::uint64_t image_size_bound(const PlannedModel& planned) noexcept;

/// Builds the arrays of a model from a mesh. Query results name a triangle by its index in
/// `triangles`. ModelArrays::source_vertex holds indices in `positions`.
///
/// Vertices are shared as in `triangles`. Equal positions with different numbers are not welded,
/// and a surface with such a seam is not balanced. Positions that no triangle uses are left out.
/// Triangles may be degenerate or equal.
///
/// Fails with `bad_argument`, and names the first bad vertex or triangle, if a position is NaN,
/// infinite or beyond format::kMaxCoordinate. Also fails if a triangle uses a vertex that does not
/// exist, or a count exceeds format::kMaxTriangles or kMaxVertices. Takes O(n log n) time;
/// allocates. The arrays are the same for any options.parallel_for.
///
///     const auto arrays = build::build_model(positions, triangles);
///     if (!arrays) return arrays.error();
///     const build::SectionList list = arrays.value().sections();
///     const auto image = build::build_image(arrays.value().facts, list.sections(), memory);
///     const auto model = Model::open(image.value());
[[nodiscard]] CDPREP_API Result<ModelArrays> build_model(
    std::span<const format::Double3> positions, std::span<const format::Triangle> triangles,
    const BvhOptions& options = {});

/// Builds the same arrays from floats. The model stores these floats.
[[nodiscard]] CDPREP_API Result<ModelArrays> build_model(
    std::span<const format::Float3> positions, std::span<const format::Triangle> triangles,
    const BvhOptions& options = {});

/// Builds the same arrays with a BVH that build_bvh() built over these triangles. The mesh must
/// meet the requirements of build_model(), which are not checked. With Precision::single_precision,
/// every coordinate must be a float. Otherwise, rounded vertices may lie outside the boxes of
/// `bvh`.
[[nodiscard]] CDPREP_API ModelArrays arrange_model(std::span<const format::Double3> positions,
                                                   std::span<const format::Triangle> triangles,
                                                   Bvh bvh, Precision precision,
                                                   ParallelFor parallel_for = serial_for);

}  // namespace cdprep::build
