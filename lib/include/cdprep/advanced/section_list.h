// SPDX-License-Identifier: MIT
#pragma once

#include <iterator>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/build_image.h"
#include "cdprep/format/api.h"
#include "cdprep/format/section_set.h"

namespace cdprep::build {

/// Collects the sections of a model from its arrays. It copies nothing: the arrays must stay in
/// place until the sections have been used. Sections that are not wanted are left out.
class SectionList {
public:
    explicit SectionList(format::SectionSet wanted = format::SectionSet::all()) noexcept
        : wanted_(wanted) {}

    /// Adds a section, even if it is empty.
    template <class Elements>
    void add(format::SectionId id, const Elements& elements) {
        if (wanted_.contains(id)) sections_.push_back({id, bytes_of(elements)});
    }

    /// Adds a section unless it is empty.
    template <class Elements>
    void add_unless_empty(format::SectionId id, const Elements& elements) {
        if (std::size(elements) != 0) add(id, elements);
    }

    /// Adds a section of one element.
    template <class Element>
    void add_one(format::SectionId id, const Element& element) {
        add(id, std::span<const Element, 1>(&element, 1));
    }

    [[nodiscard]] std::span<const Section> sections() const noexcept {
        return sections_;
    }

private:
    template <class Elements>
    static std::span<const std::byte> bytes_of(const Elements& elements) {
        return std::as_bytes(std::span(std::data(elements), std::size(elements)));
    }

    format::SectionSet wanted_;
    std::vector<Section> sections_;
};

/// Adds the arrays of a BVH. The sections of oriented boxes and of swept spheres are absent if they
/// are empty.
CDPREP_API void add_sections(SectionList& list, const Bvh& bvh);

}  // namespace cdprep::build
