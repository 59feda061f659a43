// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/open_for.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include "import/mesh_endings.h"
#include "text/space_name.h"

namespace cdprep::cli {

Error baked_first(const std::filesystem::path& path, Error why) {
    std::error_code unknown;
    const bool is_mesh =
        import::has_mesh_ending(path) && std::filesystem::is_regular_file(path, unknown);
    if (why.code != ErrorCode::unreadable || !is_mesh) return why;
    const std::string name = path.string();
    return {why.code, name +
                          ": is a mesh file, not a baked model. Bake it first with 'cdprep bake " +
                          name + "'."};
}

Result<Model> open_for(const std::filesystem::path& path, Ask asks, Structure through) {
    Result<Model> opened = Model::open(path, asks | ask_of(through));
    if (!opened) return baked_first(path, opened.error());
    return opened;
}

double unit_of(const Model& model) {
    const bool is_normalized = (model.header().flags & format::model_normalized) != 0;
    return is_normalized ? 0 : model.header().metres_per_unit;
}

bool are_unlike_units(double unit_a, double unit_b) noexcept {
    constexpr double kRounding = 1e-6;  // a float is right up to 6e-8
    if (unit_a == 0 || unit_b == 0) return false;
    return std::fabs(unit_a - unit_b) > kRounding * std::max(unit_a, unit_b);
}

std::optional<Error> find_unlike_units(const std::filesystem::path& path_a, double unit_a,
                                       const std::filesystem::path& path_b, double unit_b) {
    if (!are_unlike_units(unit_a, unit_b)) return std::nullopt;
    return Error{ErrorCode::bad_argument, path_a.string() + " is in " + report::unit_name(unit_a) +
                                              ", but " + path_b.string() + " is in " +
                                              report::unit_name(unit_b) +
                                              ". Convert one mesh, or bake both with one --unit."};
}

std::optional<Error> find_unlike_units(const std::filesystem::path& path_a, const Model& a,
                                       const std::filesystem::path& path_b, const Model& b) {
    return find_unlike_units(path_a, unit_of(a), path_b, unit_of(b));
}

}  // namespace cdprep::cli
