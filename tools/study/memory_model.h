// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/model.h"
#include "mesh/mesh.h"
#include "mesh/stop.h"

namespace cdprep::study {

/// Page-aligned bytes for the image of a model.
class ImageBytes {
public:
    explicit ImageBytes(std::size_t size);
    [[nodiscard]] std::span<std::byte> span() noexcept {
        return {data_.get(), size_};
    }
    [[nodiscard]] std::span<const std::byte> span() const noexcept {
        return {data_.get(), size_};
    }

private:
    struct Free {
        void operator()(std::byte* bytes) const noexcept;
    };
    std::unique_ptr<std::byte[], Free> data_;
    std::size_t size_;
};

/// The parts of a model besides the BVH. make_memory_model() sets the frames and parallel_for of
/// the options. An octree gets boxes if its boxes_in holds any frame.
struct MemoryParts {
    build::BvhBounds bounds = build::BvhBounds::oriented_and_swept;
    std::optional<build::OctreeOptions> octree{};
    std::optional<build::AdaptiveOctreeOptions> adaptive_octree{};
    std::optional<build::TetraTreeOptions> tetra_tree{};
    bool hulls = false;   ///< exact hulls of the whole and, if there are several, of each component
    bool pieces = false;  ///< exact convex pieces, the hierarchy over them, and contact data
    bool mass = false;    ///< mass properties; the mesh must be balanced
    mesh::StopCheck stop{};  ///< ends the search for pieces; the model is then unusable
};

/// The wall-clock seconds of each step of the build.
struct BuildSeconds {
    double tree = 0;
    double octree = 0;
    double adaptive_octree = 0;
    double tetra_tree = 0;
    double hulls = 0;
    double pieces = 0;
    double piece_tree = 0;
    double contacts = 0;
};

/// A model baked into memory: the content of a baked file without the HDF5 around it.
struct MemoryModel {
    ImageBytes image;
    Model model;
    mesh::Mesh ordered;  ///< triangles in tree order
    BuildSeconds seconds;
};

/// Bakes a welded mesh into memory: the sections for all queries about two models, and `parts`.
/// Query results use the triangle numbers of `mesh`. Fails with over_budget if a hull would leave
/// the range of double. The bytes do not depend on parallel_for.
[[nodiscard]] Result<MemoryModel> make_memory_model(const mesh::Mesh& mesh,
                                                    const MemoryParts& parts = {},
                                                    ParallelFor parallel_for = serial_for);

/// Returns the total size in bytes of those `sections` that the model has.
[[nodiscard]] std::uint64_t bytes_of(const MemoryModel& model,
                                     format::SectionSet sections) noexcept;

/// Returns the mesh that a model was baked from, with its triangles in source order.
[[nodiscard]] mesh::Mesh mesh_of(const Model& model);

}  // namespace cdprep::study
