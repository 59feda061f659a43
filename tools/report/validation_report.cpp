// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/validation_report.h"

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

}  // namespace cdprep::report
