// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "write/hulls_text.h"
#include "write/mesh_bytes.h"

namespace cdprep::write {
namespace {

using format::Double3;
using Json = nlohmann::ordered_json;

/// The glTF document and its binary chunk.
struct Glb {
    Json document = {{"asset", {{"version", "2.0"}, {"generator", "cdprep"}}}};
    std::string binary;
};

/// Appends an element to a list of the document and returns its index.
std::size_t append(Json& document, const char* list, Json element) {
    document[list].push_back(std::move(element));
    return document[list].size() - 1;
}

/// Adds a view of the binary chunk from `begin` to its end, and an accessor for the whole view.
std::size_t add_accessor(Glb& glb, std::size_t begin, int target, Json accessor) {
    accessor["bufferView"] = append(glb.document, "bufferViews",
                                    {{"buffer", 0},
                                     {"byteOffset", begin},
                                     {"byteLength", glb.binary.size() - begin},
                                     {"target", target}});
    return append(glb.document, "accessors", std::move(accessor));
}

/// Returns the bounds of the written floats, which glTF requires.
std::array<Json, 2> bounds_of(std::span<const Double3> points) {
    std::array<Json, 2> bounds = {Json::array(), Json::array()};
    for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
        const auto [least, greatest] = std::minmax_element(
            points.begin(), points.end(),
            [&](const Double3& a, const Double3& b) { return a.*axis < b.*axis; });
        bounds[0].push_back(static_cast<float>((*least).*axis));
        bounds[1].push_back(static_cast<float>((*greatest).*axis));
    }
    return bounds;
}

std::size_t add_positions(Glb& glb, std::span<const Double3> points) {
    constexpr int kFloat = 5126;
    constexpr int kArrayBuffer = 34962;
    const std::size_t begin = glb.binary.size();
    for (const Double3& p : points) append_point(glb.binary, p, true);
    const auto [least, greatest] = bounds_of(points);
    return add_accessor(glb, begin, kArrayBuffer,
                        {{"componentType", kFloat},
                         {"count", points.size()},
                         {"type", "VEC3"},
                         {"min", least},
                         {"max", greatest}});
}

using Facet = std::array<std::uint32_t, 3>;

const Facet& corners_of(const Facet& facet) {
    return facet;
}

const Facet& corners_of(const format::Triangle& triangle) {
    return triangle.vertex;
}

template <class Triangles>
std::size_t add_indices(Glb& glb, const Triangles& triangles) {
    constexpr int kUnsignedInt = 5125;
    constexpr int kElementArrayBuffer = 34963;
    const std::size_t begin = glb.binary.size();
    for (const auto& triangle : triangles) {
        for (const std::uint32_t vertex : corners_of(triangle)) append_bytes(glb.binary, vertex);
    }
    return add_accessor(
        glb, begin, kElementArrayBuffer,
        {{"componentType", kUnsignedInt}, {"count", 3 * triangles.size()}, {"type", "SCALAR"}});
}

/// Adds a node with a mesh and returns its index. Without triangles, the mesh has points.
template <class Triangles>
std::size_t add_node(Glb& glb, const std::string& name, std::span<const Double3> points,
                     const Triangles& triangles) {
    constexpr int kPoints = 0;
    Json primitive = {{"attributes", {{"POSITION", add_positions(glb, points)}}}};
    if (triangles.empty()) {
        primitive["mode"] = kPoints;
    } else {
        primitive["indices"] = add_indices(glb, triangles);
    }
    const std::size_t mesh =
        append(glb.document, "meshes",
               {{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
    return append(glb.document, "nodes", {{"name", name}, {"mesh", mesh}});
}

/// Returns the power of two that makes a hull at least 1 and less than 2 large, but at most 1.
/// Unity cooks a mesh before its node scales it, and PhysX drops points of smaller hulls by an
/// absolute height: 0.0007. The size is half the sum of the sides of the box.
double node_scale(std::span<const Double3> points) {
    if (points.empty()) return 1;
    Double3 lower = points.front(), upper = lower;
    for (const Double3& p : points) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    const double size = (upper.x - lower.x) / 2 + (upper.y - lower.y) / 2 + (upper.z - lower.z) / 2;
    return size > 0 ? std::min(1.0, std::ldexp(1.0, std::ilogb(size))) : 1;
}

/// Adds a node whose mesh is written larger where node_scale() is less than 1.
std::size_t add_scaled_node(Glb& glb, const HullArrays& hull) {
    const double scale = node_scale(hull.points);
    std::vector<Double3> points;
    for (const Double3& p : hull.points) points.push_back({p.x / scale, p.y / scale, p.z / scale});
    const std::size_t node = add_node(glb, hull.name, points, hull.facets);
    if (scale < 1) glb.document["nodes"][node]["scale"] = Json::array({scale, scale, scale});
    return node;
}

/// Adds the shown mesh, then the hulls, which may have a node above them.
void add_nodes(Glb& glb, const RobotFile& file) {
    std::vector<std::size_t> roots;
    // glTF requires points.
    if (file.options.visual && !file.options.visual->positions.empty()) {
        const MeshArrays& shown = *file.options.visual;
        roots.push_back(add_node(glb, file.name, shown.positions, shown.triangles));
    }
    std::vector<std::size_t> hulls;
    for (const HullArrays& hull : file.hulls) {
        hulls.push_back(file.options.stores_hulls_large
                            ? add_scaled_node(glb, hull)
                            : add_node(glb, hull.name, hull.points, hull.facets));
    }
    if (!hulls.empty() && !file.options.hulls_node.empty()) {
        hulls = {append(glb.document, "nodes",
                        {{"name", file.options.hulls_node}, {"children", hulls}})};
    }
    roots.insert(roots.end(), hulls.begin(), hulls.end());
    if (!roots.empty()) glb.document["scenes"][0]["nodes"] = roots;
}

void append_chunk(std::string& bytes, std::string chunk, std::uint32_t type, char padding) {
    while (chunk.size() % 4 != 0) chunk += padding;
    append_bytes(bytes, static_cast<std::uint32_t>(chunk.size()));
    append_bytes(bytes, type);
    bytes += chunk;
}

}  // namespace

std::string glb_bytes(const RobotFile& file) {
    constexpr std::uint32_t kMagic = 0x46546C67;
    constexpr std::uint32_t kJson = 0x4E4F534A;
    constexpr std::uint32_t kBinary = 0x004E4942;
    Glb glb;
    glb.document["scene"] = 0;
    glb.document["scenes"] = Json::array({Json::object()});
    add_nodes(glb, file);
    if (!glb.binary.empty()) {
        glb.document["buffers"] = Json::array({{{"byteLength", glb.binary.size()}}});
    }
    std::string chunks;
    append_chunk(chunks, glb.document.dump(), kJson, ' ');
    if (!glb.binary.empty()) append_chunk(chunks, glb.binary, kBinary, '\0');
    std::string bytes;
    append_bytes(bytes, kMagic);
    append_bytes(bytes, std::uint32_t{2});
    append_bytes(bytes, static_cast<std::uint32_t>(chunks.size() + 12));
    return bytes + chunks;
}

}  // namespace cdprep::write
