// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/read_scene.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>
#include <system_error>
#include <utility>

#include "cli/output_path.h"
#include "import/source_file.h"
#include "scene_file/effect_words.h"
#include "scene_file/json_element.h"
#include "scene_file/read_body.h"
#include "scene_file/read_change.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

/// The copies of an object on a grid.
struct Grid {
    std::vector<std::uint32_t> counts = {1, 1, 1};
    Double3 spacing{};

    [[nodiscard]] std::uint64_t size() const {
        return std::uint64_t{1} * counts[0] * counts[1] * counts[2];
    }
};

/// Reads one file.
class Reader {
public:
    Reader(const JsonFile& file, const fs::path& folder) : file_(file), folder_(folder) {}

    SceneReading run() {
        scene_.name = file_.name;
        read_root(JsonElement(file_, errors_));
        if (!errors_.empty()) return {std::nullopt, std::move(errors_)};
        return {std::move(scene_), {}};
    }

private:
    void read_root(const JsonElement& root) {
        // Other errors of a file that is no scene would mislead.
        if (!root.keys()) return;
        const auto version = root.require("cdprep_scene");
        if (!version || !is_one(*version)) return;
        // Unknown keys are errors, but hide no others.
        static_cast<void>(
            root.is_object_of({"$schema", "cdprep_scene", "metres_per_unit", "step_s", "duration_s",
                               "gravity", "dynamics", "limits", "layers", "pairs", "objects"}));
        if (const auto schema = root.find("$schema")) static_cast<void>(schema->text());
        read_above_zero(root, "metres_per_unit", scene_.metres_per_unit);
        read_above_zero(root, "step_s", scene_.step_s);
        if (const auto duration = root.find("duration_s")) {
            scene_.duration_s = duration->number(Range::zero_or_more).value_or(0);
        }
        scene_.dynamics = read_dynamics(root);
        if (const auto limits = root.find("limits")) read_limits(*limits);
        read_layers(root);
        scene_.has_pairs = root.find("pairs").has_value();
        if (scene_.has_pairs) {
            for_each_item(root, "pairs", [&](const JsonElement& pair) { read_pair(pair); });
        }
        for_each_item(root, "objects", [&](const JsonElement& object) { read_object(object); });
        if (!scene_.bodies.empty() && !root.find("gravity")) {
            root.refuse(
                "there are bodies, but the key 'gravity' is missing: for example [0, 0, -9.81] in "
                "metres, or [0, 0, 0] for none.");
        }
    }

    static bool is_one(const JsonElement& version) {
        const auto number = version.whole(0);
        if (number && *number != 1) {
            version.refuse("found version " + std::to_string(*number) +
                           "; this program reads version 1.");
        }
        return number == 1;
    }

    static void read_above_zero(const JsonElement& parent, const char* key, double& value) {
        const auto member = parent.find(key);
        if (member) value = member->number(Range::above_zero).value_or(value);
    }

    /// Calls `visit` with each element of an array that must be there.
    template <class Visit>
    static void for_each_item(const JsonElement& parent, const char* key, const Visit& visit) {
        const auto member = parent.require(key);
        const auto items = member ? member->items() : std::nullopt;
        if (!items) return;
        for (const JsonElement& item : *items) visit(item);
    }

    void read_limits(const JsonElement& limits) {
        if (!limits.is_object_of({"pairs"})) return;
        if (const auto pairs = limits.find("pairs")) scene_.most_pairs = pairs->whole(1);
    }

    void read_layers(const JsonElement& root) {
        const std::size_t errors = errors_.size();
        for_each_item(root, "layers", [&](const JsonElement& layer) {
            const auto name = layer.text();
            if (!name) return;
            if (std::find(scene_.layers.begin(), scene_.layers.end(), *name) !=
                scene_.layers.end()) {
                layer.refuse("the layer '" + *name + "' occurs twice.");
            }
            scene_.layers.push_back(*name);
            if (scene_.layers.size() == kLayers + 1) {
                layer.refuse("a scene has at most " + std::to_string(kLayers) + " layers.");
            }
        });
        are_layers_refused_ = errors_.size() > errors;
    }

