// SPDX-License-Identifier: GPL-3.0-or-later
#include "open_for.h"

#include <string>

#include "effects.h"

namespace cdprep::cli {

Result<Model> open_for(const std::filesystem::path& path, SectionSet needed) {
    Result<Model> opened = Model::open(path, needed);
    if (!opened) return opened;
    const std::string missing = missing_sections(needed, opened.value().sections());
    if (missing.empty()) return opened;
    return Error{ErrorCode::bad_argument,
                 path.string() + ": was baked without what this question needs: " + missing +
                     ". Bake it again with the effect asked for (--effects)."};
}

}  // namespace cdprep::cli
