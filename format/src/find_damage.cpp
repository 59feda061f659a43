// SPDX-License-Identifier: MIT
#include "cdprep/format/find_damage.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "bvh_boxes.h"
#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/checksum.h"
#include "cdprep/format/content_hash.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/make_user_block.h"
#include "cdprep/format/sections.h"
#include "cdprep/format/verdict.h"
#include "section_checks.h"

// Every read copies a few bytes at an offset that was proven to lie inside the file, so the bytes
// may have any alignment. No sum or product of untrusted numbers is formed before it is known not
// to wrap.

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;
using Bytes = std::span<const std::byte>;

constexpr SectionId kUserBlock{0};
constexpr std::uint32_t kKnownFeatures = 0;

template <class T>
T read(Bytes file, std::uint64_t at) noexcept {
    assert(at <= file.size() && sizeof(T) <= file.size() - at);
    T value;
    std::memcpy(&value, file.data() + at, sizeof value);
    return value;
}

Found in_header(DamageKind kind, std::uint64_t at, std::uint64_t found, std::uint64_t limit) {
    return Damage{kind, kUserBlock, at, found, limit};
}

std::uint64_t bits_of(double value) noexcept {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

// --- The user block ------------------------------------------------------------

/// Finds a sign of another format, version or machine.
Found find_foreign(Bytes file, const FileHeader& header) {
    if (header.magic != kMagic) return in_header(DamageKind::bad_magic, 0, 0, 0);
    if (header.endian_mark != kEndianMark || bits_of(header.ieee_check) != bits_of(kIeeeCheck)) {
        return in_header(DamageKind::bad_byte_order, offsetof(FileHeader, endian_mark),
                         header.endian_mark, kEndianMark);
    }
    if (header.version != kVersion) {
        return in_header(DamageKind::bad_version, offsetof(FileHeader, version), header.version,
                         kVersion);
    }
    const std::uint64_t sum = header_checksum(file.first<kUserBlockSize>());
    if (header.header_checksum != sum) {
        return in_header(DamageKind::bad_header, offsetof(FileHeader, header_checksum), sum,
                         header.header_checksum);
    }
    if ((header.required_features & ~kKnownFeatures) != 0) {
        return in_header(DamageKind::unknown_feature, offsetof(FileHeader, required_features),
                         header.required_features, kKnownFeatures);
    }
    return std::nullopt;
}

/// Finds a mismatch between the section table and the rest of the file.
Found find_stale(Bytes file, const FileHeader& header) {
    if (std::memcmp(header.superblock.data(), file.data() + kSuperblockOffset,
                    header.superblock.size()) != 0) {
        return in_header(DamageKind::rewritten, kSuperblockOffset, 0, 0);
    }
    if (header.file_size != file.size()) {
        return in_header(DamageKind::bad_file_size, offsetof(FileHeader, file_size), file.size(),
                         header.file_size);
    }
    return std::nullopt;
}

bool is_finite(const Double3& p) noexcept {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool is_coordinate(double x) noexcept {
    return std::fabs(x) <= kMaxCoordinate;  // false for NaN
}

bool is_coordinate(const Double3& p) noexcept {
    return is_coordinate(p.x) && is_coordinate(p.y) && is_coordinate(p.z);
}

/// Finds a number outside the range that queries rely on.
Found find_bad_field(const FileHeader& header) {
    const auto above = [](std::uint64_t at, std::uint64_t found, std::uint64_t limit) -> Found {
        if (found <= limit) return std::nullopt;
        return in_header(DamageKind::bad_header, at, found, limit);
    };
    if (const Found damage =
            above(offsetof(FileHeader, section_count), header.section_count, kMaxSections)) {
        return damage;
    }
    if (const Found damage =
            above(offsetof(FileHeader, vertex_count), header.vertex_count, kMaxVertices)) {
        return damage;
    }
    if (const Found damage =
            above(offsetof(FileHeader, triangle_count), header.triangle_count, kMaxTriangles)) {
        return damage;
    }
    if (header.frame_exponent < kMinFrameExponent || header.frame_exponent > kMaxFrameExponent) {
        return in_header(DamageKind::bad_header, offsetof(FileHeader, frame_exponent),
                         static_cast<std::uint32_t>(header.frame_exponent), kMaxFrameExponent);
    }
    if (!is_coordinate(header.frame_origin)) {
        return in_header(DamageKind::bad_header, offsetof(FileHeader, frame_origin), 0, 0);
    }
    if (!(std::isfinite(header.metres_per_unit) && header.metres_per_unit >= 0) ||
        !is_finite(header.normalize_offset) || !std::isfinite(header.normalize_factor)) {
        return in_header(DamageKind::bad_header, offsetof(FileHeader, metres_per_unit), 0, 0);
    }
    return std::nullopt;
}

std::uint64_t table_place(std::uint32_t index) noexcept {
    return kSectionTableOffset + std::uint64_t{index} * sizeof(SectionEntry);
}

SectionEntry table_entry(Bytes file, std::uint32_t index) noexcept {
    return read<SectionEntry>(file, table_place(index));
}

/// Finds damage in one entry. A division is used, so that a hostile count cannot wrap around.
Found find_bad_entry(Bytes file, const SectionEntry& entry, std::uint64_t place) {
    const auto bad = [&](std::uint64_t at, std::uint64_t found, std::uint64_t limit) {
        return Damage{DamageKind::bad_section, entry.id, place + at, found, limit};
    };
    const std::uint32_t size = element_size(entry.id);
    if (entry.element_size == 0 || (size != 0 && entry.element_size != size)) {
        return bad(offsetof(SectionEntry, element_size), entry.element_size, size);
    }
    if (entry.count == 0) {
        if (entry.offset == 0) return std::nullopt;
        return bad(offsetof(SectionEntry, offset), entry.offset, 0);
    }
    if (entry.offset % kSectionAlignment != 0) {
        return bad(offsetof(SectionEntry, offset), entry.offset, kSectionAlignment);
    }
    if (entry.offset < kUserBlockSize || entry.offset > file.size()) {
        return bad(offsetof(SectionEntry, offset), entry.offset, file.size());
    }
    const std::uint64_t room = (file.size() - entry.offset) / entry.element_size;
    if (entry.count > room) return bad(offsetof(SectionEntry, count), entry.count, room);
    return std::nullopt;
}

std::uint64_t end_of(const SectionEntry& entry) noexcept {
    return entry.offset + entry.count * entry.element_size;
}

/// Finds damage in the table. Each entry must be correct, ids must rise, and no two entries may
/// share a byte.
Found find_bad_table(Bytes file, const FileHeader& header) {
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
        const SectionEntry entry = table_entry(file, i);
        if (const Found damage = find_bad_entry(file, entry, table_place(i))) return damage;
        for (std::uint32_t j = 0; j < i; ++j) {
            const SectionEntry other = table_entry(file, j);
            if (other.id >= entry.id) {
                return Damage{DamageKind::bad_section, entry.id, table_place(i),
                              static_cast<std::uint32_t>(entry.id),
                              static_cast<std::uint32_t>(other.id)};
            }
            const bool apart = entry.count == 0 || other.count == 0 ||
                               entry.offset >= end_of(other) || other.offset >= end_of(entry);
            if (!apart) {
                return Damage{DamageKind::bad_section, entry.id, table_place(i), entry.offset,
                              end_of(other)};
            }
        }
    }
    return std::nullopt;
}

// --- The sections ----------------------------------------------------------------

/// A section under examination.
struct Content {
    Bytes file;
    const FileHeader& header;
    SectionEntry entry;

    template <class T>
    [[nodiscard]] T element(std::uint64_t index) const noexcept {
        assert(index < entry.count && entry.element_size == sizeof(T));
        return read<T>(file, place(index));
    }
    [[nodiscard]] std::uint64_t place(std::uint64_t index) const noexcept {
        return entry.offset + index * entry.element_size;
    }
    [[nodiscard]] Found damage(DamageKind kind, std::uint64_t index, std::uint64_t found,
                               std::uint64_t limit) const noexcept {
        return Damage{kind, entry.id, place(index), found, limit};
    }
    [[nodiscard]] Found count_must_be(std::uint64_t expected) const noexcept {
        if (entry.count == expected) return std::nullopt;
        return damage(DamageKind::bad_count, 0, entry.count, expected);
    }
};

/// Finds the first element for which `good` is false.
template <class T, class Good>
Found find_bad_number(const Content& content, Good good) {
    for (std::uint64_t i = 0; i < content.entry.count; ++i) {
        if (!good(content.element<T>(i))) return content.damage(DamageKind::bad_number, i, i, 0);
    }
    return std::nullopt;
}

/// Finds a float of a section that is not finite: a loop without branches, then a search.
Found find_bad_float(const Content& content) {
    constexpr std::uint32_t kExponent = 0x7f800000;
    const std::uint64_t count = content.entry.count * content.entry.element_size / sizeof(float);
    std::uint32_t bad = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto bits = read<std::uint32_t>(content.file, content.entry.offset + 4 * i);
        bad |= static_cast<std::uint32_t>((bits & kExponent) == kExponent);
    }
    if (bad == 0) return std::nullopt;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t at = content.entry.offset + 4 * i;
        if (!std::isfinite(read<float>(content.file, at))) {
            return Damage{DamageKind::bad_number, content.entry.id, at, i, 0};
        }
    }
    return std::nullopt;
}

