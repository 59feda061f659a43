// SPDX-License-Identifier: MIT
#include <optional>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"

namespace cdprep::format {
namespace {

std::string number(std::uint64_t value) {
    return std::to_string(value);
}

/// Returns the damage in words, without the file and without the remedy.
std::string fault(const Damage& damage) {
    using Kind = DamageKind;
    const std::string section = damage.section == SectionId{0}
                                    ? "the user block"
                                    : "section " + std::string(section_name(damage.section));
    const std::string at = " at byte " + number(damage.at);
    const std::string found = number(damage.found);
    const std::string limit = number(damage.limit);
    switch (damage.kind) {
        case Kind::too_short:
            return "has " + found + " bytes, but needs at least " + limit;
        case Kind::bad_magic:
            return "is not a complete baked file: its first bytes are not those of cdprep";
        case Kind::bad_version:
            return "written in format " + found + "; this program reads " + limit;
        case Kind::bad_byte_order:
            return "written on a machine of another byte order or number format";
        case Kind::bad_file_size:
            return "has " + found + " bytes, but its header states " + limit;
        case Kind::bad_header:
            return section + at + " is damaged: found " + found + ", expected " + limit;
        case Kind::rewritten:
            return "rewritten by another HDF5 tool, so its section table is out of date";
        case Kind::unknown_feature:
            return "needs features " + found + "; this program knows " + limit;
        case Kind::bad_section:
            return "the table entry of " + section + at + " is invalid: found " + found +
                   ", allowed " + limit;
        case Kind::missing_section:
            return section + " is missing";
        case Kind::bad_checksum:
            return section + at + " has checksum " + found + ", expected " + limit;
        case Kind::bad_count:
            return section + " has " + found + " elements, expected " + limit;
        case Kind::bad_index:
            return section + at + " has the index " + found + "; the maximum is " + limit;
        case Kind::bad_number:
            return section + at + " has a number that is not finite or too large";
        case Kind::bad_order:
            return section + at + " is out of order: found " + found + ", expected " + limit;
        case Kind::bad_box:
            return section + at + ": box " + found +
                   " is inverted, leaves the frame or does not contain what lies below it";
        case Kind::bad_fact:
            return section + at + " contradicts the geometry: found " + found + ", expected " +
                   limit;
    }
    return section + at + " is damaged";
}

const char* way_out(DamageKind kind) {
    using Kind = DamageKind;
    switch (kind) {
        case Kind::bad_magic:
            return "Bake the mesh again, or give the path of a .cdp.h5 file.";
        case Kind::bad_version:
        case Kind::unknown_feature:
            return "Bake it again, or update cdprep.";
        case Kind::bad_byte_order:
            return "Bake it on a little-endian machine.";
        case Kind::rewritten:
            return "Run cdprep reindex on it.";
        default:
            return "Copy the file again, or bake it again.";
    }
}

}  // namespace

Damage wrong_fact(std::span<const std::byte> file, SectionId section, std::uint64_t index,
                  std::uint64_t found, std::uint64_t expected) noexcept {
    const std::optional<SectionEntry> entry = find_section(file, section);
    const std::uint64_t at = entry ? entry->offset + index * entry->element_size : 0;
    return {DamageKind::bad_fact, section, at, found, expected};
}

std::string damage_sentence(std::string_view file, const Damage& damage) {
    return std::string(file) + ": " + fault(damage) + ". " + way_out(damage.kind);
}

}  // namespace cdprep::format
