// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_path.h"

#include <system_error>

namespace cdprep::cli {

std::optional<Error> find_replaced_input(const std::filesystem::path& input,
                                         const std::filesystem::path& output) {
    std::error_code unknown;  // not there: not the same
    if (!std::filesystem::equivalent(input, output, unknown)) return std::nullopt;
    return Error{ErrorCode::bad_argument,
                 output.string() + ": is the input and would be replaced. Choose another output."};
}

Result<write::MeshFormat> mesh_output(const std::filesystem::path& input,
                                      const std::filesystem::path& output) {
    if (const auto error = find_replaced_input(input, output)) return *error;
    if (const auto format = write::mesh_format_of(output)) return *format;
    return Error{ErrorCode::bad_argument,
                 output.string() +
                     ": the extension names no format that can be written; it must be .obj, "
                     ".ply, .stl or .off."};
}

}  // namespace cdprep::cli