/// Finds a number of the BVH that is not finite, or else a box outside the frame.
Found find_bad_boxes(const Content& content) {
    const BvhShape shape = bvh_shape(content.header.triangle_count);
    const SectionView<BvhNode> nodes(content.file, content.entry);
    const Found damage = find_bad_bvh_box(nodes, shape);
    if (!damage) return std::nullopt;
    const Found not_finite = find_bad_float(content);
    return not_finite ? not_finite : damage;
}

/// Finds a uint32 of a section above `limit`.
Found find_bad_index(const Content& content, std::uint64_t limit) {
    const std::uint64_t count =
        content.entry.count * content.entry.element_size / sizeof(std::uint32_t);
    std::uint32_t greatest = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        greatest =
            std::max(greatest, read<std::uint32_t>(content.file, content.entry.offset + 4 * i));
    }
    if (count == 0 || greatest <= limit) return std::nullopt;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t at = content.entry.offset + 4 * i;
        const auto index = read<std::uint32_t>(content.file, at);
        if (index > limit) {
            return Damage{DamageKind::bad_index, content.entry.id, at, index, limit};
        }
    }
    return std::nullopt;
}

/// Finds a run out of sequence. Runs must follow each other from 0 to the triangle count.
template <class Run>
Found find_bad_runs(const Content& content) {
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < content.entry.count; ++i) {
        const auto run = content.element<Run>(i);
        if (run.first_triangle != next) {
            return content.damage(DamageKind::bad_order, i, run.first_triangle, next);
        }
        next += run.triangle_count;
    }
    if (next == content.header.triangle_count) return std::nullopt;
    return content.damage(DamageKind::bad_order, 0, next, content.header.triangle_count);
}

