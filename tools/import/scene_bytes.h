// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

namespace cdprep::import {

/// The result of the importing child for its parent: one SceneHeader, then arrays
/// without gaps in the order of its counts. The parent trusts none of it.
///
/// Both sides come from one build on one machine, so there is no byte order and no version.

inline constexpr std::array<char, 8> kSceneMagic = {'C', 'D', 'P', 'S', 'C', 'E', 'N', 'E'};

/// The outcome of the child. Only `read` has arrays; the others have a text.
enum class SceneOutcome : std::uint32_t {
    read = 1,
    unreadable = 2,     ///< the text gives the reason
    out_of_memory = 3,  ///< the limit was reached
};

struct SceneHeader {
    std::array<char, 8> magic;  ///< kSceneMagic
    SceneOutcome outcome;
    std::uint32_t up_axis;      ///< format::UpAxis
    double metres_per_unit;     ///< 0: the file has no unit
    std::uint64_t input_bytes;  ///< of all files opened
    /// Meshes with a skin or morph weights that were not applied.
    std::uint64_t unposed_meshes;
    /// Vertices with a skin whose joint weights are all 0. They follow their first joint.
    std::uint64_t weightless_vertices;
    // Arrays follow, in this order:
    std::uint64_t mesh_count;       ///< SceneMesh
    std::uint64_t node_count;       ///< SceneNode, parents before children, depth first
    std::uint64_t node_mesh_count;  ///< uint32: mesh numbers, of one node after the other
    std::uint64_t material_count;   ///< uint32: bytes of each name
    std::uint64_t vertex_count;     ///< three doubles, of one mesh after the other
    std::uint64_t face_count;       ///< uint32: corners of each face
    std::uint64_t corner_count;     ///< uint32: vertices of the mesh, from 0
    std::uint64_t file_count;       ///< uint32: bytes of the name of each file but the first
    std::uint64_t text_bytes;       ///< names of nodes, materials, files; or the message
};

struct SceneMesh {
    std::uint64_t vertex_count;
    std::uint64_t face_count;
    std::uint64_t corner_count;
    std::uint32_t material;
    std::uint32_t is_single;  ///< 1: every coordinate is a float without loss
};

/// Returns the memory limit for a file of `input_bytes` bytes. Text formats through assimp stay
/// below a hundred times their size. A file that requires more states false sizes.
[[nodiscard]] constexpr std::uint64_t honest_memory(std::uint64_t input_bytes) noexcept {
    constexpr std::uint64_t kProgram = std::uint64_t{512} << 20;
    constexpr std::uint64_t kRatio = 200;
    return kProgram + kRatio * input_bytes;
}

inline constexpr std::uint32_t kNoParent = 0xffffffff;

struct SceneNode {
    std::array<double, 16> parent_from_node;  ///< row by row
    std::uint32_t parent;                     ///< kNoParent for the root
    std::uint32_t mesh_count;
    std::uint32_t name_bytes;
    std::uint32_t is_posed;  ///< 1: its meshes are in the model's space, placed by a skin
};

static_assert(sizeof(SceneHeader) == 120 && std::is_trivially_copyable_v<SceneHeader>);
static_assert(sizeof(SceneMesh) == 32 && std::is_trivially_copyable_v<SceneMesh>);
static_assert(sizeof(SceneNode) == 144 && std::is_trivially_copyable_v<SceneNode>);

}  // namespace cdprep::import
