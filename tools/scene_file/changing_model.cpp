// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/changing_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "mesh/vectors.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

// At most so many triangles of a model are rebuilt in a frame. For large models, rebuilding then
// takes about as long as the refit. LiveModel::rebuild() may do nothing with fewer than 4,096.
constexpr std::uint32_t kLeastRebuilt = 4096;
constexpr std::uint32_t kShareRebuilt = 8;

/// The nearest float; infinity for numbers beyond all floats, which a refit refuses.
float as_float(double x) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    if (std::fabs(x) <= kLargest) return static_cast<float>(x);
    return std::isnan(x) ? std::numeric_limits<float>::quiet_NaN()
                         : static_cast<float>(std::copysign(HUGE_VAL, x));
}

/// Returns the positions of a model by their number in the imported file.
std::vector<Double3> positions_of(const Model& model) {
    const auto& mesh = model.mesh();
    std::vector<Double3> positions(mesh.positions_f64.begin(), mesh.positions_f64.end());
    for (const format::Float3& p : mesh.positions_f32) positions.push_back({p.x, p.y, p.z});
    return positions;
}

/// Returns the triangles of a model, with numbers as in the imported file, by rising number.
std::vector<LiveTriangle> triangles_of(const Model& model) {
    const auto numbers = model.source().vertex, triangles = model.source().triangle;
    std::vector<LiveTriangle> all;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        LiveTriangle triangle = {triangles[i], model.mesh().triangles[i].vertex};
        for (std::uint32_t& vertex : triangle.vertex) vertex = numbers[vertex];
        all.push_back(triangle);
    }
    std::ranges::sort(all, {}, &LiveTriangle::number);
    return all;
}

/// Returns the limits of a live model that will be cut.
LiveLimits limits_for(const Model& base, std::size_t vertices, const Cut& cut) {
    if (cut.misses) return {};
    const std::size_t count = base.triangle_count();
    const std::size_t after = count - cut.removed.size() + cut.appended.size();
    return {.triangles = static_cast<std::uint32_t>(std::max(count, after)),
            .vertices = static_cast<std::uint32_t>(vertices)};
}

}  // namespace

void ChangeWork::add(const ChangeWork& other) noexcept {
    refits += other.refits;
    rebuilt += other.rebuilt;
    torn += other.torn;
    appended += other.appended;
    seconds += other.seconds;
}

Result<ChangingModel> ChangingModel::make(const Model& base, const Change& change,
                                          const std::string& name) {
    ChangingModel made(base, change);
    // The sections are checked before they are read.
    if (const auto bytes = LiveModel::bytes(base); !bytes) return bytes.error();
    const auto numbers = base.source().vertex;
    made.keep_rest(numbers.empty() ? 0 : std::size_t{std::ranges::max(numbers)} + 1);
    if (const auto opened = made.open_stream(name); !opened) return opened.error();
    if (const auto live = made.make_live(); !live) return live.error();
    return made;
}

/// Keeps the model at rest, and its cut.
void ChangingModel::keep_rest(std::size_t count) {
    const std::vector<Double3> positions = positions_of(*base_);
    box_ = RestBox::of(positions);
    rest_count_ = count;
    rest_.resize(count, box_.middle());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        rest_[base_->source().vertex[i]] = positions[i];
    }
    if (change_.tear) cut_ = cut_by_plane(rest_, triangles_of(*base_), *change_.tear);
    for (const CutVertex& vertex : cut_.vertices) rest_.push_back(on_edge(rest_, vertex));
    positions_.resize(rest_.size());
    keeps_floats_ = base_->sections().contains(SectionId::positions_f32);
    if (keeps_floats_) floats_.resize(rest_.size());
}

Result<Done> ChangingModel::open_stream(const std::string& name) {
    const Stream* const stream = change_.deform ? std::get_if<Stream>(&*change_.deform) : nullptr;
    if (stream == nullptr) return Done{};
    Result<PointCache> opened = PointCache::open(stream->file);
    if (!opened) return opened.error();
    stream_.emplace(std::move(opened).value());
    if (stream_->points() >= rest_count_) return Done{};
    return Error{ErrorCode::unreadable, stream_->name() + ": byte 16: found " +
                                            report::counted(stream_->points(), "point", "points") +
                                            "; expected at least " + std::to_string(rest_count_) +
                                            ", the vertices of " + name + "."};
}

Result<Done> ChangingModel::make_live() {
    live_.reset();
    state_.reset();
    const LiveLimits limits = limits_for(*base_, rest_.size(), cut_);
    const Result<std::size_t> bytes = LiveModel::bytes(*base_, limits);
    if (!bytes) return bytes.error();
    memory_.resize((*bytes + sizeof(Block) - 1) / sizeof(Block));
    Result<LiveModel> live =
        LiveModel::in(std::as_writable_bytes(std::span(memory_)), *base_, limits);
    if (!live) return live.error();
    live_.emplace(std::move(live).value());
    return Done{};
}

std::vector<LiveTriangle> ChangingModel::triangles() const {
    if (!is_torn()) return triangles_of(*base_);
    std::vector<LiveTriangle> now(live_->triangle_count());
    live_->triangles(now);
    return now;
}

