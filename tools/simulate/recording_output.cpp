// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/recording_output.h"

#include <utility>

namespace cdprep::cli {

Result<std::unique_ptr<RecordingOutput>> RecordingOutput::open(
    const std::filesystem::path& file, scenes::Recorder recorder,
    std::span<const scenes::SceneModel> models) {
    Result<ReportOutput> opened = ReportOutput::open(file);
    if (!opened) return opened.error();
    std::unique_ptr<RecordingOutput> output(
        new RecordingOutput(std::move(opened).value(), std::move(recorder)));
    const Result<Done> begun = output->output_.append(output->recorder_.begin(models));
    if (!begun) return begun.error();
    // Nothing is left of a recording on standard output, where other text may follow.
    if (output->output_.is_file()) {
        output->last_words_.emplace([mine = output.get()] {
            static_cast<void>(mine->end());
            return std::string();
        });
    }
    return output;
}

Result<Done> RecordingOutput::add_frame(std::uint64_t frame, const scenes::Simulation& simulation) {
    const std::lock_guard lock(mutex_);
    if (is_over_) return Done{};
    Result<Done> written = output_.append(recorder_.add_frame(frame, simulation));
    if (!written) is_over_ = true;  // half a line may be there
    return written;
}

Result<Done> RecordingOutput::finish() {
    if (is_interrupted()) end_by_itself();  // the end may take longer than an interrupt
    Result<Done> ended = end();
    last_words_.reset();
    return ended;
}

Result<Done> RecordingOutput::end() {
    const std::lock_guard lock(mutex_);
    if (std::exchange(is_over_, true) || recorder_.frames() == 0) return Done{};
    const Result<Done> written = output_.append(recorder_.finish());
    return written ? output_.finish() : written;
}

}  // namespace cdprep::cli
