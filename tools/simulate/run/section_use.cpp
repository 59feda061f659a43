// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/run/section_use.h"

#include "cdprep/format/sections.h"

namespace cdprep::report {
namespace {

std::uint64_t size_of(const format::SectionEntry& entry) {
    return entry.count * entry.element_size;
}

void add(SectionBytes& sections, const format::SectionEntry& entry) {
    sections.rows.push_back({format::section_name(entry.id), size_of(entry)});
    sections.bytes += size_of(entry);
}

}  // namespace

SectionUse use_of(const Model& model) {
    SectionUse use;
    for (const format::SectionKind& kind : format::section_kinds()) {
        const auto entry = format::find_section(model.bytes(), kind.id);
        if (!entry) continue;
        add(model.sections().contains(kind.id) ? use.read : use.untouched, *entry);
    }
    return use;
}

std::uint64_t bytes_of(const Model& model, format::SectionSet sections) {
    std::uint64_t bytes = 0;
    for (const format::SectionKind& kind : format::section_kinds()) {
        if (!sections.contains(kind.id) || !model.sections().contains(kind.id)) continue;
        if (const auto entry = format::find_section(model.bytes(), kind.id)) {
            bytes += size_of(*entry);
        }
    }
    return bytes;
}

}  // namespace cdprep::report
