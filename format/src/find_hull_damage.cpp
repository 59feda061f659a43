// SPDX-License-Identifier: MIT
#include "section_checks.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "cdprep/format/hulls.h"
#include "cdprep/format/limits.h"
#include "reference_lists.h"

// Parts follow each other in the order of the hulls. A counter per section proves that all lie in
// it and that no two hulls share any.

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;
using Bytes = std::span<const std::byte>;

constexpr std::array<SectionId, 7> kIds = {SectionId::hulls,         SectionId::hull_blocks,
                                           SectionId::hull_vertices, SectionId::hull_facets,
                                           SectionId::hull_groups,   SectionId::hull_neighbours,
                                           SectionId::hull_starts};

/// Enclosing hulls may reach a little farther than their contents.
constexpr double kMostReach = 4 * kMaxCoordinate;

struct Parts {
    SectionView<Hull> hulls;
    SectionView<HullBlock> blocks;
    SectionView<std::uint32_t> vertices;
    SectionView<HullFacet> facets;
    SectionView<HullGroup> groups;
    SectionView<std::uint32_t> neighbours;
    SectionView<std::uint32_t> starts;

    Parts(Bytes file, SectionSet wanted) noexcept
        : hulls(file, SectionId::hulls, wanted),
          blocks(file, SectionId::hull_blocks, wanted),
          vertices(file, SectionId::hull_vertices, wanted),
          facets(file, SectionId::hull_facets, wanted),
          groups(file, SectionId::hull_groups, wanted),
          neighbours(file, SectionId::hull_neighbours, wanted),
          starts(file, SectionId::hull_starts, wanted) {}
};

/// Returns the key by which hulls are sorted.
std::uint64_t place_of(const Hull& hull) noexcept {
    return std::uint64_t{static_cast<std::uint32_t>(hull.scope)} << 32 | hull.number;
}

std::uint64_t blocks_of(const Hull& hull) noexcept {
    return (std::uint64_t{hull.point_count} + kHullLanes - 1) / kHullLanes;
}

std::uint64_t neighbour_words(const Hull& hull) noexcept {
    if (hull.neighbour_count == 0) return 0;
    return std::uint64_t{hull.point_count} + 1 + hull.neighbour_count;
}

/// The places where the next hull's parts begin.
struct Next {
    std::uint64_t block = 0, facet = 0, group = 0, neighbour = 0, start = 0;
};

/// Finds damage in a run of parts. It must begin at `next` and end inside its section.
Found find_bad_run(const Parts& parts, std::uint64_t i, std::uint64_t first, std::uint64_t count,
                   std::uint64_t& next, std::uint64_t room) noexcept {
    assert(next <= room);
    if (first != next) return parts.hulls.damage(DamageKind::bad_order, i, first, next);
    if (count > room - next) {
        return parts.hulls.damage(DamageKind::bad_index, i, count, room - next);
    }
    next += count;
    return std::nullopt;
}

Found find_bad_place(const Parts& parts, std::uint64_t i, const Hull& hull, Next& next) noexcept {
    const auto run = [&](std::uint64_t first, std::uint64_t count, std::uint64_t& counter,
                         std::uint64_t room) {
        return find_bad_run(parts, i, first, count, counter, room);
    };
    if (const Found damage =
            run(hull.first_block, blocks_of(hull), next.block, parts.blocks.count())) {
        return damage;
    }
    if (const Found damage =
            run(hull.first_facet, hull.facet_count, next.facet, parts.facets.count())) {
        return damage;
    }
    if (const Found damage =
            run(hull.first_group, hull.group_count, next.group, parts.groups.count())) {
        return damage;
    }
    if (const Found damage = run(hull.first_neighbour, neighbour_words(hull), next.neighbour,
                                 parts.neighbours.count())) {
        return damage;
    }
    return run(hull.first_start, hull.start_count, next.start, parts.starts.count());
}

bool is_reach(double x) noexcept {
    return x >= 0 && x <= kMostReach;  // false for NaN
}

