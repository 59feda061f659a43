// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/triangulate_polygon.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "cdprep/exact/predicates.h"
#include "mesh/half_edges.h"

// Libraries serve fewer outlines: earcut decides by rounded numbers, and CGAL's constrained
// triangulation makes one corner of those with equal positions.
namespace cdprep::mesh {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// Fewer steps per corner cut nothing but spikes. The memory for larger polygons is not worth it.
constexpr std::uint64_t kLeastSteps = 25;

/// Returns twice the vector area of the outline, scaled to about one.
Double3 area_vector(std::span<const Double3> outline) {
    const Double3& o = outline[0];
    double extent = 0;
    for (const Double3& p : outline) {
        extent =
            std::max({extent, std::fabs(p.x - o.x), std::fabs(p.y - o.y), std::fabs(p.z - o.z)});
    }
    Double3 sum{0, 0, 0};
    if (extent == 0) return sum;
    const int exponent = -std::ilogb(extent);
    const auto scaled = [&](const Double3& p) {
        return Double3{std::scalbn(p.x - o.x, exponent), std::scalbn(p.y - o.y, exponent),
                       std::scalbn(p.z - o.z, exponent)};
    };
    for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
        const Double3 a = scaled(outline[i]);
        const Double3 b = scaled(outline[i + 1]);
        sum.x += a.y * b.z - a.z * b.y;
        sum.y += a.z * b.x - a.x * b.z;
        sum.z += a.x * b.y - a.y * b.x;
    }
    return sum;
}

/// Returns the outline projected along its main axis, counter-clockwise. Drops one coordinate
/// and may swap the others, which is exact.
std::vector<Double2> project(std::span<const Double3> outline) {
    const Double3 area = area_vector(outline);
    const double x = std::fabs(area.x);
    const double y = std::fabs(area.y);
    const double z = std::fabs(area.z);
    std::vector<Double2> flat;
    flat.reserve(outline.size());
    for (const Double3& p : outline) {
        Double2 seen = {p.x, p.y};
        bool mirrored = area.z < 0;
        if (x > y && x > z) {
            seen = {p.y, p.z};
            mirrored = area.x < 0;
        } else if (y > z) {
            seen = {p.z, p.x};
            mirrored = area.y < 0;
        }
        flat.push_back(mirrored ? Double2{seen.y, seen.x} : seen);
    }
    return flat;
}

bool equal(const Double2& a, const Double2& b) {
    return a.x == b.x && a.y == b.y;
}

bool less(const Double2& a, const Double2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

/// Returns whether every turn is strictly to the left, and the turns sum to one revolution.
bool is_strictly_convex(std::span<const Double2> flat) {
    const std::size_t n = flat.size();
    int direction_changes = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Double2& a = flat[i];
        const Double2& b = flat[(i + 1) % n];
        const Double2& c = flat[(i + 2) % n];
        if (exact::orient2d(a, b, c) <= 0) return false;
        if (less(a, b) != less(b, c)) ++direction_changes;
    }
    return direction_changes == 2;
}

/// Returns whether b lies strictly between a and c; the points must be collinear.
bool is_between(const Double2& a, const Double2& b, const Double2& c) {
    return (less(a, b) && less(b, c)) || (less(c, b) && less(b, a));
}

