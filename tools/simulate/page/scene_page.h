// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "simulate/page/scene_frames.h"
#include "simulate/page/scene_timeline.h"
#include "simulate/run/effect_counts.h"

namespace cdprep::report {

struct ScenePageOptions {
    std::string version{};  ///< of the program, shown on the page
    FrameLimits limits{};
    std::size_t triangles = 300'000;  ///< drawn exactly, of all models
    std::size_t events = 100'000;     ///< listed
};

/// Collects the frames of a simulation for one HTML page that opens offline. The page plays them,
/// lights what touches, and shows counts, events, the time of frames and the plan. Whatever the
/// length of the run, memory and page are bounded.
///
/// The data of the page are elements of type application/json:
/// - `scene-data`: layers, objects, models, spans of the timeline, events, and `left_out`, a
///   sentence for each limit that was reached. Arrays of numbers are base64 of little-endian
///   uint32 or float32.
/// - `model-data`: the triangles of each model, in page units relative to the model's centre.
/// - `frame-data`: the shown frames. `moved` are numbers of objects; `poses` has for each the
///   quaternion w, x, y, z and the place of the model's centre, in page units. An object stays
///   until it is listed again. `lit` has pairs of an object and its triangles. `hits` has a, b and
///   a bit for each effect; `contacts` a, b and point, normal, lower, upper; `distances` a, b and
///   two points, lower, upper. Bounds are in model units.
/// - `changing` in `scene-data` has the live models, null for one that is drawn at rest. Each has
///   its objects and two `topologies`, at rest and torn: vertices of triangles, and their numbers.
///   `shapes` in `frame-data` has the number of a live model, that of its topology, and three
///   float32 for each vertex. They count from the centre of the model, in page units. The model has
///   this shape until it is listed again.
/// - `plan-data` and `plan-text`: what `--plan` prints.
class ScenePage {
public:
    /// All arguments must outlive the object. `count` is the number of frames of the run.
    ScenePage(const scenes::SceneFile& file, std::span<const scenes::SceneModel> models,
              std::uint64_t count, const ScenePageOptions& options);

    /// Adds the last frame of a simulation; 0 is first. Fails if an object leaves the range of
    /// coordinates.
    [[nodiscard]] Result<Done> add_frame(std::uint64_t frame, const scenes::Simulation& simulation);

    /// Returns the page. Call it once, after the last frame. `costs` are those of --cost.
    [[nodiscard]] std::string finish(const scenes::Simulation& simulation,
                                     std::span<const EffectCost> costs = {});

    [[nodiscard]] const SceneTimeline& timeline() const noexcept {
        return timeline_;
    }
    /// Returns a sentence for each limit of the page that was reached. Call it after finish().
    [[nodiscard]] const std::vector<std::string>& left_out() const noexcept {
        return left_out_;
    }

private:
    /// An event on the page.
    struct ListedEvent {
        std::uint32_t frame;
        std::uint32_t a;  ///< in SceneFile::objects
        std::uint32_t b;
        std::uint32_t what;  ///< effect number, 16 times EventKind, 64 times EventReason
    };

    void list_events(std::uint64_t frame, const scenes::Simulation& simulation);

    const scenes::SceneFile& file_;
    std::span<const scenes::SceneModel> models_;
    std::uint64_t count_;
    ScenePageOptions options_;
    SceneFrames frames_;
    SceneTimeline timeline_;
    std::vector<ListedEvent> events_;
    std::uint64_t events_left_out_ = 0;
    std::vector<std::string> left_out_;
};

}  // namespace cdprep::report
