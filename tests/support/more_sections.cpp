// SPDX-License-Identifier: MIT
#include "support/more_sections.h"

#include <algorithm>
#include <utility>

#include "support/open_tiny.h"

#include "cdprep/format/sections.h"

namespace cdprep::test {

AlignedBytes with_sections(const AlignedBytes& file, std::vector<TinySection> sections,
                           std::uint64_t section_alignment) {
    const std::span<const std::byte> bytes = file.span();
    std::vector<TinySection> all;
    for (std::uint32_t id = 1; id < 64; ++id) {
        const auto entry = format::find_section(bytes, SectionId{id});
        if (!entry) continue;
        const auto content = bytes.subspan(entry->offset, entry->count * entry->element_size);
        all.push_back({entry->id, {content.begin(), content.end()}});
    }
    for (TinySection& section : sections) all.push_back(std::move(section));
    std::sort(all.begin(), all.end(),
              [](const TinySection& a, const TinySection& b) { return a.id < b.id; });
    return assemble(format::read_header(bytes), all, section_alignment);
}

AlignedBytes on_pages(const AlignedBytes& file) {
    constexpr std::uint64_t kPage = 4096;
    return with_sections(file, {}, kPage);
}

BuilderInput builder_input(const Model& model) {
    BuilderInput input;
    for (const Float3& p : model.mesh().positions_f32) input.positions.push_back({p.x, p.y, p.z});
    for (const Double3& p : model.mesh().positions_f64) input.positions.push_back(p);
    input.triangles.assign(model.mesh().triangles.begin(), model.mesh().triangles.end());
    return input;
}

}  // namespace cdprep::test