Found find_bad_names(const Content& content) {
    if (content.entry.count == 0) return std::nullopt;
    const std::uint64_t last = content.entry.count - 1;
    const auto end = content.element<std::uint8_t>(last);
    if (end == 0) return std::nullopt;
    return content.damage(DamageKind::bad_order, last, end, 0);
}

/// Finds a byte with more than two bits for each of three edges.
Found find_bad_convexity(const Content& content) {
    constexpr std::uint8_t kMost = (1U << 6) - 1;
    for (std::uint64_t i = 0; i < content.entry.count; ++i) {
        const auto bits = content.element<std::uint8_t>(i);
        if (bits > kMost) return content.damage(DamageKind::bad_number, i, bits, kMost);
    }
    return std::nullopt;
}

Found find_bad_component(const Content& content) {
    std::uint64_t triangles = 0;
    for (std::uint64_t i = 0; i < content.entry.count; ++i) {
        const auto component = content.element<Component>(i);
        if (component.vertex >= content.header.vertex_count) {
            return content.damage(DamageKind::bad_index, i, component.vertex,
                                  std::uint64_t{content.header.vertex_count} - 1);
        }
        if (!std::isfinite(component.signed_volume)) {
            return content.damage(DamageKind::bad_number, i, i, 0);
        }
        triangles += component.triangle_count;
    }
    if (triangles == content.header.triangle_count) return std::nullopt;
    return content.damage(DamageKind::bad_count, 0, triangles, content.header.triangle_count);
}

