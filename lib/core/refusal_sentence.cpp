// SPDX-License-Identifier: MIT
#include "core/refusal_sentence.h"

#include <cassert>

#include "cdprep/format/sections.h"

namespace cdprep {
namespace {

using format::SectionId;
using format::SectionSet;

/// Either kind of positions is enough, so the name covers both.
const char* name_of(SectionId id) {
    return id == SectionId::positions_f32 ? "positions" : format::section_name(id);
}

std::string names_of(SectionSet sections) {
    std::string names;
    for (std::uint32_t number = 0; number < 64; ++number) {
        const SectionId id{number};
        if (!sections.contains(id)) continue;
        if (!names.empty()) names += ", ";
        names += name_of(id);
    }
    assert(!names.empty());
    return names;
}

std::string way_out(const Needs& row, const Contents& contents, Refusal::Reason reason) {
    if (reason == Refusal::Reason::not_opened) return "Open the model for this query.";
    if (row.ask == Ask::response && !contents.is_balanced) {
        return "Only balanced meshes have mass properties: bake it again with --repair closed "
               "--effects response.";
    }
    return std::string("Bake the mesh again with ") + row.bake_option + ".";
}

}  // namespace

std::string refusal_sentence(std::string_view file, Ask asks, const Contents& contents,
                             Refusal::Reason reason) {
    assert(asks != Ask::nothing);
    const std::string begin = std::string(file) + ": ";
    for (const Needs& row : needs()) {
        if (!contains(asks, row.ask)) continue;
        const SectionSet missing =
            missing_sections(row.ask, contents.sections, contents.has_exact_leaves);
        if (missing == SectionSet{}) continue;
        const bool is_one = names_of(missing).find(',') == std::string::npos;
        return begin + row.name + " needs " + (is_one ? "section " : "sections ") +
               names_of(missing) +
               (reason == Refusal::Reason::not_opened
                    ? std::string(is_one ? ", which was not opened. " : ", which were not opened. ")
                    : std::string(is_one ? ", which is missing. " : ", which are missing. ")) +
               way_out(row, contents, reason);
    }
    return begin + "this version does not know the query. Update cdprep.";
}

}  // namespace cdprep