    std::optional<std::uint32_t> read_layer(const JsonElement& element) {
        if (scene_.layers.empty()) {
            if (!are_layers_refused_) element.refuse_value("a layer, but the scene has no layers");
            return std::nullopt;
        }
        const auto number = element.one_of(scene_.layers, "a layer");
        if (!number) return std::nullopt;
        return static_cast<std::uint32_t>(*number);
    }

    // --- Pairs -----------------------------------------------------------------------

    void read_pair(const JsonElement& element) {
        AskedPair pair{.line = element.line()};
        if (!element.is_object_of({"layers", "effects", "tolerance", "max_distance", "max_error",
                                   "body", "overlap", "contacts", "impact", "work", "events"})) {
            return;
        }
        if (const auto layers = element.require("layers")) read_pair_layers(*layers, pair.asked);
        for_each_item(element, "effects",
                      [&](const JsonElement& effect) { read_effect(effect, pair); });
        const auto read_length = [&](const char* key, double& length) {
            const auto member = element.find(key);
            if (member) length = member->number(Range::zero_or_more).value_or(0);
        };
        read_length("tolerance", pair.asked.tolerance);
        read_length("max_distance", pair.asked.max_distance);
        read_length("max_error", pair.asked.max_error);
        if (const auto body = element.find("body")) {
            const auto word = body->one_of(Names{"surface", "solid"}, "a body");
            pair.asked.body = word == 1 ? Body::solid : Body::surface;
        }
        if (const auto overlap = element.find("overlap")) {
            const auto word = overlap->one_of(Names{"closed", "proper"}, "a kind of overlap");
            pair.asked.overlap = word == 1 ? Overlap::proper : Overlap::closed;
        }
        if (const auto contacts = element.find("contacts")) {
            if (!contains(pair.asked.effects, Ask::contacts)) {
                contacts->refuse("the pair does not request contacts.");
            }
            read_contacts(*contacts, pair.asked.contacts);
        }
        if (const auto impact = element.find("impact")) {
            if (!contains(pair.asked.effects, Ask::continuous)) {
                impact->refuse("the pair does not request continuous.");
            }
            read_impact(*impact, pair.asked.impact);
        }
        if (const auto work = element.find("work")) pair.asked.work = work->whole(1).value_or(1);
        if (element.find("events")) read_events(element, pair);
        scene_.pairs.push_back(pair);
    }

    void read_pair_layers(const JsonElement& element, LayerPair& pair) {
        const auto layers = element.items();
        if (!layers) return;
        if (layers->size() != 2) return element.refuse_value("an array of 2 layers");
        pair.a = read_layer((*layers)[0]).value_or(0);
        pair.b = read_layer((*layers)[1]).value_or(0);
    }

    static void read_effect(const JsonElement& element, AskedPair& pair) {
        const std::vector<std::string> words = effect_words();
        const auto number = element.one_of(words, "an effect");
        if (number) pair.asked.effects = pair.asked.effects | effect_of(words[*number]);
    }

    static void read_contacts(const JsonElement& element, ContactOptions& options) {
        if (!element.is_object_of({"tolerance", "manifold", "most", "work", "cluster_deg"})) return;
        if (const auto tolerance = element.find("tolerance")) {
            options.tolerance = tolerance->number(Range::zero_or_more).value_or(0);
        }
        if (const auto manifold = element.find("manifold")) {
            options.manifold =
                manifold->boolean().value_or(false) ? Manifold::four : Manifold::none;
        }
        if (const auto most = element.find("most")) {
            options.most = most->whole(1, kMostListedContacts).value_or(1);
        }
        if (const auto work = element.find("work")) {
            options.work = work->whole(1).value_or(1);
        }
        if (const auto cluster = element.find("cluster_deg")) {
            const double degrees = cluster->number(Range::zero_or_more).value_or(0);
            options.cluster_angle = degrees * std::numbers::pi / 180;
        }
    }

