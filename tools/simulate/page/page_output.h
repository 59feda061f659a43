// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "cli/report_output.h"
#include "simulate/page/scene_page.h"

namespace cdprep::cli {

/// Fails with bad_argument if an output would replace an input or another output, whatever their
/// spelling. An empty path is no output.
[[nodiscard]] Result<Done> check_outputs(const std::vector<std::filesystem::path>& inputs,
                                         const std::vector<std::filesystem::path>& outputs);

/// The files of --html and --svg. They appear when both are written.
class PageOutput {
public:
    /// Creates the files, so that an unwritable place is reported before the work. An empty path
    /// is no file. Fails with `unwritable`.
    [[nodiscard]] static Result<PageOutput> open(const std::filesystem::path& html,
                                                 const std::filesystem::path& svg);

    /// Begins a run of `count` frames. The arguments must outlive the object.
    void begin(const scenes::SceneFile& file, std::span<const scenes::SceneModel> models,
               std::uint64_t count);

    /// Adds the last frame of a simulation; see ScenePage.
    [[nodiscard]] Result<Done> add_frame(std::uint64_t frame, const scenes::Simulation& simulation);

    /// Writes the files and prints on stderr what the page leaves out. Call it once, after the
    /// last frame; otherwise no file appears. `costs` are those of --cost.
    [[nodiscard]] Result<Done> finish(const scenes::Simulation& simulation,
                                      std::span<const report::EffectCost> costs);

private:
    const scenes::SceneFile* file_ = nullptr;
    std::optional<ReportOutput> html_;
    std::optional<ReportOutput> svg_;
    std::optional<report::ScenePage> page_;
    report::SceneTimeline timeline_;  ///< if there is no page, which has its own
};

}  // namespace cdprep::cli
