// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "import/import_file.h"
#include "import/source_file.h"
#include "simulate/run/simulation.h"

namespace cdprep::scenes {

/// Writes a simulation as lines of JSON (recording.schema.json). The first line has the scene file.
/// A line for each frame has the poses that changed and the events. The last line counts the
/// frames. There are no times and no counts of work. So equal simulations have equal recordings, on
/// any number of threads. With `continuous` and `haptic`, that holds for one instruction set.
class Recorder {
public:
    /// `folder` leads from the folder of the recording to that of the scene file. `import` has the
    /// options with which meshes were read; limits are not recorded.
    Recorder(const SceneFile& file, std::filesystem::path folder,
             const import::ImportOptions& import);

    /// Returns the first line.
    [[nodiscard]] std::string begin(std::span<const SceneModel> models) const;
    /// Returns the line of the last frame of a simulation.
    [[nodiscard]] std::string add_frame(std::uint64_t frame, const Simulation& simulation);
    /// Returns the last line.
    [[nodiscard]] std::string finish() const;
    /// How many frames there are.
    [[nodiscard]] std::uint64_t frames() const noexcept {
        return frames_;
    }

private:
    const SceneFile* file_;
    std::filesystem::path folder_;
    import::ImportOptions import_;
    std::vector<Pose> poses_;  ///< by slot, of the last frame
    std::uint64_t frames_ = 0;
};

/// A frame of a recording.
struct RecordedFrame {
    std::uint64_t frame = 0;
    std::vector<GivenPose> poses;  ///< of the objects that moved
    std::string state;             ///< Scene::state_hash() in hexadecimal
};

/// A recording, read frame by frame.
class Recording {
public:
    /// Returns whether a file begins like a recording.
    [[nodiscard]] static bool is_one(const std::filesystem::path& path);
    /// Opens a recording and reads its first line. Fails with `unreadable`.
    [[nodiscard]] static Result<Recording> open(const std::filesystem::path& path);

    [[nodiscard]] const std::string& scene_name() const noexcept {
        return scene_name_;
    }
    [[nodiscard]] const std::string& scene_text() const noexcept {
        return scene_text_;
    }
    /// The folder of the scene file, from the working directory.
    [[nodiscard]] const std::filesystem::path& folder() const noexcept {
        return folder_;
    }
    /// Sets the options that decide what a mesh becomes to those of the run. Limits stay. Fails
    /// with bad_argument if one is set to something else.
    [[nodiscard]] Result<Done> set_import(import::ImportOptions& options) const;
    /// How many frames the last line says there are.
    [[nodiscard]] std::uint64_t frames() const noexcept {
        return frames_;
    }
    /// Fails with `unreadable` if a model is not the one that was recorded.
    [[nodiscard]] Result<Done> check_models(const SceneFile& file,
                                            std::span<const SceneModel> models) const;

    /// Reads the next of frames(). Fails with `unreadable` and names the line. `objects` is how
    /// many the scene file has.
    [[nodiscard]] Result<RecordedFrame> next(std::size_t objects);
    /// Fails with `unreadable` if the last frame that was read had other results.
    [[nodiscard]] Result<Done> check_state(const RecordedFrame& frame, const Scene& scene) const;

private:
    explicit Recording(import::SourceFile file) : file_(std::move(file)) {}
    [[nodiscard]] Error unreadable(std::string_view what) const;
    [[nodiscard]] Result<Done> read_first();
    [[nodiscard]] Result<Done> read_last();
    [[nodiscard]] std::string_view take_line();

    import::SourceFile file_;
    std::string scene_name_;
    std::string scene_text_;
    std::filesystem::path folder_;
    import::ImportOptions import_;     ///< without the limits
    std::vector<std::string> hashes_;  ///< of the models; empty for one that was not opened
    std::size_t at_ = 0;               ///< in the file
    std::uint64_t line_ = 0;           ///< the last one that was taken, from 1
    std::uint64_t next_frame_ = 0;
    std::uint64_t frames_ = 0;
};

}  // namespace cdprep::scenes