    static void read_impact(const JsonElement& element, ImpactOptions& options) {
        if (!element.is_object_of({"tolerance", "most_steps"})) return;
        if (const auto tolerance = element.find("tolerance")) {
            options.tolerance = tolerance->number(Range::zero_or_more).value_or(0);
        }
        if (const auto steps = element.find("most_steps")) {
            options.most_steps = steps->whole(1).value_or(1);
        }
    }

    static void read_events(const JsonElement& element, AskedPair& pair) {
        pair.tells_begins = pair.tells_ends = false;
        for_each_item(element, "events", [&](const JsonElement& event) {
            const auto word = event.one_of(Names{"begins", "ends", "stays"}, "an event");
            pair.tells_begins = pair.tells_begins || word == 0;
            pair.tells_ends = pair.tells_ends || word == 1;
            pair.asked.lists_stays = pair.asked.lists_stays || word == 2;
        });
    }

    // --- Objects ---------------------------------------------------------------------

    void read_object(const JsonElement& element) {
        FileObject object;
        if (!element.is_object_of(
                {"name", "model", "layer", "pose", "motion", "material", "instances"})) {
            return;
        }
        const auto name = element.require("name");
        object.name = name ? name->text().value_or("") : "";
        if (const auto model = element.require("model")) object.model = read_model(*model);
        if (const auto layer = element.require("layer")) {
            object.layer = read_layer(*layer).value_or(0);
        }
        object.motion = static_cast<std::uint32_t>(scene_.motions.size());
        scene_.motions.push_back(read_placing(element));
        if (const auto motion = element.find("motion")) {
            object.change = read_change_of(*motion);
            object.body = read_body_of(*motion);
        }
        object.material = read_material(element);
        const auto instances = element.find("instances");
        const Grid grid = instances ? read_grid(*instances) : Grid{};
        if (scene_.objects.size() + grid.size() > kMostObjects) {
            return element.refuse("a scene file has at most " + std::to_string(kMostObjects) +
                                  " objects; with these it would have " +
                                  std::to_string(scene_.objects.size() + grid.size()) + ".");
        }
        if (!name || object.name.empty()) return;
        if (instances) return add_copies(*name, object, grid);
        add(*name, std::move(object));
    }

    /// Returns false if the name is taken.
    bool add(const JsonElement& place, FileObject object) {
        if (!names_.insert(object.name).second) {
            place.refuse("another object has the name '" + object.name + "'.");
            return false;
        }
        scene_.objects.push_back(std::move(object));
        return true;
    }

    void add_copies(const JsonElement& place, const FileObject& object, const Grid& grid) {
        for (std::uint32_t z = 0; z < grid.counts[2]; ++z) {
            for (std::uint32_t y = 0; y < grid.counts[1]; ++y) {
                for (std::uint32_t x = 0; x < grid.counts[0]; ++x) {
                    FileObject copy = object;
                    copy.name += "[" + std::to_string(x) + "," + std::to_string(y) + "," +
                                 std::to_string(z) + "]";
                    copy.offset = {x * grid.spacing.x, y * grid.spacing.y, z * grid.spacing.z};
                    if (!add(place, std::move(copy))) return;
                }
            }
        }
    }

    /// Returns the number of a model. Objects that name one file share it.
    std::uint32_t read_model(const JsonElement& element) {
        const auto text = element.text();
        if (!text) return 0;
        const fs::path path = cli::shortened(folder_ / *text);
        std::error_code unknown;
        if (!fs::is_regular_file(path, unknown)) {
            element.refuse("there is no file " + path.string() + ".");
        }
        const auto number = static_cast<std::uint32_t>(scene_.models.size());
        const auto [at, is_new] = models_.try_emplace(path, number);
        if (is_new) scene_.models.push_back(path);
        return at->second;
    }

