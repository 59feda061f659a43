// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/page/page_output.h"

#include <iostream>
#include <utility>

#include "cli/output_path.h"
#include "simulate/page/scene_chart.h"

namespace cdprep::cli {
namespace {

Result<Done> open_file(std::optional<ReportOutput>& output, const std::filesystem::path& path) {
    if (path.empty()) return Done{};
    Result<ReportOutput> opened = ReportOutput::open(path);
    if (!opened) return opened.error();
    output.emplace(std::move(opened).value());
    return Done{};
}

}  // namespace

Result<Done> check_outputs(const std::vector<std::filesystem::path>& inputs,
                           const std::vector<std::filesystem::path>& outputs) {
    UsedFiles used;
    for (const std::filesystem::path& path : inputs) used.add_input(path);
    for (const std::filesystem::path& path : outputs) {
        if (path == "-") {
            return Error{ErrorCode::bad_argument,
                         "'-' is not supported as an output file. Only the report can go to "
                         "standard output: leave out -o."};
        }
        if (Result<Done> added = used.add_output(path); !added) return added;
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

/// Writes both texts before either file appears. So no file is replaced without room for both.
Result<Done> PageOutput::finish(const scenes::Simulation& simulation,
                                std::span<const report::EffectCost> costs) {
    if (svg_) {
        const report::SceneTimeline& timeline = page_ ? page_->timeline() : timeline_;
        Result<Done> written =
            svg_->append(report::scene_svg(timeline, file_->name, file_->step_s));
        if (!written) return written;
    }
    if (page_) {
        if (Result<Done> written = html_->append(page_->finish(simulation, costs)); !written) {
            return written;
        }
        if (Result<Done> written = html_->finish(); !written) return written;
        for (const std::string& sentence : page_->left_out()) {
            std::cerr << "cdprep simulate: --html: " << sentence << '\n';
        }
    }
    return svg_ ? svg_->finish() : Result<Done>(Done{});
}

}  // namespace cdprep::cli
