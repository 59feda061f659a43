// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/flatten_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cdprep/exact/predicates.h"
#include "cdprep/format/limits.h"
#include "import/join_chunks.h"

namespace cdprep::import {
namespace {

using mesh::Double3;

constexpr Affine kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Affine to_affine(const std::array<double, 16>& matrix) {
    Affine result;
    std::copy_n(matrix.begin(), result.size(), result.begin());
    return result;
}

/// Returns a * b: world_from_node of a child from world_from_node of its parent and
/// parent_from_node of the child.
Affine compose(const Affine& a, const Affine& b) {
    Affine result;
    for (std::size_t row = 0; row < 3; ++row) {
        const double* r = a.data() + 4 * row;
        for (std::size_t column = 0; column < 4; ++column) {
            const double sum = r[0] * b[column] + r[1] * b[4 + column] + r[2] * b[8 + column];
            result[4 * row + column] = column == 3 ? sum + r[3] : sum;
        }
    }
    return result;
}

Double3 apply(const Affine& m, const Double3& p) {
    return {((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3],
            ((m[4] * p.x + m[5] * p.y) + m[6] * p.z) + m[7],
            ((m[8] * p.x + m[9] * p.y) + m[10] * p.z) + m[11]};
}

bool mirrors(const Affine& m) {
    if (!std::all_of(m.begin(), m.end(),
                     [](double x) { return std::fabs(x) <= format::kMaxCoordinate; })) {
        return false;
    }
    return exact::orient3d({m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {0, 0, 0}) <
           0;
}

/// A cursor over consecutive arrays in bytes that are neither aligned nor checked.
class ArrayCursor {
public:
    explicit ArrayCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// Takes `count` elements of T and moves past them. Returns false if fewer are left.
    template <class T>
    bool take(std::uint64_t count, std::span<const std::byte>& part) noexcept {
        if (count > bytes_.size() / sizeof(T)) return false;
        part = bytes_.first(count * sizeof(T));
        bytes_ = bytes_.subspan(part.size());
        return true;
    }

    [[nodiscard]] bool at_end() const noexcept {
        return bytes_.empty();
    }

private:
    std::span<const std::byte> bytes_;
};

template <class T>
T element(std::span<const std::byte> part, std::size_t i) noexcept {
    T value;
    std::memcpy(&value, part.data() + i * sizeof(T), sizeof(T));
    return value;
}

struct Arrays {
    SceneHeader header;
    std::span<const std::byte> meshes, nodes, node_meshes, materials, files, vertices, sizes,
        corners, text;
};

std::optional<Arrays> find_arrays(std::span<const std::byte> bytes) noexcept {
    Arrays a{};
    ArrayCursor cursor(bytes);
    std::span<const std::byte> header;
    if (!cursor.take<SceneHeader>(1, header)) return std::nullopt;
    a.header = element<SceneHeader>(header, 0);
    const SceneHeader& h = a.header;
    const bool whole = h.magic == kSceneMagic && cursor.take<SceneMesh>(h.mesh_count, a.meshes) &&
                       cursor.take<SceneNode>(h.node_count, a.nodes) &&
                       cursor.take<std::uint32_t>(h.node_mesh_count, a.node_meshes) &&
                       cursor.take<std::uint32_t>(h.material_count, a.materials) &&
                       cursor.take<std::uint32_t>(h.file_count, a.files) &&
                       cursor.take<std::array<double, 3>>(h.vertex_count, a.vertices) &&
                       cursor.take<std::uint32_t>(h.face_count, a.sizes) &&
                       cursor.take<std::uint32_t>(h.corner_count, a.corners) &&
                       cursor.take<char>(h.text_bytes, a.text) && cursor.at_end();
    return whole ? std::optional<Arrays>(a) : std::nullopt;
}

/// The starts of a mesh's arrays, and its number of triangles.
struct MeshPlace {
    SceneMesh counts;
    std::uint64_t first_vertex = 0;
    std::uint64_t first_face = 0;
    std::uint64_t first_corner = 0;
    std::uint64_t triangle_count = 0;
};

/// One use of a mesh by a node.
struct Use {
    std::uint32_t mesh;
    std::uint32_t node;
    Affine model_from_mesh;
};

}  // namespace

class PlacedScene::Content {
public:
    Content(const SourceFile& file, const Arrays& arrays) : file_(file), arrays_(arrays) {}

    /// Returns false if the counts contradict each other.
    bool place() {
        return place_meshes() && place_nodes() && take_names(arrays_.materials, materials_) &&
               take_names(arrays_.files, other_files_);
    }

    [[nodiscard]] Result<mesh::TriangleSoup> flatten(std::span<const Use> uses,
                                                     const ImportOptions& options) const {
        if (auto excess = find_excess(uses, options)) return *std::move(excess);
        std::vector<PolygonChunk> chunks(uses.size());
        options.parallel_for(uses.size(), [&](std::size_t i) { chunks[i] = read_use(uses[i]); });
        Result<mesh::TriangleSoup> joined = join_chunks(file_, std::move(chunks),
                                                        {.face_numbers = FaceNumbers::every_chunk,
                                                         .memory_bytes = options.memory_bytes,
                                                         .parallel_for = options.parallel_for});
        if (joined) describe(uses, joined.value());
        return joined;
    }

    /// The uses of all nodes, in order.
    [[nodiscard]] std::span<const Use> uses() const noexcept {
        return uses_;
    }

    [[nodiscard]] std::span<const Affine> model_from_nodes() const noexcept {
        return model_from_node_;
    }

    /// Returns "root/arm/hand". It is built on demand, because deep scenes have long paths.
    [[nodiscard]] std::string path_of(std::uint32_t node) const {
        constexpr std::size_t kMaxPathBytes = 4096;
        std::vector<std::string_view> parts;
        std::size_t bytes = 0;
        for (std::uint32_t n = node; n != kNoParent && bytes <= kMaxPathBytes; n = parents_[n]) {
            parts.emplace_back(names_[n]);
            bytes += names_[n].size() + 1;
            if (bytes > kMaxPathBytes && parts.size() > 1) parts.back() = "...";
        }
        std::string path;
        for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
            if (!path.empty()) path += '/';
            path += *part;
        }
        return path;
    }

private:
    bool place_meshes() {
        MeshPlace next{};
        for (std::size_t i = 0; i < arrays_.header.mesh_count; ++i) {
            next.counts = element<SceneMesh>(arrays_.meshes, i);
            if (next.counts.vertex_count > arrays_.header.vertex_count - next.first_vertex ||
                next.counts.face_count > arrays_.header.face_count - next.first_face ||
                next.counts.corner_count > arrays_.header.corner_count - next.first_corner) {
                return false;
            }
            std::uint64_t corners = 0;
            next.triangle_count = 0;
            for (std::uint64_t f = 0; f < next.counts.face_count; ++f) {
                const auto size = element<std::uint32_t>(arrays_.sizes, next.first_face + f);
                corners += size;
                next.triangle_count += size < 3 ? 0 : size - 2;
            }
            if (corners != next.counts.corner_count) return false;
            meshes_.push_back(next);
            next.first_vertex += next.counts.vertex_count;
            next.first_face += next.counts.face_count;
            next.first_corner += next.counts.corner_count;
        }
        return true;
    }

    bool take_text(std::uint64_t bytes, std::string& name) {
        if (bytes > arrays_.text.size() - text_used_) return false;
        const auto* text = reinterpret_cast<const char*>(arrays_.text.data()) + text_used_;
        name = utf8_name({text, bytes});
        text_used_ += bytes;
        return true;
    }

    bool place_nodes() {
        std::uint64_t next_mesh = 0;
        for (std::uint32_t i = 0; i < arrays_.header.node_count; ++i) {
            const auto node = element<SceneNode>(arrays_.nodes, i);
            if (node.parent != kNoParent && node.parent >= i) return false;
            if (node.mesh_count > arrays_.header.node_mesh_count - next_mesh) return false;
            std::string name;
            if (!take_text(node.name_bytes, name)) return false;
            names_.push_back(std::move(name));
            parents_.push_back(node.parent);
            const Affine own = to_affine(node.parent_from_node);
            const bool is_root = node.parent == kNoParent;
            model_from_node_.push_back(is_root ? own
                                       : own == kIdentity
                                           ? model_from_node_[node.parent]
                                           : compose(model_from_node_[node.parent], own));
            for (std::uint32_t m = 0; m < node.mesh_count; ++m) {
                const auto mesh = element<std::uint32_t>(arrays_.node_meshes, next_mesh++);
                if (mesh >= meshes_.size()) return false;
                if (meshes_[mesh].triangle_count == 0) continue;
                uses_.push_back(
                    {mesh, i, node.is_posed == 1 ? kIdentity : model_from_node_.back()});
            }
        }
        return true;
    }

    bool take_names(std::span<const std::byte> sizes, std::vector<std::string>& names) {
        for (std::size_t i = 0; i < sizes.size() / sizeof(std::uint32_t); ++i) {
            std::string name;
            if (!take_text(element<std::uint32_t>(sizes, i), name)) return false;
            names.push_back(std::move(name));
        }
        return true;
    }

    /// Returns an error if the scene is too large. Instances multiply the content of the file, so
    /// their size is computed before they are made.
    [[nodiscard]] std::optional<Error> find_excess(std::span<const Use> uses,
                                                   const ImportOptions& options) const {
        std::uint64_t bytes = 0;
        for (const Use& use : uses) {
            const MeshPlace& place = meshes_[use.mesh];
            bytes += 2 * (place.counts.vertex_count * sizeof(Double3) +
                          place.triangle_count * sizeof(mesh::Triangle));
            if (bytes > options.memory_bytes) {
                return file_.over_budget("its instances need more than the limit of " +
                                         std::to_string(options.memory_bytes >> 20) +
                                         " MiB of memory. Raise --import-memory to read it");
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] PolygonChunk read_use(const Use& use) const {
        const MeshPlace& place = meshes_[use.mesh];
        const Affine& model_from_mesh = use.model_from_mesh;
        PolygonChunk chunk;
        chunk.single_precision = model_from_mesh == kIdentity && place.counts.is_single == 1;
        chunk.positions.reserve(place.counts.vertex_count);
        for (std::uint64_t i = 0; i < place.counts.vertex_count; ++i) {
            const auto stored = element<Double3>(arrays_.vertices, place.first_vertex + i);
            chunk.positions.push_back(
                model_from_mesh == kIdentity ? stored : apply(model_from_mesh, stored));
        }
        read_faces(place, mirrors(model_from_mesh), chunk);
        const bool named = place.counts.material < materials_.size();
        if (!materials_.empty()) {
            chunk.materials.push_back({0, named ? materials_[place.counts.material] : ""});
        }
        return chunk;
    }

    void read_faces(const MeshPlace& place, bool reversed, PolygonChunk& chunk) const {
        std::uint64_t first = place.first_corner;
        for (std::uint64_t f = 0; f < place.counts.face_count; ++f) {
            const auto size = element<std::uint32_t>(arrays_.sizes, place.first_face + f);
            for (std::uint32_t c = 0; c < size; ++c) {
                const std::uint32_t from = reversed && c > 0 ? size - c : c;
                add_corner(place, element<std::uint32_t>(arrays_.corners, first + from), chunk);
            }
            chunk.end_face(size);
            first += size;
        }
    }

    static void add_corner(const MeshPlace& place, std::uint32_t index, PolygonChunk& chunk) {
        if (index < place.counts.vertex_count && index < PolygonChunk::kFromChunkStart) {
            chunk.corners.push_back(PolygonChunk::kFromChunkStart | index);
            return;
        }
        // The index is out of range for this mesh, though perhaps a vertex of another mesh.
        chunk.odd.push_back({chunk.corners.size(), index, -1, false});
        chunk.corners.push_back(0);
    }

    void describe(std::span<const Use> uses, mesh::TriangleSoup& soup) const {
        for (const std::string& name : other_files_) soup.other_files.push_back({name, 0});
        if (const std::uint64_t count = arrays_.header.unposed_meshes; count > 0) {
            soup.remarks.push_back(
                std::to_string(count) + (count == 1 ? " mesh has" : " meshes have") +
                " a skin or morph weights, which are not applied: vertices stay as stored.");
        }
        if (const std::uint64_t count = arrays_.header.weightless_vertices; count > 0) {
            soup.remarks.push_back(
                std::to_string(count) +
                (count == 1 ? " vertex of a skin has no joint weights: it follows its first joint."
                            : " vertices of skins have no joint weights: they follow their first "
                              "joints."));
        }
        soup.metres_per_unit =
            std::isfinite(arrays_.header.metres_per_unit) && arrays_.header.metres_per_unit > 0
                ? arrays_.header.metres_per_unit
                : 0;
        if (arrays_.header.up_axis <= static_cast<std::uint32_t>(format::UpAxis::z)) {
            soup.up_axis = static_cast<format::UpAxis>(arrays_.header.up_axis);
        }
        std::uint32_t first = 0;
        for (std::size_t i = 0; i < uses.size(); ++i) {
            const Use& use = uses[i];
            const auto count = static_cast<std::uint32_t>(meshes_[use.mesh].triangle_count);
            if (i == 0 || uses[i - 1].node != use.node) {
                soup.instance_names.push_back(path_of(use.node));
            }
            soup.instances.push_back(
                {.model_from_node = use.model_from_mesh,
                 .mesh = use.mesh,
                 .name = static_cast<std::uint32_t>(soup.instance_names.size() - 1),
                 .first_triangle = first,
                 .triangle_count = count,
                 .flags = mirrors(use.model_from_mesh)
                              ? static_cast<std::uint32_t>(format::instance_mirrored)
                              : 0,
                 .reserved = 0});
            first += count;
        }
        limit_bad_numbers(soup);
    }

    /// Sets the limit of each bad index to the vertex count of its own mesh.
    void limit_bad_numbers(mesh::TriangleSoup& soup) const {
        for (mesh::BadNumber& bad : soup.bad_numbers) {
            if (bad.kind != mesh::BadNumber::Kind::index_out_of_range) continue;
            const auto after = std::upper_bound(
                soup.instances.begin(), soup.instances.end(), bad.triangle,
                [](std::uint32_t t, const format::Instance& i) { return t < i.first_triangle; });
            const std::uint32_t mesh = std::prev(after)->mesh;
            bad.limit = static_cast<std::int64_t>(meshes_[mesh].counts.vertex_count);
        }
    }

    const SourceFile& file_;
    const Arrays arrays_;
    std::vector<MeshPlace> meshes_;
    std::vector<Use> uses_;
    std::vector<std::string> names_;
    std::vector<std::uint32_t> parents_;
    std::vector<Affine> model_from_node_;
    std::vector<std::string> materials_;
    std::vector<std::string> other_files_;
    std::size_t text_used_ = 0;
};

PlacedScene::PlacedScene(std::unique_ptr<const Content> content) noexcept
    : content_(std::move(content)) {}
PlacedScene::PlacedScene(PlacedScene&&) noexcept = default;
PlacedScene& PlacedScene::operator=(PlacedScene&&) noexcept = default;
PlacedScene::~PlacedScene() = default;

Result<PlacedScene> PlacedScene::make(const SourceFile& file, std::span<const std::byte> bytes) {
    const auto arrays = find_arrays(bytes);
    if (!arrays) return file.unreadable("the importing child's result is incomplete");
    auto content = std::make_unique<Content>(file, *arrays);
    if (!content->place()) {
        return file.unreadable("the importing child's result is inconsistent");
    }
    return PlacedScene(std::move(content));
}

Result<mesh::TriangleSoup> PlacedScene::flatten(const ImportOptions& options) const {
    return content_->flatten(content_->uses(), options);
}

Result<mesh::TriangleSoup> PlacedScene::flatten_nodes(std::span<const PlacedNode> nodes,
                                                      const ImportOptions& options) const {
    std::vector<Use> uses;
    for (const PlacedNode& placed : nodes) {
        for (const std::uint32_t mesh : placed.node->meshes) {
            uses.push_back({mesh, placed.node->number, placed.model_from_mesh});
        }
    }
    return content_->flatten(uses, options);
}

std::string PlacedScene::path_of(std::uint32_t number) const {
    return content_->path_of(number);
}

std::vector<MeshNode> PlacedScene::mesh_nodes() const {
    std::vector<MeshNode> nodes;
    for (const Use& use : content_->uses()) {
        if (nodes.empty() || nodes.back().number != use.node) {
            nodes.push_back({use.node, content_->path_of(use.node), {}, use.model_from_mesh});
        }
        nodes.back().meshes.push_back(use.mesh);
    }
    return nodes;
}

std::span<const Affine> PlacedScene::world_from_nodes() const noexcept {
    return content_->model_from_nodes();
}

std::optional<SceneHeader> read_scene_header(std::span<const std::byte> bytes) noexcept {
    const auto arrays = find_arrays(bytes);
    return arrays ? std::optional<SceneHeader>(arrays->header) : std::nullopt;
}

Result<mesh::TriangleSoup> flatten_scene(const SourceFile& file, std::span<const std::byte> bytes,
                                         const ImportOptions& options) {
    const Result<PlacedScene> scene = PlacedScene::make(file, bytes);
    return scene ? scene->flatten(options) : scene.error();
}

}  // namespace cdprep::import
