// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/open_for.h"

#include <string>
#include <system_error>

#include "import/mesh_endings.h"

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

}  // namespace cdprep::cli
