// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/read_assembly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "cdprep/format/limits.h"
#include "import/mesh_endings.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;
using import::Affine;
using import::MeshNode;

/// The 3 x 3 part of a transform, row by row.
using Linear = std::array<double, 9>;

Linear linear_of(const Affine& m) {
    return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
}

Affine affine_of(const Linear& m) {
    return {m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, m[6], m[7], m[8], 0};
}

double determinant(const Linear& m) {
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/// Returns the size of a uniform scale, turned or not. Exact without a turn. 0 or less, or without
/// meaning, for other transforms.
double size_of(const Linear& m) {
    const bool is_scale = m == Linear{m[0], 0, 0, 0, m[0], 0, 0, 0, m[0]};
    return is_scale ? m[0] : std::cbrt(determinant(m));
}

/// Returns the largest entry of |M^T M - I|.
double deviation(const Linear& m) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double sum = m[i] * m[j] + m[3 + i] * m[3 + j] + m[6 + i] * m[6 + j];
            most = std::max(most, std::fabs(sum - (i == j ? 1 : 0)));
        }
    }
    return most;
}

/// Splits transforms into models and poses.
class AssemblyReader {
public:
    AssemblyReader(const fs::path& path, import::Assembly file)
        : read_{.file = std::move(file), .scene = {}, .models = {}, .rounding = 0}, path_(path) {}

    Result<AssemblyScene> run() {
        read_.scene.name = path_.string();
        read_.scene.layers = {"objects"};
        read_.scene.has_pairs = false;
        const std::span<const MeshNode> nodes = read_.file.nodes();
        if (nodes.size() > kMostObjects) {
            return Error{ErrorCode::over_budget, path_.string() + ": has " +
                                                     std::to_string(nodes.size()) +
                                                     " nodes with triangles; at most " +
                                                     std::to_string(kMostObjects) + " are read."};
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (const auto error = add(static_cast<std::uint32_t>(i), nodes[i])) return *error;
        }
        return std::move(read_);
    }

private:
    /// The models of nodes with equal meshes.
    struct Models {
        std::map<double, std::uint32_t> by_size;    ///< by their uniform scale
        std::map<Linear, std::uint32_t> by_linear;  ///< of all other transforms
    };

    std::optional<Error> add(std::uint32_t number, const MeshNode& node) {
        const Affine& m = node.world_from_node;
        for (const double x : m) {
            if (std::fabs(x) <= format::kMaxCoordinate) continue;  // false for NaN
            return Error{ErrorCode::unreadable,
                         path_.string() + ": the transform of node '" + node.path +
                             "' has the number " + report::number_text(x) + "; at most " +
                             report::number_text(format::kMaxCoordinate) + " is allowed."};
        }
        FileObject object;
        object.name = unique_name(node.path);
        Models& models = models_[node.meshes];
        const Linear linear = linear_of(m);
        Pose pose;
        if (const auto size = find_size(models, linear, m, pose)) {
            const Linear scale = {*size, 0, 0, 0, *size, 0, 0, 0, *size};
            const auto [at, is_new] = models.by_size.try_emplace(*size, next_model());
            if (is_new) add_model(number, affine_of(scale));
            object.model = at->second;
        } else {
            pose = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, m[3], m[7], m[11]}).value();
            const auto [at, is_new] = models.by_linear.try_emplace(linear, next_model());
            if (is_new) add_model(number, affine_of(linear));
            object.model = at->second;
        }
        object.motion = static_cast<std::uint32_t>(read_.scene.motions.size());
        read_.scene.motions.push_back(Motion::fixed(pose));
        read_.scene.objects.push_back(std::move(object));
        return std::nullopt;
    }

    /// Returns the size of a uniform scale, and the pose that remains; nothing for any other
    /// transform. The size is that of an earlier model of these meshes, if that is near enough.
    std::optional<double> find_size(const Models& models, const Linear& linear, const Affine& m,
                                    Pose& pose) {
        const double own = size_of(linear);
        if (!(own > 0)) return std::nullopt;
        const auto near = models.by_size.lower_bound(own * (1 - kFloatRounding));
        const std::array<double, 3> sizes = {1, near == models.by_size.end() ? own : near->first,
                                             own};
        // What is rigid as it stands is not rounded to the size of another model.
        for (const double size : sizes) {
            if (is_exact_pose(linear, size, m, pose)) return size;
        }
        for (const double size : sizes) {
            if (is_pose(linear, size, m, pose)) return size;
        }
        return std::nullopt;
    }

    /// Returns whether a transform divided by a size is rigid.
    static bool is_exact_pose(Linear linear, double size, const Affine& m, Pose& pose) {
        for (double& x : linear) x /= size;
        const Linear& r = linear;
        const Result<Pose> exact = Pose::from_rows(
            {r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], m[3], m[7], m[11]});
        if (exact) pose = *exact;
        return static_cast<bool>(exact);
    }

    /// Returns whether a transform divided by a size is rigid, up to rounding.
    bool is_pose(Linear linear, double size, const Affine& m, Pose& pose) {
        for (double& x : linear) x /= size;
        const double off = deviation(linear);
        if (!(off <= kFloatRounding)) return false;
        const Linear& r = linear;
        const Result<Pose> nearest = nearest_pose(
            {r[0], r[1], r[2], m[3], r[3], r[4], r[5], m[7], r[6], r[7], r[8], m[11], 0, 0, 0, 1},
            kFloatRounding);
        if (!nearest) return false;
        pose = *nearest;
        read_.rounding = std::max(read_.rounding, off);
        return true;
    }

    [[nodiscard]] std::uint32_t next_model() const {
        return static_cast<std::uint32_t>(read_.models.size());
    }

    void add_model(std::uint32_t node, const Affine& model_from_mesh) {
        read_.models.push_back({AssemblyNode{node, model_from_mesh}});
        read_.scene.models.emplace_back(path_.string() + "/" + read_.file.nodes()[node].path);
    }

    /// Returns the path, or with the first number that makes a new name of it.
    std::string unique_name(const std::string& path) {
        std::uint32_t& uses = uses_[path];
        std::string name = path;
        do {
            if (++uses > 1) name = path + "#" + std::to_string(uses);
        } while (!names_.insert(name).second);
        return name;
    }

    AssemblyScene read_;
    const fs::path& path_;
    std::map<std::vector<std::uint32_t>, Models> models_;
    std::map<std::string, std::uint32_t> uses_;
    std::set<std::string> names_;
};

}  // namespace

bool is_assembly(const fs::path& path) {
    const std::string extension = import::lower_extension(path);
    if (extension == ".gltf" || extension == ".glb") return true;
    std::array<char, 4> magic{};
    std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
    return std::string_view(magic.data(), magic.size()) == "glTF";
}

Result<AssemblyScene> read_assembly(const fs::path& path, const import::ImportOptions& options) {
    Result<import::Assembly> file = import::Assembly::open(path, options);
    if (!file) return file.error();
    return AssemblyReader(path, std::move(file).value()).run();
}

}  // namespace cdprep::scenes