    static Grid read_grid(const JsonElement& element) {
        Grid grid;
        if (!element.is_object_of({"counts", "spacing"})) return grid;
        if (const auto spacing = element.require("spacing")) {
            grid.spacing = spacing->vector().value_or(Double3{});
        }
        const auto member = element.require("counts");
        const auto counts = member ? member->items() : std::nullopt;
        if (!counts) return grid;
        if (counts->size() != 3) {
            member->refuse_value("an array of 3 whole numbers");
            return grid;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // The product of three counts then fits into 64 bits.
            const std::uint32_t count = (*counts)[axis].whole(1).value_or(1);
            grid.counts[axis] = std::min(count, kMostObjects + 1);
        }
        return grid;
    }

    // --- Poses and motions -----------------------------------------------------------

    /// Reads the members "pose" and "motion".
    static Motion read_placing(const JsonElement& object) {
        const auto pose = object.find("pose");
        const Pose start = pose ? read_pose(*pose) : Pose();
        const auto motion = object.find("motion");
        if (!motion) return Motion::fixed(start);
        return read_motion(*motion, start, pose.has_value());
    }

    /// Returns the number of a change. Equal changes have one.
    std::uint32_t read_change_of(const JsonElement& motion) {
        if (motion.is_text()) return kUnchanged;
        const std::optional<Change> change = read_change(motion, folder_);
        if (!change) return kUnchanged;
        const auto number = static_cast<std::uint32_t>(scene_.changes.size());
        const auto [at, is_new] = changes_.try_emplace(*change, number);
        if (is_new) scene_.changes.push_back(*change);
        return at->second;
    }

    /// Returns the number of a new body.
    std::uint32_t read_body_of(const JsonElement& motion) {
        const std::optional<BodyMotion> body = read_body(motion);
        if (!body) return kNoBody;
        scene_.bodies.push_back(*body);
        return static_cast<std::uint32_t>(scene_.bodies.size() - 1);
    }

    static Motion read_motion(const JsonElement& element, const Pose& start, bool has_pose) {
        if (element.is_text()) {
            if (!element.is_word("fixed") && !element.is_word("body")) {
                element.refuse_value(
                    "\"fixed\", \"body\", or an object with path, velocity, turn_rad_per_s, "
                    "deform, tear or body");
            }
            return Motion::fixed(start);
        }
        if (!element.is_object_of(
                {"path", "velocity", "turn_rad_per_s", "deform", "tear", "body"})) {
            return Motion::fixed(start);
        }
        if (element.find("body")) return Motion::fixed(start);
        if (element.find("path")) return read_path(element, start, has_pose);
        const auto read_vector = [&](const char* key) {
            const auto member = element.find(key);
            return member ? member->vector().value_or(Double3{}) : Double3{};
        };
        const Double3 velocity = read_vector("velocity");
        if (!element.find("velocity") && !element.find("turn_rad_per_s") &&
            !element.find("deform") && !element.find("tear")) {
            element.refuse(
                "a motion has a path, a velocity, a turn_rad_per_s, a deform, a tear or a body.");
        }
        return Motion::steady(start, velocity, read_vector("turn_rad_per_s"));
    }

    static Motion read_path(const JsonElement& element, const Pose& start, bool has_pose) {
        if (element.find("velocity") || element.find("turn_rad_per_s")) {
            element.refuse("a path cannot be combined with velocity or turn_rad_per_s.");
        }
        if (has_pose) {
            element.refuse(
                "an object with a path cannot have a pose; the keys of the path have poses.");
        }
        std::vector<KeyPose> keys;
        for_each_item(element, "path", [&](const JsonElement& key) { read_key(key, keys); });
        if (!keys.empty()) return Motion::path(std::move(keys));
        element.refuse("the path has no keys.");
        return Motion::fixed(start);
    }