Result<ChangeWork> ChangingModel::set_time(double time_s, ParallelFor parallel_for) {
    const State state = state_at(time_s);
    if (state == state_) return ChangeWork{};
    const bool was_torn = state_ && state_->is_torn;
    if (was_torn && !state.is_torn) {
        if (const auto made = make_live(); !made) return made.error();
    }
    set_positions(state);
    const std::size_t count = state.is_torn ? rest_.size() : rest_count_;
    const bool tears = state.is_torn && !was_torn;
    const auto begin = std::chrono::steady_clock::now();
    Result<ChangeWork> work =
        keeps_floats_
            ? update(std::span<const format::Float3>(floats_).first(count), tears, parallel_for)
            : update(std::span<const Double3>(positions_).first(count), tears, parallel_for);
    if (!work) return work;
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    work->seconds = taken.count();
    state_ = state;
    ++version_;
    return work;
}

ChangingModel::State ChangingModel::state_at(double time_s) const {
    State state;
    if (change_.deform) {
        if (const auto* shear = std::get_if<Shear>(&*change_.deform)) {
            state.deform = shear->factor(time_s);
        } else if (const auto* twist = std::get_if<Twist>(&*change_.deform)) {
            state.deform = twist->angle(time_s);
        } else {
            const Stream& stream = std::get<Stream>(*change_.deform);
            state.samples = samples_at(time_s, stream.step_s, stream.repeats, stream_->samples());
        }
    }
    state.is_torn = !cut_.misses && time_s >= change_.tear->time_s;
    return state;
}

void ChangingModel::set_positions(const State& state) {
    if (stream_) {
        set_stream(state.samples);
    } else if (!change_.deform) {
        std::ranges::copy(rest_, positions_.begin());
    } else if (const auto* shear = std::get_if<Shear>(&*change_.deform)) {
        scenes::shear(*shear, state.deform, box_, rest_, positions_);
    } else {
        scenes::twist(std::get<Twist>(*change_.deform), state.deform, box_, rest_, positions_);
    }
    if (state.is_torn) open();
    for (std::size_t i = 0; i < floats_.size(); ++i) {
        const Double3& p = positions_[i];
        floats_[i] = {as_float(p.x), as_float(p.y), as_float(p.z)};
    }
}

void ChangingModel::set_stream(const SamplePair& samples) {
    for (std::size_t i = 0; i < rest_count_; ++i) positions_[i] = stream_->at(samples, i);
    for (std::size_t i = 0; i < cut_.vertices.size(); ++i) {
        positions_[rest_count_ + i] = on_edge(positions_, cut_.vertices[i]);
    }
}

/// Moves the sides of the cut apart.
void ChangingModel::open() {
    const Double3 half = half_opening(*change_.tear);
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        const Double3& p = positions_[i];
        positions_[i] = cut_.is_far[i] != 0 ? mesh::plus(p, half) : mesh::minus(p, half);
    }
}

Double3 ChangingModel::on_edge(std::span<const Double3> positions, const CutVertex& at) const {
    const Double3 &a = positions[at.a], &b = positions[at.b];
    return {std::lerp(a.x, b.x, at.share), std::lerp(a.y, b.y, at.share),
            std::lerp(a.z, b.z, at.share)};
}

template <class Position>
Result<ChangeWork> ChangingModel::update(std::span<const Position> positions, bool tears,
                                         ParallelFor parallel_for) {
    ChangeWork work;
    if (tears) {
        // Triangles can only be appended between vertices that have positions.
        std::vector<std::uint32_t> added(positions.size() - rest_count_);
        std::iota(added.begin(), added.end(), static_cast<std::uint32_t>(rest_count_));
        const auto placed = live_->refit(added, positions.subspan(rest_count_), parallel_for);
        if (!placed) return placed.error();
        if (const auto removed = live_->remove(cut_.removed); !removed) return removed.error();
        if (const auto added_all = live_->append(cut_.appended); !added_all) {
            return added_all.error();
        }
        work.torn = cut_.removed.size();
        work.appended = cut_.appended.size();
    }
    if (const auto fitted = live_->refit(positions, parallel_for); !fitted) return fitted.error();
    work.refits = 1;
    work.rebuilt = live_->rebuild(std::max(kLeastRebuilt, live_->triangle_count() / kShareRebuilt));
    return work;
}

Result<std::vector<ChangingObjects>> make_changing_models(const SceneFile& scene, const Plan& plan,
                                                          std::span<const SceneModel> models) {
    std::vector<ChangingObjects> all;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> numbers;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const FileObject& object = scene.objects[i];
        if (object.change == kUnchanged || !is_asked(scene, plan, object)) continue;
        const auto [at, is_new] = numbers.try_emplace({object.model, object.change}, all.size());
        if (is_new) {
            Result<ChangingModel> made =
                ChangingModel::make(*models[object.model].model, scene.changes[object.change],
                                    scene.models[object.model].string());
            if (!made) {
                return Error{made.error().code, scene.name + ": object '" + object.name +
                                                    "': " + made.error().message};
            }
            all.push_back({object.model, object.change, {}, std::move(made).value()});
        }
        all[at->second].objects.push_back(i);
    }
    return all;
}

}  // namespace cdprep::scenes
