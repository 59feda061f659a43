// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/write_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>

#include "cdprep/format/checksum.h"
#include "cdprep/format/content_hash.h"
#include "cdprep/format/make_user_block.h"
#include "cdprep/format/sections.h"
#include "cdprep/model.h"
#include "write/hdf5_layout.h"
#include "write/output_file.h"

namespace cdprep::write {
namespace {

using format::SectionEntry;
using format::SectionId;

using build::SectionTable;

/// Returns a dataset plan for each section that is not empty; HDF5 gives empty ones no place.
std::vector<Plan> plans_for(const SectionTable& table) {
    std::vector<Plan> plans;
    for (const SectionEntry& entry : table.used_entries()) {
        if (entry.count != 0) plans.push_back({entry.id, entry.count});
    }
    return plans;
}

/// Stores the offsets that HDF5 gave the datasets. `places` has the order of plans_for().
void add_offsets(SectionTable& table, std::span<const Place> places) {
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < table.count; ++i) {
        if (table.entries[i].count != 0) table.entries[i].offset = places[next++].offset;
    }
}

Result<Done> write_sections(OutputFile& file, const SectionTable& table) {
    for (std::uint32_t i = 0; i < table.count; ++i) {
        const std::span<const std::byte> bytes = table.sections[i].bytes;
        if (bytes.empty()) continue;
        if (Result<Done> written = file.write_at(table.entries[i].offset, bytes); !written) {
            return written;
        }
    }
    return Done{};
}

/// Writes the bytes that HDF5 put around the sections.
Result<Done> write_rest(OutputFile& file, const Layout& layout) {
    std::vector<Place> places = layout.places;
    places.push_back({SectionId{}, layout.rest.size(), 0});
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.offset < b.offset; });
    std::uint64_t at = 0;
    std::vector<std::byte> bytes;
    for (const Place& place : places) {
        bytes.resize(static_cast<std::size_t>(place.offset - at));
        layout.rest.read(at, bytes);
        if (Result<Done> written = file.write_at(at, bytes); !written) return written;
        at = place.offset + place.count * format::element_size(place.id);
    }
    return Done{};
}

/// Writes the user block in front. The magic comes last, after the rest of the block.
Result<Done> write_user_block(OutputFile& file, const format::FileHeader& facts,
                              std::span<const SectionEntry> entries) {
    const Result<std::uint64_t> size = file.size();
    if (!size) return size.error();
    std::array<std::byte, 40> superblock{};
    if (Result<Done> read = file.read_at(format::kSuperblockOffset, superblock); !read) return read;
    const format::UserBlock block =
        format::make_user_block(facts, entries, superblock, size.value());
    const std::span<const std::byte> bytes = block;
    const std::size_t magic = format::kMagic.size();
    if (Result<Done> body = file.write_at(magic, bytes.subspan(magic)); !body) return body;
    return file.write_at(0, bytes.first(magic));
}

/// Opens the written file as a user would, then commits it. `blame` is the error code if the file
/// does not open.
Result<Done> commit_checked(OutputFile& file, const std::filesystem::path& path, ErrorCode blame) {
    const Result<Model> opened = Model::open(file.readable_path());
    if (!opened) {
        return Error{blame, path.string() + ": the written file cannot be read back: " +
                                opened.error().message};
    }
    return file.commit();
}

Error no_layout(const std::filesystem::path& path) {
    return {ErrorCode::over_budget,
            path.string() +
                ": HDF5 could not create the file; memory may be short. The previous "
                "content is unchanged."};
}

Error not_mendable(const std::filesystem::path& path, const std::string& why) {
    return {ErrorCode::unreadable,
            path.string() + ": cannot be reindexed: " + why + ". Bake the mesh again."};
}

/// Returns all bytes of a file.
Result<std::vector<std::byte>> bytes_of(const std::filesystem::path& path) {
    std::vector<std::byte> bytes;
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr) {
        return Error{ErrorCode::unreadable, path.string() + ": cannot be opened."};
    }
    std::array<std::byte, 65536> chunk;
    while (const std::size_t size = std::fread(chunk.data(), 1, chunk.size(), file)) {
        bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(size));
    }
    std::fclose(file);
    return bytes;
}

