// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

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
std::array<Json, 2> bounds_of(const HullArrays& hull) {
    std::array<Json, 2> bounds = {Json::array(), Json::array()};
    for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
        const auto [least, greatest] = std::minmax_element(
            hull.points.begin(), hull.points.end(),
            [&](const Double3& a, const Double3& b) { return a.*axis < b.*axis; });
        bounds[0].push_back(static_cast<float>((*least).*axis));
        bounds[1].push_back(static_cast<float>((*greatest).*axis));
    }
    return bounds;
}

std::size_t add_positions(Glb& glb, const HullArrays& hull) {
    constexpr int kFloat = 5126;
    constexpr int kArrayBuffer = 34962;
    const std::size_t begin = glb.binary.size();
    for (const Double3& p : hull.points) append_point(glb.binary, p, true);
    const auto [least, greatest] = bounds_of(hull);
    return add_accessor(glb, begin, kArrayBuffer,
                        {{"componentType", kFloat},
                         {"count", hull.points.size()},
                         {"type", "VEC3"},
                         {"min", least},
                         {"max", greatest}});
}

std::size_t add_indices(Glb& glb, const HullArrays& hull) {
    constexpr int kUnsignedInt = 5125;
    constexpr int kElementArrayBuffer = 34963;
    const std::size_t begin = glb.binary.size();
    for (const auto& facet : hull.facets) {
        for (const std::uint32_t vertex : facet) append_bytes(glb.binary, vertex);
    }
    return add_accessor(
        glb, begin, kElementArrayBuffer,
        {{"componentType", kUnsignedInt}, {"count", 3 * hull.facets.size()}, {"type", "SCALAR"}});
}

/// Adds a node with a mesh. A hull without facets becomes points.
void add_node(Glb& glb, const HullArrays& hull) {
    constexpr int kPoints = 0;
    Json primitive = {{"attributes", {{"POSITION", add_positions(glb, hull)}}}};
    if (hull.facets.empty()) {
        primitive["mode"] = kPoints;
    } else {
        primitive["indices"] = add_indices(glb, hull);
    }
    const std::size_t mesh =
        append(glb.document, "meshes",
               {{"name", hull.name}, {"primitives", Json::array({std::move(primitive)})}});
    const std::size_t node = append(glb.document, "nodes", {{"name", hull.name}, {"mesh", mesh}});
    glb.document["scenes"][0]["nodes"].push_back(node);
}

void append_chunk(std::string& bytes, std::string chunk, std::uint32_t type, char padding) {
    while (chunk.size() % 4 != 0) chunk += padding;
    append_bytes(bytes, static_cast<std::uint32_t>(chunk.size()));
    append_bytes(bytes, type);
    bytes += chunk;
}

}  // namespace

std::string glb_bytes(std::span<const HullArrays> hulls) {
    constexpr std::uint32_t kMagic = 0x46546C67;
    constexpr std::uint32_t kJson = 0x4E4F534A;
    constexpr std::uint32_t kBinary = 0x004E4942;
    Glb glb;
    glb.document["scene"] = 0;
    glb.document["scenes"] = Json::array({Json::object()});
    for (const HullArrays& hull : hulls) add_node(glb, hull);
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
