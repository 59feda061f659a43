// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/page_output.h"

#include <algorithm>
#include <iostream>
#include <utility>

#include "simulate/scene_chart.h"

namespace cdprep::cli {
namespace {

/// Returns whether a path has the name of one of these, by their spelling.
bool is_among(const std::filesystem::path& path, const std::vector<std::filesystem::path>& taken) {
    const auto spelled_out = [](const std::filesystem::path& spelling) {
        return std::filesystem::absolute(spelling).lexically_normal();
    };
    return std::ranges::any_of(taken, [&](const std::filesystem::path& other) {
        return !other.empty() && spelled_out(other) == spelled_out(path);
    });
}

Result<Done> open_file(std::optional<ReportOutput>& output, const std::filesystem::path& path) {
    if (path.empty()) return Done{};
    Result<ReportOutput> opened = ReportOutput::open(path);
    if (!opened) return opened.error();
    output.emplace(std::move(opened).value());
    return Done{};
}

Result<Done> write_file(ReportOutput& output, const std::string& text) {
    Result<Done> written = output.append(text);
    return written ? output.finish() : written;
}

}  // namespace

Result<Done> check_outputs(const std::filesystem::path& scene,
                           const std::vector<std::filesystem::path>& outputs) {
    std::vector<std::filesystem::path> taken = {scene};
    for (const std::filesystem::path& path : outputs) {
        if (path.empty()) continue;
        if (path == "-") {
            return Error{ErrorCode::bad_argument,
                         "An output is named '-'. The report alone goes to standard output, "
                         "without -o. Choose a file."};
        }
        if (is_among(path, taken)) {
            return Error{ErrorCode::bad_argument,
                         path.string() +
                             " is the scene or another output and would be replaced. Choose "
                             "another name."};
        }
        taken.push_back(path);
    }
    return Done{};
}

Result<PageOutput> PageOutput::open(const std::filesystem::path& html,
                                    const std::filesystem::path& svg) {
    PageOutput output;
    if (Result<Done> opened = open_file(output.html_, html); !opened) return opened.error();
    if (Result<Done> opened = open_file(output.svg_, svg); !opened) return opened.error();
    return output;
}

void PageOutput::begin(const scenes::SceneFile& file, std::span<const scenes::SceneModel> models,
                       std::uint64_t count) {
    file_ = &file;
    report::ScenePageOptions options;
    options.version = CDPREP_VERSION;
    if (html_) page_.emplace(file, models, count, options);
}

Result<Done> PageOutput::add_frame(std::uint64_t frame, const scenes::Simulation& simulation) {
    if (page_) return page_->add_frame(frame, simulation);
    if (svg_) timeline_.add(simulation);
    return Done{};
}

Result<Done> PageOutput::finish(const scenes::Simulation& simulation) {
    if (svg_) {
        const report::SceneTimeline& timeline = page_ ? page_->timeline() : timeline_;
        Result<Done> written =
            write_file(*svg_, report::scene_svg(timeline, file_->name, file_->step_s));
        if (!written) return written;
    }
    if (!page_) return Done{};
    Result<Done> written = write_file(*html_, page_->finish(simulation));
    if (!written) return written;
    for (const std::string& sentence : page_->left_out()) {
        std::cerr << "cdprep simulate: --html: " << sentence << '\n';
    }
    return written;
}

}  // namespace cdprep::cli
