// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "cdprep/format/sections.h"
#include "support/tiny_baker.h"
#include "write/write_file.h"

namespace cdprep::test {

/// The sections of a file image that bake_tiny() made, ready for write_file().
/// Valid while the image lives.
inline std::vector<write::Section> sections_of(const AlignedBytes& image) {
    std::vector<write::Section> sections;
    for (std::uint32_t number = 1; number < 64; ++number) {
        const auto id = static_cast<SectionId>(number);
        if (const auto entry = format::find_section(image.span(), id)) {
            sections.push_back(
                {id, image.span().subspan(entry->offset, entry->count * entry->element_size)});
        }
    }
    return sections;
}

inline std::string content_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void put_content(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

}  // namespace cdprep::test
