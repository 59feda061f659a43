// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/live_model.h"
#include "scene_file/load_models.h"
#include "scene_file/point_cache.h"

namespace cdprep::scenes {

/// The work on live models.
struct ChangeWork {
    std::uint64_t refits = 0;    ///< of all vertices of a model
    std::uint64_t rebuilt = 0;   ///< triangles in subtrees that were rebuilt
    std::uint64_t torn = 0;      ///< triangles that a tear removed
    std::uint64_t appended = 0;  ///< triangles that it appended
    double seconds = 0;          ///< wall time in refit(), rebuild(), append() and remove()

    void add(const ChangeWork& other) noexcept;
};

/// A live model that deforms and tears as a scene file says. The positions of a time are those of
/// the rest positions: deformed, then opened by the tear. New vertices of a tear lie on edges of
/// the model at rest. With a stream, they lie on the edges of its samples.
class ChangingModel {
public:
    /// Makes the live model, at rest. `base` must outlive it, unchanged. Fails if a stream cannot
    /// be read or has fewer points than the model has vertices, and as LiveModel::in(). `name` is
    /// that of the model in messages.
    [[nodiscard]] static Result<ChangingModel> make(const Model& base, const Change& change,
                                                    const std::string& name);

    /// Brings the model to a time, at least 0. Returns what that took: no refit if the model stays
    /// as it is. Fails with bad_argument if a position leaves the range of coordinates. Time may
    /// run backwards: a torn model is then made again.
    [[nodiscard]] Result<ChangeWork> set_time(double time_s, ParallelFor parallel_for);

    /// Returns the model to query. Another object after time ran backwards.
    [[nodiscard]] const Model& model() const noexcept {
        return live_->model();
    }
    /// Returns the live model itself, for its triangles.
    [[nodiscard]] const LiveModel& live() const noexcept {
        return *live_;
    }
    [[nodiscard]] const Cut& cut() const noexcept {
        return cut_;
    }
    /// Returns a number that is another one after each change.
    [[nodiscard]] std::uint64_t version() const noexcept {
        return version_;
    }
    /// Returns whether the plane has cut the model by now.
    [[nodiscard]] bool is_torn() const noexcept {
        return state_ && state_->is_torn;
    }
    /// Returns the triangles as they are now, by rising number. Their vertices are numbered as in
    /// positions().
    [[nodiscard]] std::vector<LiveTriangle> triangles() const;
    /// The positions as they are now, before a model that keeps floats rounds them. Vertices are
    /// numbered as in the imported file; those of the cut follow.
    [[nodiscard]] std::span<const Double3> positions() const noexcept {
        return std::span(positions_).first(is_torn() ? rest_.size() : rest_count_);
    }
    /// The box of the vertices at rest.
    [[nodiscard]] const RestBox& rest_box() const noexcept {
        return box_;
    }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return sizeof(Block) * memory_.size();
    }

private:
    struct alignas(format::kSectionAlignment) Block {
        std::array<std::byte, format::kSectionAlignment> bytes;
    };
    /// All that positions depend on. Equal states have equal positions.
    struct State {
        double deform = 0;  ///< the factor of a shear or the angle of a twist
        SamplePair samples;
        bool is_torn = false;

        bool operator==(const State&) const = default;
    };

    ChangingModel(const Model& base, const Change& change) : base_(&base), change_(change) {}
    [[nodiscard]] Result<Done> open_stream(const std::string& name);
    [[nodiscard]] Result<Done> make_live();
    void keep_rest(std::size_t count);
    [[nodiscard]] State state_at(double time_s) const;
    void set_positions(const State& state);
    void set_stream(const SamplePair& samples);
    void open();
    [[nodiscard]] Double3 on_edge(std::span<const Double3> positions, const CutVertex& at) const;
    template <class Position>
    [[nodiscard]] Result<ChangeWork> update(std::span<const Position> positions, bool tears,
                                            ParallelFor parallel_for);

    const Model* base_;
    Change change_;
    std::optional<PointCache> stream_;
    std::vector<Block> memory_;
    std::optional<LiveModel> live_;
    bool keeps_floats_ = false;
    std::size_t rest_count_ = 0;  ///< vertices before those of the cut
    std::vector<Double3> rest_;   ///< by number, the new vertices of the cut at the end
    RestBox box_;
    Cut cut_;
    std::vector<Double3> positions_;      ///< now
    std::vector<format::Float3> floats_;  ///< the same for a model that keeps floats
    std::optional<State> state_;          ///< of the live model; nothing: not fitted yet
    std::uint64_t version_ = 0;
};

/// The live model of the objects with the same model and change.
struct ChangingObjects {
    std::uint32_t model = 0;             ///< its number in SceneFile::models
    std::uint32_t change = 0;            ///< its number in SceneFile::changes
    std::vector<std::uint32_t> objects;  ///< their numbers in SceneFile::objects, rising
    ChangingModel live;
};

/// Makes the live models of the objects that change, if a pair of layers asks for them. They are in
/// the order of their first objects. Objects with the same model and change have the same shape at
/// each time, so they share one. An error names the object.
[[nodiscard]] Result<std::vector<ChangingObjects>> make_changing_models(
    const SceneFile& scene, const Plan& plan, std::span<const SceneModel> models);

}  // namespace cdprep::scenes
