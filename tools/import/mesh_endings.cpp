// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/mesh_endings.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "import/sniff_format.h"

namespace cdprep::import {
namespace {

constexpr std::array<std::string_view, 36> kEndings = {
    ".obj", ".stl",     ".ply", ".off",     ".gltf", ".glb", ".fbx",  ".dae", ".zae",
    ".3ds", ".3mf",     ".ac",  ".ac3d",    ".ase",  ".amf", ".b3d",  ".cob", ".dxf",
    ".ifc", ".irrmesh", ".lwo", ".lws",     ".md2",  ".md3", ".ms3d", ".nff", ".ogex",
    ".pmx", ".q3d",     ".q3o", ".md5mesh", ".smd",  ".x",   ".x3d",  ".xgl", ".blend"};

}  // namespace

bool has_mesh_ending(const std::filesystem::path& path) {
    const std::string ending = lower_extension(path);
    return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace cdprep::import
