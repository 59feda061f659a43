// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "mesh/mesh.h"
#include "validate/validation_report.h"

namespace cdprep::report {

/// One file of a run. Positions and triangles are the validated ones; both are empty for a file
/// that could not be read.
struct PageMesh {
    const ValidationReport* report;  ///< never null
    std::span<const mesh::Double3> positions;
    std::span<const mesh::Triangle> triangles;
    /// One per finding, if a run changed them; empty: the severities of the rules.
    std::span<const mesh::Severity> severities;
};

struct PageOptions {
    std::string version{};  ///< of the program, shown on the page
    /// The limit on triangles drawn exactly, for the page as a whole. Meshes share it evenly;
    /// triangles that small meshes leave go to larger ones. A mesh above its share is drawn
    /// exactly around findings, and coarsely elsewhere. The page reports this. Only tests set it: a
    /// small mesh does not reach the default.
    std::size_t max_triangles = 1'000'000;
};

/// Returns one complete HTML page. It draws every mesh, marks each finding in place, lists the
/// findings and states the promises of each mesh. The page uses no network, and its
/// Content-Security-Policy forbids it. It prints on paper.
///
/// `#CDP0301/3` opens the page at the third place of that rule, `#mesh=2&CDP0301/3` in the
/// second mesh. `#camera=x,y,z,tx,ty,tz` looks from one point at another, in model units.
///
/// The page lists and marks at most about 50,000 places. Findings share them evenly; each has at
/// least 10 and at most 1000. Counts always include all places.
///
/// The page takes about 960 kB, plus 24 bytes per drawn triangle of a closed mesh and 500 per
/// place. Coarse surfaces take up to 10 MB per page. A mesh of 871,414 triangles takes 22 MB.
/// Any file or node name is safe, and so is any extent.
[[nodiscard]] std::string html_page(std::span<const PageMesh> meshes,
                                    const PageOptions& options = {});

}  // namespace cdprep::report
