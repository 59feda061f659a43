// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "cli/report_output.h"
#include "cli/signals.h"
#include "simulate/recording.h"

namespace cdprep::cli {

/// The file of a recording, as it grows. It appears when it ends. If work is abandoned after a
/// signal, its last words end it: then the frames that were complete can be replayed.
class RecordingOutput {
public:
    /// Opens the file and writes the first line. Fails with `unwritable`.
    [[nodiscard]] static Result<std::unique_ptr<RecordingOutput>> open(
        const std::filesystem::path& file, scenes::Recorder recorder,
        std::span<const scenes::SceneModel> models);
    RecordingOutput(const RecordingOutput&) = delete;
    RecordingOutput& operator=(const RecordingOutput&) = delete;

    /// Writes the line of the last frame of a simulation.
    [[nodiscard]] Result<Done> add_frame(std::uint64_t frame, const scenes::Simulation& simulation);
    /// Writes the last line, and gives the file its name. A recording without a frame would be
    /// unreadable, and does not appear.
    [[nodiscard]] Result<Done> finish();

private:
    RecordingOutput(ReportOutput output, scenes::Recorder recorder)
        : output_(std::move(output)), recorder_(std::move(recorder)) {}
    [[nodiscard]] Result<Done> end();

    std::mutex mutex_;  ///< held while whole lines are written
    ReportOutput output_;
    scenes::Recorder recorder_;
    bool is_over_ = false;
    std::optional<LastWords> last_words_;
};

}  // namespace cdprep::cli