    static void read_key(const JsonElement& element, std::vector<KeyPose>& keys) {
        KeyPose key{};
        if (!element.is_object_of({"time_s", "pose"})) return;
        const auto time = element.require("time_s");
        if (time) key.time_s = time->number(Range::zero_or_more).value_or(0);
        if (const auto pose = element.require("pose")) key.pose = read_pose(*pose);
        if (time && !keys.empty() && key.time_s <= keys.back().time_s) {
            time->refuse_value("a time after that of the previous key");
        }
        keys.push_back(key);
    }

    /// Returns the pose of an object or key, or the identity after an error.
    static Pose read_pose(const JsonElement& element) {
        if (!element.is_object_of({"translation", "quaternion", "matrix"})) return {};
        const Result<Pose> pose =
            element.find("matrix") ? read_matrix(element) : read_parts(element);
        if (pose) return *pose;
        element.refuse(pose.error().message);
        return {};
    }

    /// Reads three rows of four numbers: a rotation, and a translation as the last column.
    static Result<Pose> read_matrix(const JsonElement& element) {
        if (element.find("translation") || element.find("quaternion")) {
            element.refuse("a matrix cannot be combined with translation or quaternion.");
        }
        const JsonElement matrix = *element.find("matrix");
        const auto rows = matrix.items();
        if (!rows) return Pose();
        if (rows->size() != 3) {
            matrix.refuse_value("an array of 3 rows of 4 numbers");
            return Pose();
        }
        std::array<double, 12> numbers = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
        for (std::size_t row = 0; row < 3; ++row) {
            const auto found = (*rows)[row].numbers(4);
            if (!found) return Pose();
            std::copy_n(found->begin(), 3, numbers.begin() + static_cast<std::ptrdiff_t>(3 * row));
            numbers[9 + row] = (*found)[3];
        }
        return Pose::from_rows(numbers);
    }

    static Result<Pose> read_parts(const JsonElement& element) {
        std::vector<double> quaternion = {1, 0, 0, 0};
        Double3 translation{};
        if (const auto member = element.find("quaternion")) {
            quaternion = member->numbers(4).value_or(quaternion);
        }
        if (const auto member = element.find("translation")) {
            translation = member->vector().value_or(Double3{});
        }
        return Pose::from_quaternion(quaternion[0], quaternion[1], quaternion[2], quaternion[3],
                                     translation);
    }

    const JsonFile& file_;
    const fs::path& folder_;
    SceneFile scene_;
    std::vector<std::string> errors_;
    bool are_layers_refused_ = false;
    std::map<fs::path, std::uint32_t> models_;
    std::map<Change, std::uint32_t> changes_;
    std::set<std::string> names_;
};

/// Returns the name of a format for robots, by its root element; or null.
const char* robot_format(std::string_view bytes) {
    constexpr std::size_t kLookedAt = 4096;
    const std::string_view start = bytes.substr(0, kLookedAt);
    if (!start.starts_with('<')) return nullptr;
    const auto has = [&](const char* element) {
        return start.find(element) != std::string_view::npos;
    };
    return has("<robot") ? "URDF" : has("<sdf") ? "SDF" : has("<mujoco") ? "MJCF" : nullptr;
}

}  // namespace

SceneReading parse_scene(const std::string& name, const std::string& text, const fs::path& folder) {
    const Result<JsonFile> file = parse_json_file(name, text);
    if (!file) return {std::nullopt, {file.error().message}};
    SceneReading reading = Reader(*file, folder).run();
    if (reading.scene) reading.scene->text = text;
    return reading;
}

SceneReading read_scene(const fs::path& path) {
    const Result<import::SourceFile> file = import::SourceFile::open(path, kMostBytes);
    if (!file) return {std::nullopt, {file.error().message}};
    if (const char* format = robot_format(file->bytes())) {
        return {std::nullopt,
                {path.string() + ": this is " + format +
                 ", which joins bodies; a scene has no joints. Give a scene file or glTF."}};
    }
    return parse_scene(path.string(), std::string(file->bytes()), path.parent_path());
}

}  // namespace cdprep::scenes
