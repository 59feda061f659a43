// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/file_kind.h"

#include <algorithm>
#include <array>

#include "cdprep/format/file_header.h"
#include "import/mesh_endings.h"

namespace cdprep::import {
namespace {

constexpr std::string_view kHdf5Magic = "\x89HDF\r\n\x1a\n";
constexpr std::string_view kExportInstead =
    ", which is not supported. Export the mesh as glTF, OBJ, STL or PLY";

struct Kind {
    std::string_view start;   ///< of the bytes; empty: none
    std::string_view ending;  ///< of the name; empty: none
    std::string_view name;
};

constexpr std::array<Kind, 7> kUnread = {{{"PXR-USDC", ".usdc", "a USD scene"},
                                          {"#usda", ".usda", "a USD scene"},
                                          {"", ".usd", "a USD scene"},
                                          {"", ".usdz", "a USD scene"},
                                          {"#VRML", ".wrl", "a VRML scene"},
                                          {"", ".iges", "an IGES file"},
                                          {"", ".igs", "an IGES file"}}};

/// Returns true if `bytes` begin with `text`, in upper or lower case. `text` is in lower case.
bool starts_with_any_case(std::string_view bytes, std::string_view text) {
    return bytes.size() >= text.size() &&
           std::equal(text.begin(), text.end(), bytes.begin(), [](char wanted, char c) {
               return wanted == (c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c);
           });
}

bool is_web_page(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    bytes.remove_prefix(std::min(first, bytes.size()));
    return starts_with_any_case(bytes, "<!doctype html") || starts_with_any_case(bytes, "<html");
}

bool is_baked(std::string_view bytes) {
    const std::string_view after_header =
        bytes.substr(std::min<std::size_t>(bytes.size(), format::kUserBlockSize));
    return after_header.starts_with(kHdf5Magic);
}

}  // namespace

std::optional<std::string> find_other_kind(std::string_view bytes,
                                           const std::filesystem::path& path) {
    if (bytes.starts_with("version https://git-lfs.github.com/spec/")) {
        return "is a pointer of Git LFS, not the mesh. Fetch the mesh with 'git lfs pull'";
    }
    if (is_web_page(bytes)) return "is a web page, not a mesh. Download the file itself";
    if (is_baked(bytes)) return "is a baked model. Give the mesh file that it was baked from";
    if (bytes.starts_with(kHdf5Magic)) return "is an HDF5 file" + std::string(kExportInstead);
    const std::string ending = lower_extension(path);
    for (const Kind& kind : kUnread) {
        if ((!kind.start.empty() && bytes.starts_with(kind.start)) || ending == kind.ending) {
            return "is " + std::string(kind.name) + std::string(kExportInstead);
        }
    }
    return std::nullopt;
}

}  // namespace cdprep::import
