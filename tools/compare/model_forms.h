// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/result.h"
#include "study/memory_model.h"
#include "study/study_mesh.h"

namespace cdprep::study {

/// A mesh in every form that is compared, in memory.
struct ModelForms {
    MemoryModel plain;  ///< as bake makes it, with pieces and hulls
    MemoryModel swept;  ///< the hierarchy with PQP's volumes: oriented boxes and swept rectangles
    MemoryModel paper;  ///< octree, hashed octree and tetra-tree of 512 leaf cells
    MemoryModel tuned;  ///< octree and tetra-tree with boxes, divided for speed
    MemoryModel tuned_hashed;  ///< the hashed octree, which wants a division of its own
};

/// Builds all of them. Fails as make_memory_model(), and with `interrupted` when stopped.
[[nodiscard]] Result<ModelForms> make_model_forms(const StudyMesh& mesh, ParallelFor parallel_for,
                                                  const mesh::StopCheck& stop = {});

}  // namespace cdprep::study
