// SPDX-License-Identifier: GPL-3.0-or-later
#include "cell_searches/spatial_builds.h"

#include <array>
#include <cmath>
#include <optional>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/cells/octree_figures.h"
#include "cdprep/cells/tetra_figures.h"
#include "mesh/tree_order.h"

namespace cdprep::study {
namespace {

using build::TreeLimits;

constexpr std::array<SpatialKind, 5> kKinds = {
    SpatialKind::tetra_tree, SpatialKind::octree, SpatialKind::hashed_octree,
    SpatialKind::adaptive_median, SpatialKind::adaptive_area};

/// A mesh in the form for builders.
struct Input {
    mesh::Mesh mesh;
    build::Frame frame;
};

Input in_tree_order(const mesh::Mesh& mesh, ParallelFor parallel_for) {
    const build::Bvh bvh =
        build::build_bvh(mesh.positions, mesh.triangles,
                         {.parallel_for = parallel_for, .bounds = build::BvhBounds::aligned});
    return {mesh::in_tree_order(mesh, bvh.order).mesh, bvh.frame};
}

SpatialFigures figures_of(const OctreeFigures& f) {
    return {f.nodes + f.empty_children,
            f.nodes,
            f.leaves,
            f.references,
            f.largest_leaf,
            seed_formula_bytes(f, EmptyChildren::counted),
            seed_formula_bytes(f, EmptyChildren::left_out),
            f.bytes};
}

SpatialFigures figures_of(const TetraFigures& f) {
    TetraFigures stored = f;
    stored.empty_cones = 0;
    return {f.nodes + f.empty_cones,
            f.nodes,
            f.leaves,
            f.references,
            f.largest_leaf,
            seed_formula_bytes(f),
            seed_formula_bytes(stored),
            f.bytes};
}

build::TetraTree tetra_tree(const Input& input, const SpatialBuild& how, ParallelFor run) {
    return build::build_tetra_tree(
        input.mesh.positions, input.mesh.triangles,
        {.parallel_for = run,
         .level = how.limits.level,
         .threshold = how.limits.threshold,
         .bounding = how.boxes ? format::TetraBounding::boxes : format::TetraBounding::caps,
         .frame_exponent = input.frame.exponent,
         .frame_origin = input.frame.origin});
}

build::Octree octree(const Input& input, const SpatialBuild& how, ParallelFor run) {
    return build::build_octree(input.mesh.positions, input.mesh.triangles,
                               {.parallel_for = run,
                                .level = how.limits.level,
                                .threshold = how.limits.threshold,
                                .hashed = how.kind == SpatialKind::hashed_octree,
                                .boxes_in = how.boxes ? std::optional(input.frame) : std::nullopt});
}

build::AdaptiveOctree adaptive_octree(const Input& input, const SpatialBuild& how,
                                      ParallelFor run) {
    return build::build_adaptive_octree(
        input.mesh.positions, input.mesh.triangles,
        {.parallel_for = run,
         .level = how.limits.level,
         .threshold = how.limits.threshold,
         .rule = how.kind == SpatialKind::adaptive_median ? format::SplitRule::median
                                                          : format::SplitRule::surface_area,
         .boxes_in = how.boxes ? std::optional(input.frame) : std::nullopt});
}

/// Passes the built structure to `with`, which must not keep it.
template <class With>
auto build_once(const Input& input, const SpatialBuild& how, ParallelFor run, With with) {
    switch (how.kind) {
        case SpatialKind::tetra_tree:
            return with(tetra_tree(input, how, run));
        case SpatialKind::octree:
        case SpatialKind::hashed_octree:
            return with(octree(input, how, run));
        default:
            return with(adaptive_octree(input, how, run));
    }
}

/// Returns the figures of a build.
struct Describe {
    const Input& input;

