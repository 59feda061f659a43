// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/section_list.h"
#include "decompose/enclose/hull_sections.h"
#include "decompose/surface/contact_arrays.h"
#include "decompose/surface/piece_arrays.h"
#include "decompose/surface/piece_tree.h"

namespace cdprep::convex {

/// Adds the arrays to the sections of a model, including empty arrays.
void add_sections(build::SectionList& list, const HullSections& hulls);
void add_sections(build::SectionList& list, const PieceArrays& pieces);
void add_sections(build::SectionList& list, const PieceTree& tree);
void add_sections(build::SectionList& list, const ContactArrays& contacts);

}  // namespace cdprep::convex
