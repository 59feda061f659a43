// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "mesh/mesh.h"
#include "validate/validation_report.h"

namespace cdprep::report {

/// One file of a run. Positions and triangles are those that were validated; both are
/// empty for a file that could not be read.
struct PageMesh {
    const ValidationReport* report;  ///< never null
    std::span<const mesh::Double3> positions;
    std::span<const mesh::Triangle> triangles;
    /// One a finding, where a run changed them; empty: as the rules say.
    std::span<const mesh::Severity> severities;
};

struct PageOptions {
    std::string version{};  ///< of the program, shown on the page
    /// Drawn as they are, on the page as a whole. Meshes share it evenly, and what small
    /// ones leave over goes to larger ones. Of a mesh with more than its share, what lies
    /// around findings is drawn as it is and the rest coarsely; the page says so.
    std::size_t max_triangles = 1'000'000;
    /// Listed and marked, on the page as a whole, shared evenly by findings; each has at
    /// least 10 and at most 1000. Counts are always of all.
    std::size_t max_places = 50'000;
};

/// One complete HTML page that draws every mesh, marks each finding in place, lists them
/// and says what may be promised of each mesh. It asks no network for anything, by its
/// own Content-Security-Policy too, and prints on paper. `#CDP0301/3` opens it at the
/// third place of that rule, `#mesh=2&CDP0301/3` in the second mesh, and
/// `#camera=x,y,z,tx,ty,tz` looks from one point at another, in model units.
///
/// About 960 kB, 24 bytes a drawn triangle of a closed mesh and 500 a place; stand-ins
/// for what is not drawn as it is take up to 10 MB a page. 871,414 triangles: 22 MB.
/// Any name of a file or node is safe, and so is any extent.
[[nodiscard]] std::string html_page(std::span<const PageMesh> meshes,
                                    const PageOptions& options = {});

}  // namespace cdprep::report
