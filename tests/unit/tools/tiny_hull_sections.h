// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "decompose/enclose/hull_sections.h"
#include "support/more_sections.h"

namespace cdprep::convex {

/// Hulls as sections of a file in memory.
inline std::vector<test::TinySection> tiny_sections(const HullSections& hulls) {
    return {test::as_section(format::SectionId::hulls, std::span(hulls.hulls)),
            test::as_section(format::SectionId::hull_blocks, std::span(hulls.blocks)),
            test::as_section(format::SectionId::hull_vertices, std::span(hulls.vertices)),
            test::as_section(format::SectionId::hull_facets, std::span(hulls.facets)),
            test::as_section(format::SectionId::hull_groups, std::span(hulls.groups)),
            test::as_section(format::SectionId::hull_neighbours, std::span(hulls.neighbours)),
            test::as_section(format::SectionId::hull_starts, std::span(hulls.starts))};
}

}  // namespace cdprep::convex
