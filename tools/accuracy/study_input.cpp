// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/study_input.h"

#include <array>
#include <fstream>

#include "cdprep/format/file_header.h"
#include "cli/open_for.h"
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

Result<mesh::Mesh> load_for_study(const std::filesystem::path& input, const LoadOptions& options,
                                  Progress& progress) {
    const bool is_mesh_file = !is_baked(input);
    progress.show(0, input.filename().string() + ": read");
    if (is_mesh_file) return load_mesh(input, options);
    if (options.normalize || options.weld_distance > 0) {
        return Error{ErrorCode::bad_argument,
                     input.string() +
                         ": is a baked file; --normalize and --weld apply to mesh files. Remove "
                         "them, or give the mesh file."};
    }
    const Result<Model> model = open_for(input, Ask::corners);
    if (!model) return model.error();
    return study::mesh_of(model.value());
}

}  // namespace cdprep::cli
