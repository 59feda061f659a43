// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/format/file_header.h"
#include "cdprep/result.h"
#include "write/hulls_file.h"

namespace cdprep::cli {

enum class Engine : std::uint8_t { godot, unreal, unity, mujoco, gazebo, urdf, json };

/// The form of the file that an engine reads.
struct EngineForm {
    Engine engine = Engine::json;
    const char* name = "";                             ///< as in --for
    std::span<const char* const> extensions;           ///< of the file; the first is the default
    std::optional<write::HullsFormat> format = {};     ///< nothing: the JSON of colliders_json()
    format::UpAxis up_axis = format::UpAxis::unknown;  ///< of the file; unknown: the model's
    bool has_mass = false;                             ///< takes --density
    bool can_omit_visual = false;  ///< takes --no-visual; Unreal attaches parts to the visual mesh
    const char* name_before = "";  ///< of a part: before the name of the model
    const char* name_after = "";   ///< and after its number
    const char* parts_node = "";   ///< the node above the parts; "": none
    bool stores_parts_large = false;  ///< as HullsFileOptions::stores_hulls_large
    /// The size that a smaller part counts as in ignored_height(), in metres. 0: its own. Unreal's
    /// unit is the centimetre. Unity's parts are stored as large as PhysX needs.
    double least_size = 0;
};

/// Returns the forms of all engines.
[[nodiscard]] std::span<const EngineForm> engine_forms() noexcept;

/// Returns the form of an engine with this name, or null.
[[nodiscard]] const EngineForm* find_engine(std::string_view name) noexcept;

/// Returns the names of all engines.
[[nodiscard]] std::vector<std::string> engine_names();

/// Returns true if the file is in metres. JSON states the unit instead.
[[nodiscard]] inline bool is_in_metres(const EngineForm& form) noexcept {
    return form.format.has_value();
}

/// Returns the name of a part, of `count` parts. Numbers have as many digits as the last one, and
/// at least two: "UCX_bolt_00". A URDF or SDF has "collider_00", because the names of its mesh
/// files begin with that of the model.
[[nodiscard]] std::string part_name(const EngineForm& form, const std::string& model,
                                    std::size_t number, std::size_t count);

/// Returns the name of the model in an output of output_for(): that of the output, or for "-" that
/// of the input. It consists of letters, digits, '_', '-' and '.'.
[[nodiscard]] std::string exported_name(const std::filesystem::path& input,
                                        const std::filesystem::path& output);

/// Returns the output of an export: `wanted`; in the folder `wanted`, a file with the name of
/// `input`; or, if `wanted` is empty, such a file beside `input`. Fails with `bad_argument` for
/// another extension, and if the output is the input. Also fails if a file beside the input exists
/// that no argument names: it may be the source of the model.
[[nodiscard]] Result<std::filesystem::path> output_for(const EngineForm& form,
                                                       const std::filesystem::path& input,
                                                       const std::filesystem::path& wanted);

}  // namespace cdprep::cli
