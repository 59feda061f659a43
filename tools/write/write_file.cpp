// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/write_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>

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

std::uint64_t element_count(const Section& section) {
    return section.bytes.size() / format::element_size(section.id);
}

std::vector<Section> by_id(std::span<const Section> sections) {
    std::vector<Section> sorted(sections.begin(), sections.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Section& a, const Section& b) { return a.id < b.id; });
    return sorted;
}

/// Datasets for all sections but the empty ones, which HDF5 would not place.
std::vector<Plan> plans_for(std::span<const Section> sections) {
    std::vector<Plan> plans;
    for (const Section& section : sections) {
        if (!section.bytes.empty()) plans.push_back({section.id, element_count(section)});
    }
    return plans;
}

std::vector<SectionEntry> entries_for(std::span<const Section> sections,
                                      std::span<const Place> places) {
    std::vector<SectionEntry> entries;
    for (const Section& section : sections) {
        const auto place = std::find_if(places.begin(), places.end(),
                                        [&](const Place& p) { return p.id == section.id; });
        entries.push_back({section.id, format::element_size(section.id),
                           place == places.end() ? 0 : place->offset, element_count(section),
                           format::checksum(section.bytes)});
    }
    return entries;
}

Result<Done> write_sections(OutputFile& file, std::span<const Section> sections,
                            std::span<const SectionEntry> entries) {
    for (std::size_t i = 0; i < sections.size(); ++i) {
        Result<Done> written = file.write_at(entries[i].offset, sections[i].bytes);
        if (!sections[i].bytes.empty() && !written) return written;
    }
    return Done{};
}

/// Puts the user block in front; the magic comes last, with everything else of
/// it already there.
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

/// Reads back what was written, as a user of the file will.
Result<Done> commit_checked(OutputFile& file, const std::filesystem::path& path) {
    const Result<Model> opened = Model::open(file.temporary());
    if (!opened) {
        return Error{
            ErrorCode::unwritable,
            path.string() + ": what was written does not read back: " + opened.error().message};
    }
    return file.commit();
}

Error no_layout(const std::filesystem::path& path) {
    return {ErrorCode::unwritable,
            path.string() +
                ": HDF5 could not lay the file out; the disk may be full. The file "
                "that was there before is unchanged."};
}

Error not_mendable(const std::filesystem::path& path, const std::string& why) {
    return {ErrorCode::unreadable,
            path.string() + ": cannot be reindexed: " + why + ". Bake the mesh again."};
}

/// A section of a file that is mapped as a whole.
std::span<const std::byte> bytes_at(std::span<const std::byte> file, const Place& place) {
    return file.subspan(static_cast<std::size_t>(place.offset),
                        static_cast<std::size_t>(place.count * format::element_size(place.id)));
}

/// The whole file's bytes.
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

}  // namespace

Result<Done> write_file(const std::filesystem::path& path, const format::FileHeader& facts,
                        std::span<const Section> sections) {
    Result<OutputFile> created = OutputFile::create(path);
    if (!created) return created.error();
    OutputFile& file = created.value();
    const std::vector<Section> sorted = by_id(sections);
    const auto places = make_layout(file.temporary(), plans_for(sorted));
    if (!places) return no_layout(path);
    const std::vector<SectionEntry> entries = entries_for(sorted, *places);
    if (Result<Done> written = write_sections(file, sorted, entries); !written) return written;
    if (Result<Done> sealed = write_user_block(file, facts, entries); !sealed) return sealed;
    return commit_checked(file, path);
}

Result<Done> reindex_file(const std::filesystem::path& path) {
    const Result<std::vector<std::byte>> read = bytes_of(path);
    if (!read) return read.error();
    const std::span<const std::byte> bytes = read.value();
    if (bytes.size() < format::kUserBlockSize ||
        format::read_header(bytes).magic != format::kMagic) {
        return not_mendable(path, "it has no user block of cdprep in front");
    }
    const format::FileHeader facts = format::read_header(bytes);
    if (facts.header_checksum != format::header_checksum(bytes.first<format::kUserBlockSize>())) {
        return not_mendable(path, "its user block is damaged");
    }
    const FoundLayout found = find_layout(path);
    if (!found.damage.empty()) return not_mendable(path, found.damage);

    std::vector<Section> sections;
    std::vector<SectionEntry> entries;
    bool aligned = true;
    for (const Place& place : found.places) {
        const std::span<const std::byte> content = bytes_at(bytes, place);
        sections.push_back({place.id, content});
        entries.push_back({place.id, format::element_size(place.id), place.offset, place.count,
                           format::checksum(content)});
        aligned = aligned && place.offset % format::kSectionAlignment == 0;
    }
    // Where the other tool broke the alignment, the sections must move once more.
    if (!aligned) return write_file(path, facts, sections);
    Result<OutputFile> created = OutputFile::create(path);
    if (!created) return created.error();
    OutputFile& file = created.value();
    if (Result<Done> copied = file.write_at(0, bytes); !copied) return copied;
    if (Result<Done> sealed = write_user_block(file, facts, entries); !sealed) return sealed;
    return commit_checked(file, path);
}

}  // namespace cdprep::write
