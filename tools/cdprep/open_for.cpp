// SPDX-License-Identifier: GPL-3.0-or-later
#include "open_for.h"

#include <string>

#include "effects.h"
#include "report/structure_name.h"

namespace cdprep::cli {

Result<Model> open_for(const std::filesystem::path& path, SectionSet needed, Structure through) {
    SectionSet wanted = needed;
    wanted.insert(sections_of(through));
    wanted.insert(more_sections_of(through));
    Result<Model> opened = Model::open(path, wanted);
    if (!opened) return opened;
    const SectionSet present = opened.value().sections();
    const std::string missing = missing_sections(needed, present);
    if (!missing.empty()) {
        return Error{ErrorCode::bad_argument,
                     path.string() + ": was baked without what this question needs: " + missing +
                         ". Bake it again with the effect asked for (--effects)."};
    }
    const std::string parts = missing_parts(sections_of(through), present);
    if (parts.empty()) return opened;
    const std::string option = through == Structure::pieces ? "--effects " : "--structures ";
    return Error{ErrorCode::bad_argument, path.string() + ": was baked without what --structure " +
                                              report::structure_name(through) + " needs: " + parts +
                                              ". Bake it again with " + option +
                                              report::baked_name(through) + "."};
}

}  // namespace cdprep::cli
