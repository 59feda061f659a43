// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/model_forms.h"

#include <optional>
#include <utility>

#include "cdprep/cells/structure_presets.h"

namespace cdprep::study {
namespace {

build::OctreeOptions octree_options(const build::TreeLimits& limits, bool hashed, bool boxes) {
    return {.level = limits.level,
            .threshold = limits.threshold,
            .hashed = hashed,
            .boxes_in = boxes ? std::optional(build::Frame{}) : std::nullopt};
}

build::TetraTreeOptions tetra_options(const build::StructurePreset& preset) {
    return {.level = preset.tetra_tree.level,
            .threshold = preset.tetra_tree.threshold,
            .bounding = preset.bounding};
}

}  // namespace

Result<ModelForms> make_model_forms(const StudyMesh& mesh, ParallelFor parallel_for,
                                    const mesh::StopCheck& stop) {
    const build::BvhBounds as_baked = build::BvhOptions{}.bounds;
    const build::StructurePreset& paper = build::kPaperPreset;
    const build::StructurePreset& tuned = build::kTunedPreset;
    const auto made = [&](const MemoryParts& parts) -> Result<MemoryModel> {
        if (mesh::is_stopped(stop)) {
            return Error{ErrorCode::interrupted, mesh.name + ": stopped."};
        }
        return make_memory_model(mesh.mesh, parts, parallel_for);
    };
    Result<MemoryModel> plain =
        made({.bounds = as_baked, .hulls = true, .pieces = true, .stop = stop});
    if (!plain) return plain.error();
    Result<MemoryModel> swept = made({.bounds = build::BvhBounds::oriented_and_swept});
    if (!swept) return swept.error();
    Result<MemoryModel> at_paper = made({.bounds = as_baked,
                                         .octree = octree_options(paper.octree, true, paper.boxes),
                                         .tetra_tree = tetra_options(paper)});
    if (!at_paper) return at_paper.error();
    Result<MemoryModel> at_tuned = made({.bounds = as_baked,
                                         .octree = octree_options(tuned.octree, false, tuned.boxes),
                                         .tetra_tree = tetra_options(tuned)});
    if (!at_tuned) return at_tuned.error();
    Result<MemoryModel> hashed = made(
        {.bounds = as_baked, .octree = octree_options(tuned.hashed_octree, true, tuned.boxes)});
    if (!hashed) return hashed.error();
    return ModelForms{std::move(plain).value(), std::move(swept).value(),
                      std::move(at_paper).value(), std::move(at_tuned).value(),
                      std::move(hashed).value()};
}

}  // namespace cdprep::study
