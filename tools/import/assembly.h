// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "import/flatten_scene.h"
#include "import/import_file.h"

namespace cdprep::import {

/// A mesh file whose nodes stay apart, each with its place in the world. Read once.
class Assembly {
public:
    /// Reads a file of a format with nodes, in a child process, as import_file() does. Fails as
    /// that does. Also fails if no node has triangles.
    [[nodiscard]] static Result<Assembly> open(const std::filesystem::path& path,
                                               const ImportOptions& options);
    Assembly(Assembly&&) noexcept;
    Assembly& operator=(Assembly&&) noexcept;
    ~Assembly();

    /// The nodes that have triangles, depth first.
    [[nodiscard]] std::span<const MeshNode> nodes() const noexcept;
    /// The world transforms of all nodes, depth first: element MeshNode::number is of that node.
    [[nodiscard]] std::span<const Affine> world_from_nodes() const noexcept;
    /// Returns the path of a node, by its number: "root/arm".
    [[nodiscard]] std::string path_of(std::uint32_t number) const;
    /// The files that it refers to and that were read, by name.
    [[nodiscard]] std::span<const mesh::InputFile> other_files() const noexcept;
    /// Returns the triangles of some nodes, one node after the other. Invalid numbers are data, as
    /// in import_file().
    [[nodiscard]] Result<mesh::TriangleSoup> triangles(std::span<const PlacedNode> nodes) const;

private:
    struct Content;
    explicit Assembly(std::unique_ptr<const Content> content) noexcept;
    std::unique_ptr<const Content> content_;
};

}  // namespace cdprep::import