    SpatialFigures operator()(const build::TetraTree& tree) const {
        return figures_of(tetra_figures(tree, input.mesh.positions, input.mesh.triangles));
    }
    SpatialFigures operator()(const build::Octree& tree) const {
        return figures_of(octree_figures(tree, input.mesh.triangles.size()));
    }
    SpatialFigures operator()(const build::AdaptiveOctree& tree) const {
        return figures_of(adaptive_octree_figures(tree, input.mesh.triangles.size()));
    }
};

TreeLimits limits_of(const build::StructurePreset& preset, SpatialKind kind) {
    if (kind == SpatialKind::tetra_tree) return preset.tetra_tree;
    if (kind == SpatialKind::hashed_octree) return preset.hashed_octree;
    return kind == SpatialKind::octree ? preset.octree : preset.adaptive_octree;
}

/// Returns the settings at which a structure is nearest to the published size. The level is the
/// first, from that of `paper`, at which it is at least as large. The threshold is the nearest
/// power-of-two multiple at that level.
TreeLimits nearest_limits(const Input& input, SpatialKind kind, double mebibytes,
                          const SpatialOptions& options) {
    TreeLimits limits = limits_of(build::kPaperPreset, kind);
    const auto excess = [&](const TreeLimits& at) {
        const SpatialBuild how = {"", kind, at};
        const SpatialFigures figures =
            build_once(input, how, options.parallel_for, Describe{input});
        return static_cast<double>(figures.formula_all) - mebibytes * kMebibyte;
    };
    constexpr std::uint32_t kDeepest = 8;
    double at_limits = excess(limits);
    while (at_limits < 0 && limits.level < kDeepest) {
        ++limits.level;
        at_limits = excess(limits);
    }
    TreeLimits best = limits;
    double least = std::fabs(at_limits);
    // Sizes fall as the threshold rises.
    while (at_limits > 0 && limits.threshold < input.mesh.triangles.size()) {
        limits.threshold *= 2;
        at_limits = excess(limits);
        if (std::fabs(at_limits) < least) {
            least = std::fabs(at_limits);
            best = limits;
        }
    }
    return best;
}

std::vector<SpatialBuild> planned(const StudyMesh& mesh, const Input& input,
                                  const SpatialOptions& options) {
    std::vector<SpatialBuild> builds;
    builds.reserve(2 * kKinds.size() + 2);
    for (const SpatialKind kind : kKinds) {
        builds.push_back({"paper", kind, limits_of(build::kPaperPreset, kind)});
    }
    for (const SpatialKind kind : {SpatialKind::tetra_tree, SpatialKind::octree}) {
        const PublishedBuild* published = find_published_build(mesh.likeness, kind);
        // No setting is tuned to an erratum.
        if (!options.nearest || published == nullptr || *published->erratum != '\0') continue;
        builds.push_back(
            {"nearest", kind, nearest_limits(input, kind, published->mebibytes, options)});
    }
    for (const SpatialKind kind : kKinds) {
        builds.push_back(
            {"tuned", kind, limits_of(build::kTunedPreset, kind), build::kTunedPreset.boxes});
    }
    return builds;
}

/// Returns the time of each build.
std::vector<Timing> time_builds(const Input& input, const std::vector<SpatialBuild>& builds,
                                ParallelFor run, const TimingOptions& options) {
    std::vector<Question> questions;
    questions.reserve(builds.size());
    for (const SpatialBuild& how : builds) {
        questions.push_back(question_of([&input, &how, run](std::size_t) {
            return build_once(input, how, run,
                              [](const auto& tree) { return tree.references.size(); });
        }));
    }
    std::vector<Timing> taken;
    for (const Timings& timings : time_questions(1, questions, options)) {
        taken.push_back(timing_of(timings));
    }
    return taken;
}

}  // namespace

const PublishedBuild* find_published_build(const Likeness& likeness, SpatialKind kind) noexcept {
    if (!likeness.model) return nullptr;
    const PublishedModel& model = kPublished[*likeness.model];
    if (kind == SpatialKind::tetra_tree) return &model.tetra_tree;
    return kind == SpatialKind::octree ? &model.octree : nullptr;
}

std::vector<SpatialBuild> measure_spatial_builds(const StudyMesh& mesh,
                                                 const SpatialOptions& options) {
    const Input input = in_tree_order(mesh.mesh, options.parallel_for);
    std::vector<SpatialBuild> builds = planned(mesh, input, options);
    for (SpatialBuild& how : builds) {
        if (options.stop && options.stop()) return builds;
        how.figures = build_once(input, how, options.parallel_for, Describe{input});
    }
    TimingOptions timing = {.rounds = options.rounds, .least_sample_s = 0, .stop = options.stop};
    const std::vector<Timing> one = time_builds(input, builds, serial_for, timing);
    timing.by = TimedBy::wall;
    const std::vector<Timing> all = time_builds(input, builds, options.parallel_for, timing);
    for (std::size_t i = 0; i < builds.size(); ++i) {
        builds[i].one = one[i];
        builds[i].all = all[i];
    }
    return builds;
}

}  // namespace cdprep::study