Result<Done> write_and_check(const std::filesystem::path& path, const format::FileHeader& facts,
                             std::span<const Section> sections, ErrorCode blame) {
    Result<SectionTable> made = build::make_section_table(sections);
    if (!made) return made.error();
    SectionTable& table = made.value();
    Result<OutputFile> created = OutputFile::create(path);
    if (!created) return created.error();
    OutputFile& file = created.value();
    const std::optional<Layout> layout = make_layout(plans_for(table), facts);
    if (!layout) return no_layout(path);
    add_offsets(table, layout->places);
    build::add_checksums(table);
    if (Result<Done> written = write_sections(file, table); !written) return written;
    if (Result<Done> written = write_rest(file, *layout); !written) return written;
    if (Result<Done> sealed = write_user_block(file, facts, table.used_entries()); !sealed) {
        return sealed;
    }
    return commit_checked(file, path, blame);
}

/// Checks the user block of a file, as far as it is reliable after another tool rewrote the rest.
/// Returns a clause that describes the damage, or nothing.
const char* find_block_damage(std::span<const std::byte> bytes) {
    if (bytes.size() < format::kUserBlockSize ||
        format::read_header(bytes).magic != format::kMagic) {
        return "it does not begin with a user block of cdprep";
    }
    const format::FileHeader header = format::read_header(bytes);
    const auto block = bytes.first<format::kUserBlockSize>();
    if (header.header_checksum != format::header_checksum(block) ||
        header.section_count > format::kMaxSections) {
        return "its user block is damaged";
    }
    return header.version == format::kVersion ? nullptr : "it has another format version";
}

/// The present places of the sections. Their bytes must equal the baked bytes; a tool may move
/// data but not change it. Empty sections have no dataset and stay.
struct Relocated {
    std::vector<Section> sections;
    std::vector<SectionEntry> entries;
    std::string damage;  ///< a clause for a message, or empty
};

std::string clause(const Place& place, const char* what) {
    return std::string("dataset ") + format::section_name(place.id) + " " + what;
}

Relocated relocate(std::span<const std::byte> file, std::span<const Place> places) {
    Relocated found;
    for (const Place& place : places) {
        const std::uint64_t size = place.count * format::element_size(place.id);
        if (place.offset > file.size() || size > file.size() - place.offset) {
            return {{}, {}, clause(place, "extends past the end of the file")};
        }
        const auto bytes =
            file.subspan(static_cast<std::size_t>(place.offset), static_cast<std::size_t>(size));
        std::optional<SectionEntry> entry = format::find_section(file, place.id);
        if (!entry || entry->checksum != format::checksum(bytes)) {
            return {{}, {}, clause(place, "does not contain the baked data")};
        }
        entry->offset = place.offset;
        found.sections.push_back({place.id, bytes});
        found.entries.push_back(*entry);
    }
    for (auto id = SectionId::positions_f32; format::element_size(id) != 0;
         id = static_cast<SectionId>(static_cast<std::uint32_t>(id) + 1)) {
        const std::optional<SectionEntry> entry = format::find_section(file, id);
        if (!entry || entry->count != 0) continue;
        found.sections.push_back({id, {}});
        found.entries.push_back(*entry);
    }
    std::sort(found.entries.begin(), found.entries.end(),
              [](const SectionEntry& a, const SectionEntry& b) { return a.id < b.id; });
    return found;
}

bool is_aligned(const SectionEntry& entry) {
    return entry.offset % format::kSectionAlignment == 0;
}

}  // namespace

Result<Done> write_file(const std::filesystem::path& path, const format::FileHeader& facts,
                        std::span<const Section> sections) {
    return write_and_check(path, facts, sections, ErrorCode::unwritable);
}

Result<Done> reindex_file(const std::filesystem::path& path) {
    const Result<std::vector<std::byte>> read = bytes_of(path);
    if (!read) return read.error();
    const std::span<const std::byte> bytes = read.value();
    if (const char* damage = find_block_damage(bytes)) return not_mendable(path, damage);
    const FoundLayout layout = find_layout(path);
    if (!layout.damage.empty()) return not_mendable(path, layout.damage);
    const Relocated found = relocate(bytes, layout.places);
    if (!found.damage.empty()) return not_mendable(path, found.damage);

    const format::FileHeader facts = format::read_header(bytes);
    // If the other tool broke the alignment, the sections must move once more.
    if (!std::all_of(found.entries.begin(), found.entries.end(), is_aligned)) {
        return write_and_check(path, facts, found.sections, ErrorCode::unreadable);
    }
    Result<OutputFile> created = OutputFile::create(path);
    if (!created) return created.error();
    OutputFile& file = created.value();
    if (Result<Done> copied = file.write_at(0, bytes); !copied) return copied;
    if (Result<Done> sealed = write_user_block(file, facts, found.entries); !sealed) return sealed;
    return commit_checked(file, path, ErrorCode::unreadable);
}

}  // namespace cdprep::write