/// Finds damage in the verdicts. The first is that of the whole mesh, whose triangles are those of
/// the components.
Found find_bad_verdict(const Content& content) {
    const std::uint64_t limit = content.header.triangle_count;
    if (content.entry.count == 0) return content.damage(DamageKind::bad_count, 0, 0, 1);
    std::uint64_t triangles = 0;
    for (std::uint64_t i = 0; i < content.entry.count; ++i) {
        const auto verdict = content.element<Verdict>(i);
        const std::uint64_t greatest = std::max<std::uint64_t>(limit, 1) - 1;
        if (verdict.first_triangle > greatest) {
            return content.damage(DamageKind::bad_index, i, verdict.first_triangle, greatest);
        }
        if (!std::isfinite(verdict.area) || !std::isfinite(verdict.volume)) {
            return content.damage(DamageKind::bad_number, i, i, 0);
        }
        if (i > 0) triangles += verdict.triangle_count;
    }
    const std::uint64_t all = content.element<Verdict>(0).triangle_count;
    if (all != limit) return content.damage(DamageKind::bad_count, 0, all, limit);
    if (triangles <= limit) return std::nullopt;
    return content.damage(DamageKind::bad_count, 1, triangles, limit);
}

bool all_finite(const MassProperties& mass) noexcept {
    return std::isfinite(mass.volume) && std::isfinite(mass.surface_area) &&
           is_finite(mass.centre) &&
           std::all_of(mass.inertia.begin(), mass.inertia.end(),
                       [](double x) { return std::isfinite(x); });
}

bool all_finite(const Bounds& bounds) noexcept {
    return is_finite(bounds.lower) && is_finite(bounds.upper) &&
           is_finite(bounds.oriented_centre) && is_finite(bounds.axis[0]) &&
           is_finite(bounds.axis[1]) && is_finite(bounds.axis[2]) && is_finite(bounds.half_extent);
}

bool all_finite(const Instance& instance) noexcept {
    return std::all_of(instance.model_from_node.begin(), instance.model_from_node.end(),
                       [](double x) { return std::isfinite(x); });
}

/// Finds a leaf that lacks finite numbers, or the count that follows from the triangle count.
Found find_bad_leaf(const Content& content) {
    for (std::uint64_t i = 0; i < content.entry.count; ++i) {
        const auto leaf = content.element<BvhLeaf>(i);
        const std::uint64_t rest = content.header.triangle_count - i * kBvhWidth;
        const std::uint64_t count = std::min<std::uint64_t>(rest, kBvhWidth);
        if (leaf.count != count) return content.damage(DamageKind::bad_count, i, leaf.count, count);
    }
    return find_bad_float(content);
}

/// Returns whether sphere `box` may be walked. Each axis must be near unit length. Radius and
/// halves must not be negative, and only the sides of its kind may be used.
bool is_swept_sphere(const SweptNode& node, std::uint32_t box, SweptKind kind) noexcept {
    assert(box < kBvhWidth);
    constexpr float kUnitTolerance = 0x1p-10F;
    bool good = node.radius[box] >= 0;
    for (std::uint32_t k = 0; k < 2; ++k) {
        const auto& [axis, half] = node.side[k];
        const float squared =
            axis[0][box] * axis[0][box] + axis[1][box] * axis[1][box] + axis[2][box] * axis[2][box];
        good = good && std::fabs(squared - 1) <= kUnitTolerance && half[box] >= 0 &&
               (half[box] == 0 || k < static_cast<std::uint32_t>(kind));
    }
    return good;
}

Found find_bad_swept(const Content& content, SweptKind kind) {
    if (const Found damage = find_bad_float(content)) return damage;
    for (std::uint64_t i = 0; i < content.entry.count; ++i) {
        const auto node = content.element<SweptNode>(i);
        for (std::uint32_t box = 0; box < kBvhWidth; ++box) {
            if (!is_swept_sphere(node, box, kind)) {
                return content.damage(DamageKind::bad_number, i, box, kBvhWidth - 1);
            }
        }
    }
    return std::nullopt;
}

/// Finds an index of a vertex that does not exist. Without vertices, every index is damage.
Found find_bad_vertex_index(const Content& content) {
    const std::uint64_t vertices = content.header.vertex_count;
    if (vertices == 0 && content.entry.count > 0) {
        return content.damage(DamageKind::bad_index, 0, 0, 0);
    }
    return find_bad_index(content, vertices - 1);
}

