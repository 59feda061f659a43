// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/validation_page.h"

#include <utility>

#include "validate/html_page.h"

namespace cdprep::cli {

Result<ValidationPage> ValidationPage::open(const std::filesystem::path& path) {
    Result<ReportOutput> output = ReportOutput::open(path);
    if (!output) return output.error();
    return ValidationPage(std::move(output).value());
}

void ValidationPage::add(Validation validation) {
    meshes_.push_back(std::move(validation));
}

Result<Done> ValidationPage::finish() {
    std::deque<std::vector<mesh::Severity>> severities;
    std::vector<report::PageMesh> meshes;
    for (const Validation& mesh : meshes_) {
        std::vector<mesh::Severity>& found = severities.emplace_back();
        for (const report::Judgement& judgement : mesh.report.judgements) {
            found.push_back(judgement.severity);
        }
        meshes.push_back({&mesh.report, mesh.soup.positions, mesh.soup.triangles, found});
    }
    Result<Done> written = output_.append(report::html_page(meshes, {.version = CDPREP_VERSION}));
    return written ? output_.finish() : written;
}

}  // namespace cdprep::cli
