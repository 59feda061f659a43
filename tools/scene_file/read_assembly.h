// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "import/assembly.h"
#include "scene_file/scene_file.h"

namespace cdprep::scenes {

/// The meshes of a node, and what is done to them before the bake.
struct AssemblyNode {
    std::uint32_t node = 0;  ///< its number in Assembly::nodes(): the first that uses the model
    /// Of a node that is alone: the identity, a uniform scale, or all that a pose cannot express.
    import::Affine model_from_mesh{};
};

/// A model of an assembly: one node, or several that move as one.
using AssemblyModel = std::vector<AssemblyNode>;

/// A mesh file with nodes as a scene: each node with triangles is an object.
struct AssemblyScene {
    import::Assembly file;
    SceneFile scene;  ///< its objects are in one layer, "objects", and there are no pairs
    std::vector<AssemblyModel> models;  ///< by number in SceneFile::models
    /// The largest entry of |M^T M - I| that was rounded off, of all transforms M without scale.
    double rounding = 0;
};

/// The largest deviation of a transform from a rigid motion, that counts as rounding: as
/// nearest_pose() advises for floats.
inline constexpr double kFloatRounding = 1e-5;

/// Returns whether a file is glTF, by its extension or first bytes.
[[nodiscard]] bool is_assembly(const std::filesystem::path& path);

/// Reads a mesh file with nodes. Nodes that use the same meshes share a model.
///
/// A node's transform becomes its pose if it is rigid, up to kFloatRounding. The size of a
/// uniform scale is applied to the vertices of the model. Nodes of the same size share it. Any
/// other transform (shear, mirror, unequal scales) is applied to the vertices, without its
/// translation. Nodes share such a model only if their transforms differ at most by translations.
///
/// An object is named by the path of its node, "root/arm/hand". If nodes have the same path, the
/// later ones get "#2", "#3" and so on.
///
/// Fails as Assembly::open(). Also fails if a transform has a number that is not finite or too
/// large; the message names the node.
[[nodiscard]] Result<AssemblyScene> read_assembly(const std::filesystem::path& path,
                                                  const import::ImportOptions& options);

}  // namespace cdprep::scenes