/// Finds damage in one section. One switch has a case for every section, so that the compiler warns
/// of one that is forgotten.
Found find_bad_content(const Content& content) {
    const std::uint64_t triangles = content.header.triangle_count;
    const auto counted = [&](std::uint64_t expected, auto check) {
        const Found damage = content.count_must_be(expected);
        return damage ? damage : check();
    };
    const auto nothing_more = [] { return Found{}; };
    switch (content.entry.id) {
        case SectionId::positions_f32:
            return counted(content.header.vertex_count, [&] { return find_bad_float(content); });
        case SectionId::positions_f64:
            return counted(content.header.vertex_count, [&] {
                return find_bad_number<Double3>(content,
                                                [](const Double3& p) { return is_coordinate(p); });
            });
        case SectionId::triangles:
            return counted(triangles, [&] { return find_bad_vertex_index(content); });
        case SectionId::source_triangle:
            return counted(triangles, [&] { return find_bad_index(content, triangles - 1); });
        case SectionId::source_vertex:
            return content.count_must_be(content.header.vertex_count);
        case SectionId::source_face:
        case SectionId::repaired_from:
            return content.count_must_be(triangles);
        case SectionId::bvh_nodes:
            return counted(bvh_shape(content.header.triangle_count).node_count,
                           [&] { return find_bad_boxes(content); });
        // Boxes are checked at the end, with the leaves, which fix the shape of the tree.
        case SectionId::piece_nodes:
            return find_bad_float(content);
        case SectionId::piece_swept:
            return find_bad_swept(content, SweptKind::rectangle);
        case SectionId::oriented_nodes:
            return counted(bvh_shape(content.header.triangle_count).node_count,
                           [&] { return find_bad_float(content); });
        case SectionId::swept_nodes:
            return counted(bvh_shape(content.header.triangle_count).node_count, [&] {
                return find_bad_swept(content, swept_kind(content.header.flags));
            });
        case SectionId::bvh_leaves:
            return counted(bvh_shape(content.header.triangle_count).leaf_count,
                           [&] { return find_bad_leaf(content); });
        case SectionId::degenerate_bits:
            return content.count_must_be((triangles + 63) / 64);
        case SectionId::components:
            return find_bad_component(content);
        case SectionId::bounds:
            return counted(1, [&] {
                return find_bad_number<Bounds>(content,
                                               [](const Bounds& b) { return all_finite(b); });
            });
        case SectionId::mass_properties:
            return counted(1, [&] {
                return find_bad_number<MassProperties>(
                    content, [](const MassProperties& m) { return all_finite(m); });
            });
        case SectionId::instances: {
            const Found damage = find_bad_runs<Instance>(content);
            return damage ? damage : find_bad_number<Instance>(content, [](const Instance& i) {
                return all_finite(i);
            });
        }
        case SectionId::group_runs:
        case SectionId::material_runs:
            return find_bad_runs<NamedRun>(content);
        case SectionId::instance_names:
        case SectionId::group_names:
        case SectionId::material_names:
            return find_bad_names(content);
        case SectionId::verdicts:
            return find_bad_verdict(content);
        case SectionId::provenance:
        case SectionId::findings:
        // Sections that depend on each other are checked together, at the end.
        case SectionId::octree_grid:
        case SectionId::octree_nodes:
        case SectionId::octree_references:
        case SectionId::octree_leaf_codes:
        case SectionId::octree_leaf_nodes:
        case SectionId::octree_top:
        case SectionId::octree_modulus_table:
        case SectionId::octree_mixed_table:
        case SectionId::adaptive_octree:
        case SectionId::adaptive_octree_nodes:
        case SectionId::adaptive_octree_references:
        case SectionId::tetra_tree:
        case SectionId::tetra_nodes:
        case SectionId::tetra_references:
        case SectionId::tetra_top:
        case SectionId::octree_boxes:
        case SectionId::adaptive_octree_boxes:
        case SectionId::tetra_boxes:
        case SectionId::tetra_oriented:
        case SectionId::hulls:
        case SectionId::hull_blocks:
        case SectionId::hull_vertices:
        case SectionId::hull_facets:
        case SectionId::hull_groups:
        case SectionId::hull_neighbours:
        case SectionId::hull_starts:
        case SectionId::pieces:
        case SectionId::piece_triangles:
        case SectionId::piece_vertices:
        case SectionId::piece_facets:
        case SectionId::piece_leaves:
        case SectionId::piece_node_hulls:
        case SectionId::piece_adjacency:
        case SectionId::triangle_piece:
            return nothing_more();
        case SectionId::edge_convexity:
            return counted(triangles, [&] { return find_bad_convexity(content); });
    }
    return nothing_more();
}

