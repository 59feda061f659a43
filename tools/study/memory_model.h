// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/model.h"
#include "mesh/mesh.h"
#include "mesh/stop.h"

namespace cdprep::study {

/// Bytes at the start of a page, for the image of a model.
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

/// What a model gets beside the hierarchy of boxes. Frames and parallel_for of the options are
/// filled in; boxes of an octree are made when its boxes_in holds any frame.
struct MemoryParts {
    build::BvhBounds bounds = build::BvhBounds::oriented_and_swept;
    std::optional<build::OctreeOptions> octree{};
    std::optional<build::AdaptiveOctreeOptions> adaptive_octree{};
    std::optional<build::TetraTreeOptions> tetra_tree{};
    bool hulls = false;   ///< exact, of the whole and, of several, of each component
    bool pieces = false;  ///< convex ones, exact, the hierarchy over them, and what contacts need
    mesh::StopCheck stop{};  ///< ends the search for pieces: the model is then of no use
};

/// What building took: seconds of the clock.
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

/// A model that was baked into memory, as a file would hold it but for HDF5 around it.
struct MemoryModel {
    ImageBytes image;
    Model model;
    mesh::Mesh ordered;  ///< triangles in tree order
    BuildSeconds seconds;
};

/// Bakes a welded mesh into memory: everything that questions about two models need, and the
/// parts. Answers are numbered as the triangles of `mesh`. Fails with over_budget where a hull
/// would leave the range of double. The same bytes for any parallel_for.
[[nodiscard]] Result<MemoryModel> make_memory_model(const mesh::Mesh& mesh,
                                                    const MemoryParts& parts = {},
                                                    ParallelFor parallel_for = serial_for);

/// Bytes of those of the sections that the model has.
[[nodiscard]] std::uint64_t bytes_of(const MemoryModel& model,
                                     format::SectionSet sections) noexcept;

/// What a baked model was made of, as a mesh: triangles in source order.
[[nodiscard]] mesh::Mesh mesh_of(const Model& model);

}  // namespace cdprep::study