/// Finds a count that contradicts the dimension, or a number out of range.
Found find_bad_facts(const Parts& parts, std::uint64_t i, const Hull& hull) noexcept {
    const auto bad = [&](DamageKind kind, std::uint64_t found, std::uint64_t limit) {
        return parts.hulls.damage(kind, i, found, limit);
    };
    if (hull.scope > HullScope::part) {
        return bad(DamageKind::bad_index, static_cast<std::uint32_t>(hull.scope), 3);
    }
    if (hull.dimension < -1 || hull.dimension > 3) {
        return bad(DamageKind::bad_index, static_cast<std::uint32_t>(hull.dimension), 3);
    }
    if ((hull.flags & ~static_cast<std::uint32_t>(hull_exact)) != 0) {
        return bad(DamageKind::bad_index, hull.flags, hull_exact);
    }
    const auto least = static_cast<std::uint32_t>(hull.dimension + 1);
    const bool is_flat = hull.dimension < 2;
    if (hull.point_count < least || (is_flat && hull.point_count != least)) {
        return bad(DamageKind::bad_count, hull.point_count, least);
    }
    const std::uint64_t facets = is_flat ? 0 : 2 * std::uint64_t{hull.point_count} - 4;
    if (hull.facet_count != facets) return bad(DamageKind::bad_count, hull.facet_count, facets);
    const std::uint32_t starts = hull.neighbour_count > 0 ? kHullStarts : 0;
    if (hull.start_count != starts) return bad(DamageKind::bad_count, hull.start_count, starts);
    const bool has_reach = is_reach(hull.reach.x) && is_reach(hull.reach.y) &&
                           is_reach(hull.reach.z) && hull.distance >= 0 &&
                           std::isfinite(hull.distance);
    return has_reach ? Found{} : bad(DamageKind::bad_number, 0, 0);
}

/// Finds a lane that is not within reach, or one past the last point that does not repeat it.
Found find_bad_point(const Parts& parts, const Hull& hull) noexcept {
    const std::array<double, 3> reach = {hull.reach.x, hull.reach.y, hull.reach.z};
    for (std::uint64_t b = 0; b < blocks_of(hull); ++b) {
        const HullBlock block = parts.blocks[hull.first_block + b];
        const std::uint64_t rest = hull.point_count - b * kHullLanes;
        const std::size_t last = std::min<std::uint64_t>(rest, kHullLanes) - 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t lane = 0; lane < kHullLanes; ++lane) {
                const double x = block.at[axis][lane];
                const bool good =
                    std::fabs(x) <= reach[axis] && (lane <= last || x == block.at[axis][last]);
                if (!good) {
                    return parts.blocks.damage(DamageKind::bad_number, hull.first_block + b, lane,
                                               kHullLanes - 1);
                }
            }
        }
    }
    return std::nullopt;
}

/// Returns the place of the edge from `from` in a facet, or 3.
std::size_t edge_from(const HullFacet& facet, std::uint32_t from) noexcept {
    return static_cast<std::size_t>(std::find(facet.point.begin(), facet.point.end(), from) -
                                    facet.point.begin());
}

/// Finds a facet whose neighbour does not name it across the same edge.
Found find_bad_facet(const Parts& parts, const Hull& hull) noexcept {
    for (std::uint32_t f = 0; f < hull.facet_count; ++f) {
        const std::uint64_t at = std::uint64_t{hull.first_facet} + f;
        const HullFacet facet = parts.facets[at];
        const auto bad = [&](DamageKind kind, std::uint64_t found, std::uint64_t limit) {
            return parts.facets.damage(kind, at, found, limit);
        };
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = facet.point[i], to = facet.point[(i + 1) % 3];
            if (from >= hull.point_count) {
                return bad(DamageKind::bad_index, from, hull.point_count - 1);
            }
            if (from == to) return bad(DamageKind::bad_order, from, to);
            if (facet.across[i] >= hull.facet_count) {
                return bad(DamageKind::bad_index, facet.across[i], hull.facet_count - 1);
            }
            const HullFacet other = parts.facets[std::uint64_t{hull.first_facet} + facet.across[i]];
            const std::size_t back = edge_from(other, to);
            if (back == 3 || other.point[(back + 1) % 3] != from || other.across[back] != f) {
                return bad(DamageKind::bad_order, facet.across[i], f);
            }
        }
    }
    return std::nullopt;
}

