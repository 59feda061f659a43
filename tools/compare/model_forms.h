// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/result.h"
#include "study/memory_model.h"
#include "study/study_mesh.h"

namespace cdprep::study {

/// A mesh in every form that is compared, in memory.
struct ModelForms {
    MemoryModel plain;         ///< as bake makes it, with pieces and hulls
    MemoryModel swept;         ///< the BVH with PQP's volumes: oriented boxes and swept rectangles
    MemoryModel paper;         ///< octree, hashed octree and tetra-tree of 512 leaf cells
    MemoryModel tuned;         ///< octree and tetra-tree with boxes, divided for speed
    MemoryModel tuned_hashed;  ///< the hashed octree, whose best division differs
};

/// Builds all forms. Fails like make_memory_model(), and with `interrupted` if stopped.
[[nodiscard]] Result<ModelForms> make_model_forms(const StudyMesh& mesh, ParallelFor parallel_for,
                                                  const mesh::StopCheck& stop = {});

}  // namespace cdprep::study
