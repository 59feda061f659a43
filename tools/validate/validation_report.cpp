// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/validation_report.h"

namespace cdprep::report {

ValidationReport report_on(const std::string& input, const mesh::TriangleSoup& soup) {
    ValidationReport report;
    report.input = input;
    report.triangles = soup.triangles.size();
    report.vertices = soup.positions.size();
    for (const format::Instance& instance : soup.instances) {
        report.first_triangle.push_back(instance.first_triangle);
        report.node_of_triangle_run.push_back(
            instance.name < soup.instance_names.size() ? soup.instance_names[instance.name] : "");
    }
    return report;
}

void remark_on_limits(ValidationReport& report, const mesh::DefectOptions& options) {
    if (!report.defects.t_junctions_complete) {
        report.remarks.push_back(
            "The search for T-junctions ended at the limit of its work. The count of CDP0307 is a "
            "lower bound.");
    }
    if (!options.crossings || report.defects.crossings_complete) return;
    const std::uint64_t found = report.defects.counts.self_intersecting_pairs;
    const std::string reached =
        found >= options.max_pairs
            ? "after " + std::to_string(found) +
                  " pairs of triangles that meet; a larger --max-pairs finds more"
            : "at the limit of its work, after " + std::to_string(found) +
                  " pairs of triangles that meet";
    report.remarks.push_back("The search for crossings ended " + reached +
                             ". The counts of CDP0402, CDP0403 and CDP0501 to CDP0503 are lower "
                             "bounds.");
}

}  // namespace cdprep::report
