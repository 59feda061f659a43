// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/mesh_endings.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace cdprep::import {
namespace {

constexpr std::array<std::string_view, 39> kEndings = {
    ".obj",     ".stl", ".ply",  ".off", ".gltf", ".glb",   ".fbx",  ".dae", ".zae", ".3ds",
    ".3mf",     ".ac",  ".ac3d", ".ase", ".amf",  ".b3d",   ".cob",  ".dxf", ".ifc", ".irrmesh",
    ".lwo",     ".lws", ".md2",  ".md3", ".ms3d", ".nff",   ".ogex", ".pmx", ".q3d", ".q3o",
    ".md5mesh", ".smd", ".x",    ".x3d", ".xgl",  ".blend", ".irr",  ".iqm", ".lxo"};

}  // namespace

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension;
}

bool has_mesh_ending(const std::filesystem::path& path) {
    const std::string ending = lower_extension(path);
    return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace cdprep::import
