// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/engine.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include "cli/output_path.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using format::UpAxis;
using write::HullsFormat;

constexpr std::array kGlb = {".glb"};
constexpr std::array kMjcf = {".xml", ".mjcf"};
constexpr std::array kSdf = {".sdf"};
constexpr std::array kUrdf = {".urdf"};
constexpr std::array kJson = {".json"};

// Names: glTF import of Godot, naming convention of Unreal's static mesh import.
constexpr std::array<EngineForm, 7> kForms = {{
    {.engine = Engine::godot,
     .name = "godot",
     .extensions = kGlb,
     .format = HullsFormat::glb,
     .up_axis = UpAxis::y,
     .can_omit_visual = true,
     .name_after = "-convcolonly"},
    {.engine = Engine::unreal,
     .name = "unreal",
     .extensions = kGlb,
     .format = HullsFormat::glb,
     .up_axis = UpAxis::y,
     .name_before = "UCX_",
     .least_size = 0.01},
    {.engine = Engine::unity,
     .name = "unity",
     .extensions = kGlb,
     .format = HullsFormat::glb,
     .up_axis = UpAxis::y,
     .can_omit_visual = true,
     .parts_node = "colliders",
     .stores_parts_large = true},
    {.engine = Engine::mujoco,
     .name = "mujoco",
     .extensions = kMjcf,
     .format = HullsFormat::mjcf,
     .up_axis = UpAxis::z,
     .has_mass = true,
     .can_omit_visual = true},
    {.engine = Engine::gazebo,
     .name = "gazebo",
     .extensions = kSdf,
     .format = HullsFormat::sdf,
     .up_axis = UpAxis::z,
     .has_mass = true,
     .can_omit_visual = true},
    {.engine = Engine::urdf,
     .name = "urdf",
     .extensions = kUrdf,
     .format = HullsFormat::urdf,
     .up_axis = UpAxis::z,
     .has_mass = true,
     .can_omit_visual = true},
    {.engine = Engine::json, .name = "json", .extensions = kJson},
}};

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Returns ".xml or .mjcf".
std::string listed(std::span<const char* const> extensions) {
    std::string text;
    for (const char* extension : extensions) {
        text += (text.empty() ? "" : " or ") + std::string(extension);
    }
    return text;
}

/// Returns the name of a baked file without ".cdp.h5", or without another extension.
std::string name_of(const fs::path& input) {
    constexpr std::string_view kEnding = ".cdp.h5";
    std::string name = input.filename().string();
    if (name.size() > kEnding.size() && lower_case(name).ends_with(kEnding)) {
        name.resize(name.size() - kEnding.size());
        return name;
    }
    return input.stem().string();
}

}  // namespace

std::span<const EngineForm> engine_forms() noexcept {
    return kForms;
}

const EngineForm* find_engine(std::string_view name) noexcept {
    const auto* at = std::find_if(kForms.begin(), kForms.end(),
                                  [&](const EngineForm& form) { return form.name == name; });
    return at == kForms.end() ? nullptr : at;
}

std::vector<std::string> engine_names() {
    std::vector<std::string> names;
    names.reserve(kForms.size());
    for (const EngineForm& form : kForms) names.emplace_back(form.name);
    return names;
}

std::string part_name(const EngineForm& form, const std::string& model, std::size_t number,
                      std::size_t count) {
    const std::size_t digits =
        std::max<std::size_t>(2, std::to_string(count > 0 ? count - 1 : 0).size());
    std::string text = std::to_string(number);
    text.insert(0, digits - std::min(digits, text.size()), '0');
    const bool has_files = form.format && write::has_mesh_files(*form.format);
    if (has_files) return "collider_" + text;
    return form.name_before + model + "_" + text + form.name_after;
}

std::string exported_name(const fs::path& input, const fs::path& output) {
    // An extension, because model_name() takes one off.
    return write::model_name(output == "-" ? fs::path(name_of(input) + ".json") : output);
}

Result<fs::path> output_for(const EngineForm& form, const fs::path& input, const fs::path& wanted) {
    if (wanted == "-" && form.engine == Engine::json) return wanted;
    std::error_code unknown;
    const fs::path beside = input.has_parent_path() ? input.parent_path() : ".";
    const bool is_folder = fs::is_directory(wanted, unknown);
    if (wanted.empty() || is_folder) {
        const fs::path name = name_of(input) + form.extensions.front();
        const fs::path output = is_folder ? wanted / name : input.parent_path() / name;
        const bool is_beside = !is_folder || fs::equivalent(wanted, beside, unknown);
        if (!is_beside || !fs::exists(output, unknown)) return output;
        return Error{ErrorCode::bad_argument,
                     output.string() +
                         ": exists, and may be the source of the model. Name it with -o to "
                         "replace it, or name another output."};
    }
    if (auto error = find_replaced_input(input, wanted)) return *error;
    const std::string extension = lower_case(wanted.extension().string());
    const bool is_known = std::any_of(form.extensions.begin(), form.extensions.end(),
                                      [&](const char* known) { return extension == known; });
    if (is_known) return wanted;
    return Error{ErrorCode::bad_argument, wanted.string() + ": the file for " + form.name +
                                              " must end in " + listed(form.extensions) + "."};
}

}  // namespace cdprep::cli
