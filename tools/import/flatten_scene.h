// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "import/import_file.h"
#include "import/scene_bytes.h"
#include "import/source_file.h"

namespace cdprep::import {
/// An affine map: three rows of four numbers.
using Affine = std::array<double, 12>;

/// A node of a scene whose meshes have triangles.
struct MeshNode {
    std::uint32_t number = 0;           ///< depth first
    std::string path;                   ///< "root/arm/hand"; several nodes may have the same
    std::vector<std::uint32_t> meshes;  ///< those with triangles; equal lists are equal geometry
    Affine world_from_node{};           ///< of its meshes: the identity if a skin places them
};

/// A use of a node's meshes, moved by `model_from_mesh` instead of the node's own transform.
struct PlacedNode {
    const MeshNode* node = nullptr;
    Affine model_from_mesh{};
};

/// A child's result whose every count and reference was checked.
class PlacedScene {
public:
    /// `file` and `bytes` must outlive the object. The bytes must have an outcome of `read`. Fails
    /// with `unreadable` on any inconsistency in them.
    [[nodiscard]] static Result<PlacedScene> make(const SourceFile& file,
                                                  std::span<const std::byte> bytes);
    PlacedScene(PlacedScene&&) noexcept;
    PlacedScene& operator=(PlacedScene&&) noexcept;
    ~PlacedScene();

    /// Makes a soup of all nodes, depth first. Applies their transforms in double and reverses
    /// faces under mirroring transforms. Meshes without triangles leave no instance. A soup is
    /// single precision if every used transform is the identity and every used mesh is single
    /// precision.
    [[nodiscard]] Result<mesh::TriangleSoup> flatten(const ImportOptions& options) const;
    /// Does the same for the meshes of some nodes, with other transforms.
    [[nodiscard]] Result<mesh::TriangleSoup> flatten_nodes(std::span<const PlacedNode> nodes,
                                                           const ImportOptions& options) const;
    /// Returns the nodes that have triangles, depth first.
    [[nodiscard]] std::vector<MeshNode> mesh_nodes() const;
    /// Returns the path of a node, by MeshNode::number: "root/arm/hand".
    [[nodiscard]] std::string path_of(std::uint32_t number) const;
    /// The world transforms of all nodes, depth first: element MeshNode::number is of that node.
    [[nodiscard]] std::span<const Affine> world_from_nodes() const noexcept;

private:
    class Content;
    explicit PlacedScene(std::unique_ptr<const Content> content) noexcept;
    std::unique_ptr<const Content> content_;
};

/// Returns the header if `bytes` begin with one and have exactly the length that its counts give.
[[nodiscard]] std::optional<SceneHeader> read_scene_header(
    std::span<const std::byte> bytes) noexcept;

/// Returns PlacedScene::flatten() of a child's result.
[[nodiscard]] Result<mesh::TriangleSoup> flatten_scene(const SourceFile& file,
                                                       std::span<const std::byte> bytes,
                                                       const ImportOptions& options);

}  // namespace cdprep::import
