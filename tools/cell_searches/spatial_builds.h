// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/cells/structure_presets.h"
#include "study/study_mesh.h"
#include "study/timing.h"

namespace cdprep::study {

inline constexpr double kMebibyte = 1 << 20;  ///< bytes

enum class SpatialKind : std::uint8_t {
    tetra_tree,
    octree,
    hashed_octree,
    adaptive_median,  ///< octrees with split points of their own
    adaptive_area
};

/// The figures of one build.
struct SpatialFigures {
    std::uint64_t nodes_all = 0;  ///< with those that no triangle touches
    std::uint64_t nodes = 0;      ///< without them
    std::uint64_t leaves = 0;
    std::uint64_t references = 0;
    std::uint64_t largest_leaf = 0;
    std::uint64_t formula_all = 0;  ///< bytes by the published formula, over nodes_all
    std::uint64_t formula = 0;      ///< the same over nodes
    std::uint64_t bytes = 0;        ///< as stored
};

/// One structure with one setting.
struct SpatialBuild {
    std::string setting;  ///< "paper", "nearest" (to the published size) or "tuned"
    SpatialKind kind{};
    build::TreeLimits limits{};
    bool boxes = false;  ///< around the contents of cells
    SpatialFigures figures{};
    Timing one{};  ///< on one thread
    Timing all{};  ///< on all threads; wall time
};

struct SpatialOptions {
    std::size_t rounds = 5;
    bool nearest = true;  ///< searches the settings nearest to the published sizes
    ParallelFor parallel_for = serial_for;
    std::function<bool()> stop{};
};

/// Builds every structure over a mesh, in every setting.
[[nodiscard]] std::vector<SpatialBuild> measure_spatial_builds(const StudyMesh& mesh,
                                                               const SpatialOptions& options);

/// Returns the published figures of that structure for the model that a mesh represents; null if
/// there are none.
[[nodiscard]] const PublishedBuild* find_published_build(const Likeness& likeness,
                                                         SpatialKind kind) noexcept;

}  // namespace cdprep::study
