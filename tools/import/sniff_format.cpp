// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/file_kind.h"

#include "import/mesh_endings.h"
#include "import/readers.h"
#include "import/text_chunks.h"

namespace cdprep::import {
namespace {

/// Returns true if the bytes begin with the magic of GLB or binary FBX, which no other format has.
bool has_scene_magic(std::string_view bytes) {
    return bytes.starts_with("glTF") || bytes.starts_with("Kaydara FBX Binary");
}

bool has_ply_magic(std::string_view bytes) {
    bytes = without_byte_order_mark(bytes);
    return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

/// Returns true if the bytes look like JSON or XML.
bool is_document(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first < bytes.size() && (bytes[first] == '{' || bytes[first] == '<');
}

}  // namespace

MeshFormat sniff_format(std::string_view bytes, const std::filesystem::path& path) {
    if (has_scene_magic(bytes)) return MeshFormat::other;
    if (has_ply_magic(bytes)) return MeshFormat::ply;
    const std::string extension = lower_extension(path);
    if (extension == ".stl") return MeshFormat::stl;
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".off") return MeshFormat::off;
    if (extension == ".obj") return MeshFormat::obj;
    if (has_mesh_ending(path) || is_document(bytes)) return MeshFormat::other;
    if (is_binary_stl(bytes) || looks_like_text_stl(bytes)) return MeshFormat::stl;
    if (looks_like_off(bytes)) return MeshFormat::off;
    return looks_like_obj(bytes) ? MeshFormat::obj : MeshFormat::other;
}

}  // namespace cdprep::import
