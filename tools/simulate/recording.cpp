// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/recording.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "simulate/event_json.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/space_name.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kMark = "{\"cdprep_recording\":";
constexpr std::uint64_t kVersion = 1;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 40;

std::string hash_of(const SceneModel& model) {
    return model.model ? report::hexadecimal(model.model->header().content_hash) : "";
}

/// An object, and the rows of its pose: rotation, then translation.
Json pose_json(std::uint32_t object, const Pose& pose) {
    Json json = Json::array({object});
    for (const double number : pose.rotation()) json.push_back(number);
    const Double3& t = pose.translation();
    for (const double number : {t.x, t.y, t.z}) json.push_back(number);
    return json;
}

/// The reverse. Nothing if it is none.
std::optional<GivenPose> pose_from(const Json& json, std::size_t objects) {
    constexpr std::size_t kRows = 12;
    if (!json.is_array() || json.size() != kRows + 1) return std::nullopt;
    if (!json[0].is_number_unsigned() || json[0] >= objects) return std::nullopt;
    std::array<double, kRows> rows{};
    for (std::size_t i = 0; i < kRows; ++i) {
        if (!json[i + 1].is_number()) return std::nullopt;
        rows[i] = json[i + 1].get<double>();
    }
    const Result<Pose> pose = Pose::from_rows(rows);
    if (!pose) return std::nullopt;
    return GivenPose{json[0].get<std::uint32_t>(), *pose};
}

/// The options that decide what a mesh becomes, without those that the run left open.
Json import_json(const cdprep::import::ImportOptions& options) {
    Json json = Json::object();
    if (options.metres_per_unit) json["metres_per_unit"] = *options.metres_per_unit;
    if (options.up_axis) json["up_axis"] = report::axis_name(*options.up_axis);
    if (options.allow_empty) json["allow_empty"] = true;
    return json;
}

/// The reverse. Nothing if it is none.
std::optional<cdprep::import::ImportOptions> import_from(const Json& json) {
    using format::UpAxis;
    if (!json.is_object()) return std::nullopt;
    cdprep::import::ImportOptions options;
    const Json unit = json.value("metres_per_unit", Json());
    if (unit.is_number() && unit > 0) options.metres_per_unit = unit.get<double>();
    for (const UpAxis axis : {UpAxis::y, UpAxis::z}) {
        if (json.value("up_axis", Json()) == report::axis_name(axis)) options.up_axis = axis;
    }
    options.allow_empty = json.value("allow_empty", Json()) == true;
    const bool is_understood = import_json(options).size() == json.size();
    return is_understood ? std::optional(options) : std::nullopt;
}

/// Returns a member that is a text, or null.
const std::string* text_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) return nullptr;
    return found->get_ptr<const std::string*>();
}

}  // namespace

Recorder::Recorder(const SceneFile& file, fs::path folder,
                   const cdprep::import::ImportOptions& import)
    : file_(&file), folder_(std::move(folder)), import_(import) {}

std::string Recorder::begin(std::span<const SceneModel> models) const {
    Json hashes = Json::array();
    for (const SceneModel& model : models) hashes.push_back(hash_of(model));
    return report::compact({{"cdprep_recording", kVersion},
                            {"scene", file_->name},
                            {"folder", folder_.generic_string()},
                            {"import", import_json(import_)},
                            {"models", hashes},
                            {"text", file_->text}}) +
           "\n";
}

std::string Recorder::add_frame(std::uint64_t frame, const Simulation& simulation) {
    Json moved = Json::array();
    const std::span<const Pose> poses = simulation.poses();
    for (std::size_t slot = 0; slot < poses.size(); ++slot) {
        if (slot < poses_.size() && are_equal(poses[slot], poses_[slot])) continue;
        moved.push_back(pose_json(simulation.object_number(slot), poses[slot]));
    }
    poses_.assign(poses.begin(), poses.end());
    Json events = Json::array();
    const double time_s = static_cast<double>(frame) * file_->step_s;
    for (const SceneEvent& event : simulation.scene().events()) {
        events.push_back(report::event_json(frame, time_s, event, simulation));
    }
    ++frames_;
    return report::compact({{"frame", frame},
                            {"poses", moved},
                            {"events", events},
                            {"state", report::hexadecimal(simulation.scene().state_hash())}}) +
           "\n";
}

std::string Recorder::finish() const {
    return report::compact({{"frames", frames_}}) + "\n";
}

bool Recording::is_one(const fs::path& path) {
    std::array<char, kMark.size()> start{};
    std::ifstream(path, std::ios::binary).read(start.data(), start.size());
    return std::string_view(start.data(), start.size()) == kMark;
}

Result<Recording> Recording::open(const fs::path& path) {
    Result<import::SourceFile> file = import::SourceFile::open(path, kMostBytes);
    if (!file) return file.error();
    Recording recording(std::move(file).value());
    if (const Result<Done> read = recording.read_first(); !read) return read.error();
    if (const Result<Done> read = recording.read_last(); !read) return read.error();
    recording.folder_ = path.parent_path() / recording.folder_;
    return recording;
}

Error Recording::unreadable(std::string_view what) const {
    return {ErrorCode::unreadable,
            file_.name() + ": line " + std::to_string(line_) + ": " + std::string(what)};
}