struct FlatBox {
    Double2 lower;
    Double2 upper;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr FlatBox kNothing = {{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};

FlatBox box_of(const Double2& a, const Double2& b) {
    return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
}

FlatBox join(const FlatBox& a, const FlatBox& b) {
    return {{std::min(a.lower.x, b.lower.x), std::min(a.lower.y, b.lower.y)},
            {std::max(a.upper.x, b.upper.x), std::max(a.upper.y, b.upper.y)}};
}

bool overlap(const FlatBox& a, const FlatBox& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
           b.lower.y <= a.upper.y;
}

/// A triangle that turns counter-clockwise.
struct Ear {
    Double2 a, b, c;
};

/// Returns whether segment pq meets the interior of the ear. Two convex sets in the plane are
/// apart exactly if a line along an edge of one of them separates them.
bool enters(const Ear& ear, const Double2& p, const Double2& q) {
    const auto outside = [&](const Double2& from, const Double2& to) {
        return exact::orient2d(from, to, p) <= 0 && exact::orient2d(from, to, q) <= 0;
    };
    if (outside(ear.a, ear.b) || outside(ear.b, ear.c) || outside(ear.c, ear.a)) return false;
    if (equal(p, q)) return true;
    const int a = exact::orient2d(p, q, ear.a);
    const int b = exact::orient2d(p, q, ear.b);
    const int c = exact::orient2d(p, q, ear.c);
    return std::min({a, b, c}) < 0 && std::max({a, b, c}) > 0;
}

/// Returns the corner of the box that is farthest to the left of the line.
Double2 leftmost(const FlatBox& box, const Double2& from, const Double2& to) {
    return {from.y < to.y ? box.lower.x : box.upper.x, from.x < to.x ? box.upper.y : box.lower.y};
}

/// Returns whether an edge in the box may enter the ear, or cross its cut from c to a.
bool may_matter(const Ear& ear, const FlatBox& ear_box, const FlatBox& box) {
    const auto beyond = [&](const Double2& from, const Double2& to) {
        return exact::orient2d(from, to, leftmost(box, from, to));
    };
    return overlap(ear_box, box) && beyond(ear.a, ear.b) > 0 && beyond(ear.b, ear.c) > 0 &&
           beyond(ear.c, ear.a) >= 0;
}

/// The boxes of the polygon's edges, as a binary tree over the numbers of their first corners.
/// Without it, an ear would be compared with all edges: quadratic time for every polygon.
class EdgeTree {
public:
    explicit EdgeTree(std::span<const Double2> flat)
        : leaves_(std::bit_ceil(flat.size())), boxes_(2 * leaves_, kNothing) {
        for (std::size_t i = 0; i < flat.size(); ++i) {
            boxes_[leaves_ + i] = box_of(flat[i], flat[(i + 1) % flat.size()]);
        }
        for (std::size_t node = leaves_; node-- > 1;) update(node);
    }

    void set(std::uint32_t edge, const FlatBox& box) {
        boxes_[leaves_ + edge] = box;
        for (std::size_t node = (leaves_ + edge) / 2; node > 0; node /= 2) update(node);
    }

    /// Returns whether `accept` holds for an edge. Skips all edges in boxes for which `may` is
    /// false, and counts the boxes tested.
    template <class May, class Accept>
    bool any(std::uint64_t& tests, May&& may, Accept&& accept) const {
        std::size_t node = 1;
        do {
            ++tests;
            const bool may_hold = may(boxes_[node]);
            if (may_hold && node < leaves_) {
                node *= 2;
                continue;
            }
            if (may_hold && accept(static_cast<std::uint32_t>(node - leaves_))) return true;
            // The next node beside the way from the root: 1 is back at the root.
            node = (node + 1) >> std::countr_zero(node + 1);
        } while (node > 1);
        return false;
    }

private:
    void update(std::size_t node) {
        boxes_[node] = join(boxes_[2 * node], boxes_[2 * node + 1]);
    }

    std::size_t leaves_;
    std::vector<FlatBox> boxes_;  ///< node i has the children 2i and 2i + 1; the root is 1
};

/// A set of corners. Each bit above the first level says whether a word below has any bits.
class CornerSet {
public:
    explicit CornerSet(std::size_t corners) {
        do {
            corners = (corners + kBits - 1) / kBits;
            levels_.emplace_back(corners, 0);
        } while (corners > 1);
    }

    void insert(std::size_t corner) {
        for (Level& level : levels_) {
            level[corner / kBits] |= bit_of(corner);
            corner /= kBits;
        }
    }

    void erase(std::size_t corner) {
        for (Level& level : levels_) {
            if ((level[corner / kBits] &= ~bit_of(corner)) != 0) return;
            corner /= kBits;
        }
    }

    /// Returns the first corner from `corner` on, else the first of all; nothing if empty.
    [[nodiscard]] std::optional<std::uint32_t> first_from(std::uint32_t corner) const {
        const auto found = first_at_least(corner);
        return found ? found : first_at_least(0);
    }

private:
    using Level = std::vector<std::uint64_t>;
    static constexpr std::size_t kBits = 64;

    static std::uint64_t bit_of(std::size_t i) {
        return std::uint64_t{1} << i % kBits;
    }

    [[nodiscard]] std::optional<std::uint32_t> first_at_least(std::size_t at) const {
        for (std::size_t i = 0; i < levels_.size(); ++i, at = at / kBits + 1) {
            if (at / kBits >= levels_[i].size()) return std::nullopt;
            const std::uint64_t later = levels_[i][at / kBits] >> at % kBits;
            if (later == 0) continue;
            at += static_cast<std::size_t>(std::countr_zero(later));
            while (i-- > 0) {
                at = kBits * at + static_cast<std::size_t>(std::countr_zero(levels_[i][at]));
            }
            return static_cast<std::uint32_t>(at);
        }
        return std::nullopt;
    }

    std::vector<Level> levels_;
};

/// Corners that are no ears, by an edge that prevents it.
class BlockedCorners {
public:
    explicit BlockedCorners(std::size_t edges) : first_(edges, kNone) {}

    void add(std::uint32_t edge, std::uint32_t corner) {
        if (free_ == kNone) {
            free_ = static_cast<std::uint32_t>(entries_.size());
            entries_.push_back({kNone, kNone});
        }
        const std::uint32_t entry = std::exchange(free_, entries_[free_].next);
        entries_[entry] = {corner, std::exchange(first_[edge], entry)};
    }

    /// Removes the corners of an edge, and calls `take` with each.
    template <class Take>
    void release(std::uint32_t edge, Take&& take) {
        for (std::uint32_t i = std::exchange(first_[edge], kNone); i != kNone;) {
            take(entries_[i].corner);
            const std::uint32_t next = std::exchange(entries_[i].next, free_);
            free_ = std::exchange(i, next);
        }
    }

private:
    struct Entry {
        std::uint32_t corner;
        std::uint32_t next;
    };

    std::vector<std::uint32_t> first_;  ///< the first entry of each edge
    std::vector<Entry> entries_;
    std::uint32_t free_ = kNone;  ///< the first unused entry
};

/// Clips ears off a weakly simple polygon that runs counter-clockwise.
///
/// An ear is a left turn whose triangle no other edge enters. Ears whose cut passes through a
/// third corner come last: clipping them may leave collinear corners. Spikes (paths that turn
/// back on themselves) and repeated positions come first, as triangles without area: an ear
/// beside a spike might lie outside.
///
/// A corner that is no ear is not tested again before a change could make it one. Else outlines
/// whose ears appear against the order of corners would take quadratic time.
class EarClipper {
public:
    EarClipper(std::span<const Double2> flat, std::vector<Corners>& triangles,
               std::uint64_t max_steps)
        : max_steps_(max_steps),
          flat_(flat),
          triangles_(triangles),
          next_(flat.size()),
          previous_(flat.size()),
          edges_(flat),
          spikes_(flat.size()),
          clear_(Cut::clear, flat.size()),
          any_(Cut::any, flat.size()) {
        const auto n = static_cast<std::uint32_t>(flat.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
        left_ = n;
        for (std::uint32_t i = 0; i < n; ++i) {
            clear_.candidates.insert(i);
            any_.candidates.insert(i);
            if (is_spike(i)) spikes_.insert(i);
        }
    }

    PolygonCut run() {
        while (left_ > 3) {
            if (clip_spike()) continue;
            if (clip_ear(clear_) || clip_ear(any_)) continue;
            force_rest();
            return steps_ > max_steps_ ? PolygonCut::unfinished : PolygonCut::forced;
        }
        triangles_.push_back({previous_[at_], at_, next_[at_]});
        return turn(at_) < 0 ? PolygonCut::forced : PolygonCut::ears;
    }

private:
    enum class Cut : std::uint8_t { clear, any };

    /// The search for ears with a kind of cut.
    struct Search {
        Search(Cut kind, std::size_t corners) : cut(kind), candidates(corners), blocked(corners) {}

        Cut cut;
        CornerSet candidates;  ///< all other corners are no ears
        BlockedCorners blocked;
    };

    /// Clips the first spike, starting after the last clipped corner.
    bool clip_spike() {
        const auto found = spikes_.first_from(at_);
        if (found) clip(*found);
        return found.has_value();
    }

    /// Clips the first ear, starting after the last clipped corner.
    bool clip_ear(Search& search) {
        while (const auto corner = search.candidates.first_from(at_)) {
            if (steps_ > max_steps_) return false;
            if (is_ear(*corner, search)) {
                clip(*corner);
                return true;
            }
            search.candidates.erase(*corner);
        }
        return false;
    }

    void clip(std::uint32_t corner) {
        const std::uint32_t before = previous_[corner];
        const std::uint32_t after = next_[corner];
        triangles_.push_back({before, corner, after});
        next_[before] = after;
        previous_[after] = before;
        next_[corner] = corner;
        at_ = after;
        --left_;
        edges_.set(corner, kNothing);
        edges_.set(before, box_of(flat_[before], flat_[after]));
        update(clear_, before, corner, after);
        update(any_, before, corner, after);
        // A spike depends on its two neighbours only.
        spikes_.erase(corner);
        for (const std::uint32_t i : {before, after}) {
            if (is_spike(i)) {
                spikes_.insert(i);
            } else {
                spikes_.erase(i);
            }
        }
    }

    /// Adds the corners that may be ears now that `corner` is clipped. Its two edges are gone.
    void update(Search& search, std::uint32_t before, std::uint32_t corner, std::uint32_t after) {
        for (const std::uint32_t edge : {before, corner}) {
            search.blocked.release(edge, [&](std::uint32_t i) {
                if (!is_clipped(i)) search.candidates.insert(i);
            });
        }
        search.candidates.erase(corner);
        search.candidates.insert(before);
        search.candidates.insert(after);
    }

    [[nodiscard]] bool is_clipped(std::uint32_t i) const {
        return next_[i] == i;
    }

    [[nodiscard]] int turn(std::uint32_t i) const {
        return exact::orient2d(flat_[previous_[i]], flat_[i], flat_[next_[i]]);
    }

    bool is_spike(std::uint32_t i) {
        ++steps_;
        const Double2& before = flat_[previous_[i]];
        const Double2& after = flat_[next_[i]];
        if (equal(before, flat_[i]) || equal(after, flat_[i])) return true;
        return turn(i) == 0 && !is_between(before, flat_[i], after);
    }

    bool is_ear(std::uint32_t i, Search& search) {
        ++steps_;
        if (turn(i) <= 0) return false;
        const Ear ear{flat_[previous_[i]], flat_[i], flat_[next_[i]]};
        const FlatBox first = box_of(ear.a, ear.b);
        const FlatBox box{{std::min(first.lower.x, ear.c.x), std::min(first.lower.y, ear.c.y)},
                          {std::max(first.upper.x, ear.c.x), std::max(first.upper.y, ear.c.y)}};
        const auto may = [&](const FlatBox& of_edges) { return may_matter(ear, box, of_edges); };
        return !edges_.any(steps_, may, [&](std::uint32_t edge) {
            if (!prevents(ear, edge, search.cut)) return false;
            search.blocked.add(edge, i);
            return true;
        });
    }

    [[nodiscard]] bool prevents(const Ear& ear, std::uint32_t edge, Cut cut) const {
        const Double2& from = flat_[edge];
        if (enters(ear, from, flat_[next_[edge]])) return true;
        return cut == Cut::clear && is_between(ear.a, from, ear.c) &&
               exact::orient2d(ear.a, from, ear.c) == 0;
    }

    void force_rest() {
        for (std::uint32_t i = next_[at_]; next_[i] != at_; i = next_[i]) {
            triangles_.push_back({at_, i, next_[i]});
        }
    }

    std::uint64_t max_steps_;
    std::span<const Double2> flat_;
    std::vector<Corners>& triangles_;
    std::vector<std::uint32_t> next_, previous_;  ///< the next of a clipped corner is itself
    EdgeTree edges_;
    CornerSet spikes_;
    Search clear_, any_;
    std::uint32_t at_ = 0;
    std::uint32_t left_ = 0;
    std::uint64_t steps_ = 0;
};

}  // namespace

PolygonCut triangulate_polygon(std::span<const Double3> outline, std::vector<Corners>& triangles,
                               std::uint64_t max_steps) {
    if (outline.size() < 3) return PolygonCut::convex;
    const std::vector<Double2> flat = project(outline);
    const bool is_convex = outline.size() == 3 || is_strictly_convex(flat);
    if (is_convex || outline.size() > max_steps / kLeastSteps) {
        for (std::uint32_t i = 1; i + 1 < outline.size(); ++i) triangles.push_back({0, i, i + 1});
        return is_convex ? PolygonCut::convex : PolygonCut::unfinished;
    }
    return EarClipper(flat, triangles, max_steps).run();
}

}  // namespace cdprep::mesh
