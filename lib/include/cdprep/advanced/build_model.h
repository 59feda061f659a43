// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/mesh_arrays.h"
#include "cdprep/advanced/section_list.h"
#include "cdprep/result.h"

namespace cdprep::build {

/// How a model keeps positions.
enum class Precision : std::uint8_t {
    single_precision,  ///< as floats: what is none is rounded to the nearest
    double_precision,
};

/// Everything that a model needs to be asked, as arrays: what `cdprep bake` makes of a mesh
/// but for hulls, pieces, octrees, bounds, mass, and notes about the imported file.
struct ModelArrays {
    format::FileHeader facts{};
    Bvh bvh;
    Precision precision = Precision::double_precision;
    std::vector<format::Float3> positions_f32;   ///< of single precision; else empty
    std::vector<format::Double3> positions_f64;  ///< of double precision; else empty
    std::vector<format::Triangle> triangles;     ///< tree order
    std::vector<std::uint32_t> source_vertex;    ///< per vertex: its number in the input
    std::vector<std::uint64_t> degenerate_bits;  ///< empty when no triangle is degenerate
    std::vector<format::Component> components;

    /// Views of the arrays that are wanted, for build_image(). Valid while this object lives
    /// and stays where it is.
    ///
    ///     arrays.sections(sections_for(Ask::overlap | Ask::ray))
    [[nodiscard]] SectionList sections(format::SectionSet wanted = format::SectionSet::all()) const;
};

/// A model that is yet to be built.
struct PlannedModel {
    std::uint32_t vertex_count = 0;  ///< those that no triangle uses count too
    std::uint32_t triangle_count = 0;
    Precision precision = Precision::double_precision;
    BvhBounds bounds = BvhBounds::oriented;
    format::SectionSet wanted = format::SectionSet::all();
};

/// Returns a number of bytes that is enough for the image: image_size() of what build_model()
/// makes of any mesh with these counts, or more. It is that of a mesh that has every vertex in use,
/// as many components as there can be, and degenerate triangles. O(1); allocates nothing.
///
///     std::span<std::byte> room = arena.allocate(build::image_size_bound(planned), 64);
///     const auto arrays = build::build_model(positions, triangles, {.bounds = planned.bounds});
///     const auto image = build::build_image(arrays.value().facts,
///                                           arrays.value().sections(planned.wanted).sections(),
///                                           room);
[[nodiscard]] std::uint64_t image_size_bound(const PlannedModel& planned) noexcept;

/// Builds the arrays of a model from a mesh. Questions then answer with the numbers of
/// `triangles`, and with source_vertex those of `positions`.
///
/// Vertices are shared as the triangles share them: equal positions that have different
/// numbers are not welded, and a surface with such a seam is not closed. Positions that no
/// triangle uses are left out. Triangles may be degenerate or equal.
///
/// Fails with `bad_argument`, and names the first vertex or triangle, when a position is NaN,
/// infinite or beyond format::kMaxCoordinate, when a triangle uses a vertex that is not
/// there, and when there are more than format::kMaxTriangles or kMaxVertices. O(n log n);
/// allocates. The same arrays for any options.parallel_for.
///
///     const auto arrays = build::build_model(positions, triangles);
///     if (!arrays) return arrays.error();
///     const build::SectionList list = arrays.value().sections();
///     const auto image = build::build_image(arrays.value().facts, list.sections(), memory);
///     const auto model = Model::open(image.value());
[[nodiscard]] Result<ModelArrays> build_model(std::span<const format::Double3> positions,
                                              std::span<const format::Triangle> triangles,
                                              const BvhOptions& options = {});

/// The same for floats, which the model keeps.
[[nodiscard]] Result<ModelArrays> build_model(std::span<const format::Float3> positions,
                                              std::span<const format::Triangle> triangles,
                                              const BvhOptions& options = {});

/// The same with a hierarchy that build_bvh() made over these triangles. The mesh is as
/// build_model() wants it; that is not checked.
[[nodiscard]] ModelArrays arrange_model(std::span<const format::Double3> positions,
                                        std::span<const format::Triangle> triangles, Bvh bvh,
                                        Precision precision, ParallelFor parallel_for = serial_for);

}  // namespace cdprep::build