std::string_view Recording::take_line() {
    const std::string_view rest = file_.bytes().substr(at_);
    const std::string_view line = rest.substr(0, rest.find('\n'));
    at_ += std::min(line.size() + 1, rest.size());
    ++line_;
    return line;
}

Result<Done> Recording::read_first() {
    const Json first = Json::parse(take_line(), nullptr, false);
    if (!first.is_object()) return unreadable("the line is not a JSON object.");
    const auto version = first.find("cdprep_recording");
    if (version == first.end() || *version != kVersion) {
        return unreadable("this is not a recording of version " + std::to_string(kVersion) + ".");
    }
    const std::string* const name = text_of(first, "scene");
    const std::string* const folder = text_of(first, "folder");
    const std::string* const text = text_of(first, "text");
    const auto models = first.find("models");
    const auto options = import_from(first.value("import", Json()));
    if (name == nullptr || folder == nullptr || text == nullptr || !options ||
        models == first.end() || !models->is_array()) {
        return unreadable(
            "one of the keys scene, folder, import, models and text is missing or wrong.");
    }
    scene_name_ = *name;
    folder_ = *folder;
    scene_text_ = *text;
    import_ = *options;
    for (const Json& model : *models) {
        if (!model.is_string()) return unreadable("the hash of a model is not a string.");
        hashes_.push_back(model.get<std::string>());
    }
    return Done{};
}

Result<Done> Recording::set_import(cdprep::import::ImportOptions& options) const {
    const auto differ = [&](const std::string& option, const std::string& recorded,
                            const std::string& given) {
        return Error{ErrorCode::bad_argument,
                     file_.name() + ": was recorded " + (recorded.empty() ? "without " : "with ") +
                         option + recorded + ", but " + option + given +
                         " is given. A replay uses the import options of the recording: leave " +
                         option + " out."};
    };
    const auto unit = [](const auto& x) { return x ? " " + report::unit_name(*x) : std::string(); };
    const auto axis = [](const auto& x) {
        return x ? std::string(" ") + report::axis_name(*x) : std::string();
    };
    if (options.metres_per_unit && options.metres_per_unit != import_.metres_per_unit) {
        return differ("--unit", unit(import_.metres_per_unit), unit(options.metres_per_unit));
    }
    if (options.up_axis && options.up_axis != import_.up_axis) {
        return differ("--up-axis", axis(import_.up_axis), axis(options.up_axis));
    }
    if (options.allow_empty && !import_.allow_empty) return differ("--allow-empty", "", "");
    options.metres_per_unit = import_.metres_per_unit;
    options.up_axis = import_.up_axis;
    options.allow_empty = import_.allow_empty;
    return Done{};
}

Result<Done> Recording::check_models(const SceneFile& file,
                                     std::span<const SceneModel> models) const {
    for (std::size_t i = 0; i < models.size(); ++i) {
        const std::string found = hash_of(models[i]);
        const std::string recorded = i < hashes_.size() ? hashes_[i] : "";
        if (found == recorded) continue;
        std::string sentence = file_.name() + ": the model ";
        sentence += file.models[i].string();
        sentence += " has hash '" + found + "', but '";
        sentence += recorded + "' was recorded. Record the scene again.";
        return Error{ErrorCode::unreadable, sentence};
    }
    return Done{};
}

Result<Done> Recording::read_last() {
    std::string_view text = file_.bytes();
    if (text.ends_with('\n')) text.remove_suffix(1);
    const Json last = Json::parse(text.substr(text.rfind('\n') + 1), nullptr, false);
    const auto frames = last.is_object() ? last.find("frames") : last.end();
    if (frames == last.end() || !frames->is_number_unsigned()) {
        return Error{
            ErrorCode::unreadable,
            file_.name() +
                ": the last line of the recording, with the number of frames, is missing."};
    }
    frames_ = frames->get<std::uint64_t>();
    if (frames_ == 0) {
        return Error{ErrorCode::unreadable, file_.name() + ": the recording has no frame."};
    }
    return Done{};
}

Result<Done> Recording::check_state(const RecordedFrame& frame, const Scene& scene) const {
    const std::string found = report::hexadecimal(scene.state_hash());
    if (found == frame.state) return Done{};
    return unreadable("frame " + std::to_string(frame.frame) + " gives the state " + found +
                      ", but " + frame.state + " was recorded.");
}

Result<RecordedFrame> Recording::next(std::size_t objects) {
    const Json json = Json::parse(take_line(), nullptr, false);
    if (!json.is_object()) return unreadable("the line is not a JSON object.");
    const auto frame = json.find("frame");
    if (frame == json.end() || *frame != next_frame_) {
        return unreadable("expected frame " + std::to_string(next_frame_) + ".");
    }
    const std::string* const state = text_of(json, "state");
    const auto poses = json.find("poses");
    if (state == nullptr || poses == json.end() || !poses->is_array()) {
        return unreadable("the key state or poses is missing or wrong.");
    }
    RecordedFrame read = {next_frame_++, {}, *state};
    for (const Json& pose : *poses) {
        const std::optional<GivenPose> given = pose_from(pose, objects);
        if (!given) {
            return unreadable("a pose must have the number of an object, below " +
                              std::to_string(objects) + ", and 12 numbers of a rigid motion.");
        }
        read.poses.push_back(*given);
    }
    return read;
}

}  // namespace cdprep::scenes