/// Finds a section that another one depends on and that is missing.
Found find_missing(Bytes file) {
    const auto missing = [](SectionId id) {
        return Damage{DamageKind::missing_section, id, kSectionTableOffset, 0, 1};
    };
    const auto has = [&](SectionId id) { return find_section(file, id).has_value(); };
    const bool f32 = has(SectionId::positions_f32);
    const bool f64 = has(SectionId::positions_f64);
    if (f32 && f64) {
        return Damage{DamageKind::bad_section, SectionId::positions_f64, kSectionTableOffset, 2, 1};
    }
    if (has(SectionId::triangles) && !f32 && !f64) return missing(SectionId::positions_f32);
    if (has(SectionId::bvh_nodes) && !has(SectionId::triangles)) {
        return missing(SectionId::triangles);
    }
    if ((has(SectionId::bvh_leaves) || has(SectionId::oriented_nodes) ||
         has(SectionId::swept_nodes)) &&
        !has(SectionId::bvh_nodes)) {
        return missing(SectionId::bvh_nodes);
    }
    if (const Found damage = find_missing_octree(file)) return damage;
    if (const Found damage = find_missing_adaptive_octree(file)) return damage;
    if (const Found damage = find_missing_tetra(file)) return damage;
    if (const Found damage = find_missing_hulls(file)) return damage;
    if (const Found damage = find_missing_pieces(file)) return damage;
    if (const Found damage = find_missing_piece_tree(file)) return damage;
    return std::nullopt;
}

Bytes section_bytes(Bytes file, const SectionEntry& entry) noexcept {
    assert(entry.offset <= file.size() &&
           entry.count <= (file.size() - entry.offset) / entry.element_size);
    return file.subspan(static_cast<std::size_t>(entry.offset),
                        static_cast<std::size_t>(entry.count * entry.element_size));
}

}  // namespace

std::optional<Damage> find_header_damage(std::span<const std::byte> file) noexcept {
    const FloatEnvironment environment;
    constexpr std::uint64_t kLeast = kSuperblockOffset + sizeof(FileHeader::superblock);
    if (file.size() < kLeast) {
        return in_header(DamageKind::too_short, 0, file.size(), kLeast);
    }
    const FileHeader header = read_header(file);
    if (const Found damage = find_foreign(file, header)) return damage;
    if (const Found damage = find_stale(file, header)) return damage;
    if (const Found damage = find_bad_field(header)) return damage;
    return find_bad_table(file, header);
}

std::optional<Damage> find_damage(std::span<const std::byte> file, SectionSet wanted) noexcept {
    const FloatEnvironment environment;
    if (const Found damage = find_header_damage(file)) return damage;
    if (const Found damage = find_missing(file)) return damage;
    const FileHeader header = read_header(file);
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
        const SectionEntry entry = table_entry(file, i);
        if (!wanted.contains(entry.id) || element_size(entry.id) == 0) continue;
        const std::uint64_t sum = checksum(section_bytes(file, entry));
        if (sum != entry.checksum) {
            return Damage{DamageKind::bad_checksum, entry.id, entry.offset, sum, entry.checksum};
        }
        if (const Found damage = find_bad_content({file, header, entry})) return damage;
    }
    if (const Found damage = find_octree_damage(file, wanted)) return damage;
    if (const Found damage = find_adaptive_octree_damage(file, wanted)) return damage;
    if (const Found damage = find_tetra_damage(file, wanted)) return damage;
    if (const Found damage = find_hull_damage(file, wanted)) return damage;
    if (const Found damage = find_piece_damage(file, wanted)) return damage;
    if (const Found damage = find_piece_tree_damage(file, wanted)) return damage;
    return std::nullopt;
}

}  // namespace cdprep::format
