// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/sniff_format.h"

#include <algorithm>

#include "import/read_obj.h"
#include "import/read_off.h"
#include "import/read_stl.h"

namespace cdprep::import {
namespace {

bool is_scene(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return bytes.starts_with("glTF") || bytes.starts_with("Kaydara FBX Binary") ||
           (first < bytes.size() && (bytes[first] == '{' || bytes[first] == '<'));
}

}  // namespace

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension;
}

MeshFormat sniff_format(std::string_view bytes, const std::filesystem::path& path) {
    constexpr std::size_t kPlyMagic = 4;
    if (is_scene(bytes)) return MeshFormat::other;
    if (bytes.starts_with("ply") && bytes.size() >= kPlyMagic &&
        (bytes[3] == '\n' || bytes[3] == '\r')) {
        return MeshFormat::ply;
    }
    if (is_binary_stl(bytes) || looks_like_text_stl(bytes)) return MeshFormat::stl;
    if (looks_like_off(bytes)) return MeshFormat::off;
    if (looks_like_obj(bytes)) return MeshFormat::obj;
    const std::string extension = lower_extension(path);
    if (extension == ".stl") return MeshFormat::stl;
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".off") return MeshFormat::off;
    return extension == ".obj" ? MeshFormat::obj : MeshFormat::other;
}

}  // namespace cdprep::import