/// Finds damage in the groups. They must follow each other and cover all facets, and their facets
/// must name them.
Found find_bad_group(const Parts& parts, const Hull& hull) noexcept {
    std::uint64_t next = 0;
    for (std::uint32_t g = 0; g < hull.group_count; ++g) {
        const std::uint64_t at = std::uint64_t{hull.first_group} + g;
        const HullGroup group = parts.groups[at];
        const std::uint64_t room = hull.facet_count - next;
        if (group.first_facet != next) {
            return parts.groups.damage(DamageKind::bad_order, at, group.first_facet, next);
        }
        if (group.facet_count == 0 || group.facet_count > room) {
            return parts.groups.damage(DamageKind::bad_count, at, group.facet_count, room);
        }
        for (const std::uint64_t end = next + group.facet_count; next < end; ++next) {
            const std::uint64_t facet = hull.first_facet + next;
            const std::uint32_t said = parts.facets[facet].group;
            if (said != g) return parts.facets.damage(DamageKind::bad_order, facet, said, g);
        }
    }
    if (next == hull.facet_count) return std::nullopt;
    return parts.groups.damage(DamageKind::bad_count, hull.first_group, next, hull.facet_count);
}

/// Finds a number that is not that of a point, from place `first` on.
Found find_bad_points(const SectionView<std::uint32_t>& section, std::uint64_t first,
                      std::uint64_t count, const Hull& hull) noexcept {
    for (std::uint64_t i = first; i < first + count; ++i) {
        if (section[i] < hull.point_count) continue;
        return section.damage(DamageKind::bad_index, i, section[i], hull.point_count - 1);
    }
    return std::nullopt;
}

Found find_bad_neighbour(const Parts& parts, const Hull& hull) noexcept {
    if (hull.neighbour_count == 0) return std::nullopt;
    const std::uint64_t begins = hull.first_neighbour;
    std::uint32_t least = 0;
    for (std::uint64_t i = 0; i <= hull.point_count; ++i) {
        const std::uint32_t begin = parts.neighbours[begins + i];
        const bool good = begin >= least && begin <= hull.neighbour_count && (i > 0 || begin == 0);
        if (!good) return parts.neighbours.damage(DamageKind::bad_order, begins + i, begin, least);
        least = begin;
    }
    if (least != hull.neighbour_count) {
        return parts.neighbours.damage(DamageKind::bad_count, begins + hull.point_count, least,
                                       hull.neighbour_count);
    }
    const std::uint64_t first = begins + hull.point_count + 1;
    if (const Found damage = find_bad_points(parts.neighbours, first, hull.neighbour_count, hull)) {
        return damage;
    }
    return find_bad_points(parts.starts, hull.first_start, hull.start_count, hull);
}

Found find_bad_hull(const Parts& parts, std::uint64_t i, const Hull& hull, Next& next) noexcept {
    if (const Found damage = find_bad_facts(parts, i, hull)) return damage;
    if (const Found damage = find_bad_place(parts, i, hull, next)) return damage;
    if (const Found damage = find_bad_point(parts, hull)) return damage;
    if (const Found damage = find_bad_facet(parts, hull)) return damage;
    if (const Found damage = find_bad_group(parts, hull)) return damage;
    return find_bad_neighbour(parts, hull);
}

/// Finds an element of a section that belongs to no hull.
template <class T>
Found find_rest(const SectionView<T>& section, std::uint64_t used) noexcept {
    if (section.count() == used) return std::nullopt;
    return section.damage(DamageKind::bad_count, 0, section.count(), used);
}

}  // namespace

std::optional<Damage> find_missing_hulls(std::span<const std::byte> file) noexcept {
    return find_gap(file, kIds);
}

std::optional<Damage> find_hull_damage(std::span<const std::byte> file,
                                       SectionSet wanted) noexcept {
    if (!find_section(file, SectionId::hulls)) return std::nullopt;
    for (const SectionId id : kIds) {
        if (!wanted.contains(id)) return std::nullopt;
    }
    const Parts parts(file, wanted);
    if (const Found damage = find_rest(parts.vertices, parts.blocks.count() * kHullLanes)) {
        return damage;
    }
    Next next;
    std::uint64_t least = 0;
    for (std::uint64_t i = 0; i < parts.hulls.count(); ++i) {
        const Hull hull = parts.hulls[i];
        if (place_of(hull) < least) {
            return parts.hulls.damage(DamageKind::bad_order, i, place_of(hull), least);
        }
        least = place_of(hull) + 1;
        if (const Found damage = find_bad_hull(parts, i, hull, next)) return damage;
    }
    if (const Found damage = find_rest(parts.blocks, next.block)) return damage;
    if (const Found damage = find_rest(parts.facets, next.facet)) return damage;
    if (const Found damage = find_rest(parts.groups, next.group)) return damage;
    if (const Found damage = find_rest(parts.neighbours, next.neighbour)) return damage;
    return find_rest(parts.starts, next.start);
}

}  // namespace cdprep::format
