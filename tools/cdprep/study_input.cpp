// SPDX-License-Identifier: GPL-3.0-or-later
#include "study_input.h"

#include <array>
#include <fstream>

#include "cdprep/format/file_header.h"
#include "open_for.h"
#include "study/memory_model.h"

namespace cdprep::cli {
namespace {

bool is_baked(const std::filesystem::path& input) {
    std::ifstream file(input, std::ios::binary);
    std::array<char, format::kMagic.size()> begin{};
    file.read(begin.data(), begin.size());
    return file && begin == format::kMagic;
}

}  // namespace

Result<mesh::Mesh> load_for_study(const std::filesystem::path& input, const LoadOptions& options) {
    if (!is_baked(input)) return load_mesh(input, options);
    if (options.normalize || options.weld_distance > 0) {
        return Error{ErrorCode::bad_argument,
                     input.string() +
                         ": is baked already; --normalize and --weld are for mesh files. Leave "
                         "them out, or give the mesh file."};
    }
    const Result<Model> opened =
        open_for(input, {SectionId::triangles, SectionId::source_triangle});
    if (!opened) return opened.error();
    // Which of the two positions a file has is not known before.
    const Result<Model> model = Model::open(
        input, {SectionId::triangles, SectionId::source_triangle, SectionId::source_vertex,
                SectionId::positions_f32, SectionId::positions_f64});
    if (!model) return model.error();
    const bool has_positions =
        !model.value().positions_f32().empty() || !model.value().positions_f64().empty();
    if (!has_positions && model.value().vertex_count() > 0) {
        return Error{ErrorCode::bad_argument,
                     input.string() + ": was baked without positions. Bake it again."};
    }
    return study::mesh_of(model.value());
}

}  // namespace cdprep::cli
