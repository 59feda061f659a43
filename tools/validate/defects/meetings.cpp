// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/meetings.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "cdprep/exact/triangles.h"
#include "crossings/triangle_meeting.h"
#include "mesh/vectors.h"

namespace cdprep::mesh {
namespace {

Double3 between(const Double3& a, const Double3& b, double share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

/// Returns where a segment meets the plane through `on`, from the heights of its ends above it.
Double3 meets_plane(const Double3& from, const Double3& to, const Double3& on,
                    const Double3& normal) {
    const double above_from = dot(minus(from, on), normal);
    const double above_to = dot(minus(to, on), normal);
    const double share = above_from / (above_from - above_to);
    return between(from, to, std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.5);
}

Double3 end_of(const PiercingEdge& edge, const Corners& a, const Corners& b) {
    const Corners& plane = edge.of_a ? b : a;
    return meets_plane(edge.from, edge.to, plane[0],
                       cross(minus(plane[1], plane[0]), minus(plane[2], plane[0])));
}

/// Returns the mean of the corners of `a` clipped by the sides of `b` (Sutherland and Hodgman
/// 1974).
Double3 middle_of_overlap(const Corners& a, const Corners& b) {
    std::vector<Double3> polygon(a.begin(), a.end());
    const Double3 normal = cross(minus(b[1], b[0]), minus(b[2], b[0]));
    for (std::size_t side = 0; side < b.size(); ++side) {
        const Double3 inwards = cross(normal, minus(b[(side + 1) % 3], b[side]));
        const auto above = [&](const Double3& p) { return dot(minus(p, b[side]), inwards); };
        std::vector<Double3> cut;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Double3& p = polygon[i];
            const Double3& q = polygon[(i + 1) % polygon.size()];
            if (above(p) >= 0) cut.push_back(p);
            if ((above(p) > 0 && above(q) < 0) || (above(p) < 0 && above(q) > 0)) {
                cut.push_back(meets_plane(p, q, b[side], inwards));
            }
        }
        polygon = std::move(cut);
    }
    Double3 sum{};
    for (const Double3& p : polygon) sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
    const auto count = static_cast<double>(polygon.size());
    return {sum.x / count, sum.y / count, sum.z / count};
}

/// Returns x clamped to both ranges; the middle between the ranges if they are disjoint.
double in_both(double x, double a0, double a1, double a2, double b0, double b1, double b2) {
    const double lower = std::max(std::min({a0, a1, a2}), std::min({b0, b1, b2}));
    const double upper = std::min(std::max({a0, a1, a2}), std::max({b0, b1, b2}));
    if (!std::isfinite(x) || lower > upper) return lower / 2 + upper / 2;
    return std::clamp(x, lower, upper);
}

/// Returns a common point of two triangles that meet, rounded. The point is the middle of their
/// common segment, or of their common area if they are coplanar. It always lies in the boxes of
/// both. It is meant for pictures.
Double3 common_point(const Corners& a, const Corners& b) {
    Double3 point{};
    if (const auto ends = exact::crossing_ends(a, b)) {
        point = between(end_of(ends->first, a, b), end_of(ends->second, a, b), 0.5);
    } else {
        point = middle_of_overlap(a, b);
    }
    return {in_both(point.x, a[0].x, a[1].x, a[2].x, b[0].x, b[1].x, b[2].x),
            in_both(point.y, a[0].y, a[1].y, a[2].y, b[0].y, b[1].y, b[2].y),
            in_both(point.z, a[0].z, a[1].z, a[2].z, b[0].z, b[1].z, b[2].z)};
}

int shared_vertices(const Mesh& mesh, const TriangleMeeting& meeting) {
    const auto& a = mesh.triangles[meeting.a].vertex;
    const auto& b = mesh.triangles[meeting.b].vertex;
    return static_cast<int>(std::count_if(a.begin(), a.end(), [&b](std::uint32_t vertex) {
        return std::find(b.begin(), b.end(), vertex) != b.end();
    }));
}

Place place_of(const SoundMesh& sound, const TriangleMeeting& meeting, double measure) {
    return {{sound.source_triangle[meeting.a], sound.source_triangle[meeting.b]},
            {},
            common_point(corners_of(sound.mesh, meeting.a), corners_of(sound.mesh, meeting.b)),
            measure};
}

/// The lowest meetings by (a, b) among those added in any order.
class LowestMeetings {
public:
    explicit LowestMeetings(std::size_t most) : most_(most) {}

    void add(const TriangleMeeting& meeting) {
        if (is_full_ && !comes_before(meeting, bound_)) return;
        kept_.push_back(meeting);
        if (kept_.size() >= 2 * most_ + kRoom) shrink();
    }

    /// Returns the lowest meetings, sorted.
    [[nodiscard]] std::vector<TriangleMeeting> take() {
        std::sort(kept_.begin(), kept_.end(), comes_before);
        kept_.resize(std::min(kept_.size(), most_));
        return std::move(kept_);
    }

private:
    static constexpr std::size_t kRoom = 1024;  ///< shrinking to few places is not worth the time

    static bool comes_before(const TriangleMeeting& x, const TriangleMeeting& y) {
        return std::tie(x.a, x.b) < std::tie(y.a, y.b);
    }

    /// Keeps the lowest meetings and sets the bound; later meetings must lie below it.
    void shrink() {
        const auto end = kept_.begin() + static_cast<std::ptrdiff_t>(most_);
        std::nth_element(kept_.begin(), end, kept_.end(), comes_before);
        bound_ = *end;
        is_full_ = true;
        kept_.resize(most_);
    }

    std::size_t most_;
    bool is_full_ = false;
    TriangleMeeting bound_{};
    std::vector<TriangleMeeting> kept_;
};

/// The result of one rule about pairs.
struct PairsOfRule {
    PairsOfRule(Rule of, std::size_t most) : rule(of), first(most) {}
    Rule rule;
    std::uint64_t pairs = 0;
    LowestMeetings first;  ///< distinct meetings, up to the number of places
};

/// At least this many pairs of components are distinguished: some 75 MB.
constexpr std::size_t kComponentPairs = std::size_t{3} << 20;
constexpr std::size_t kComponentPairsPerTriangle = 4;

class MeetingLister {
public:
    MeetingLister(const MeetingGrounds& grounds, FindingList& findings, DefectCounts& counts)
        : copies_(grounds.copies),
          sound_(grounds.sound),
          components_(grounds.components),
          nested_(grounds.nested),
          findings_(findings),
          counts_(counts),
          crossing_(Rule::crossing_triangles, findings.max_places()),
          touching_(Rule::touching_triangles, findings.max_places()),
          flat_(Rule::coplanar_overlap, findings.max_places()),
          pairs_(std::max(
              findings.max_places(),
              kComponentPairs + kComponentPairsPerTriangle * grounds.sound.mesh.triangles.size())) {
        result_.self_crossing.resize(components_.count);
        result_.overlapping.resize(nested_.size());
    }

    /// Adds a meeting of distinct triangles.
    void add(const TriangleMeeting& meeting) {
        const std::uint64_t pairs = copies_.of(meeting.a).size() * copies_.of(meeting.b).size();
        counts_.self_intersecting_pairs += pairs;
        result_.any = true;
        count(meeting, pairs);
        const auto [a, b] = std::minmax({component_of(meeting.a), component_of(meeting.b)});
        if (a == b) result_.self_crossing[a] = true;
        const bool overlap = meeting.meeting == Meeting::crossing ||
                             meeting.meeting == Meeting::edge_crossing ||
                             meeting.meeting == Meeting::coplanar_overlap;
        if (a == b || !overlap) return;
        mark_nested(a, b);
        mark_nested(b, a);
        pairs_.add({a, b, meeting.a, meeting.b, pairs});
    }

    /// Counts the pairs of copies of a triangle. CDP0204 and CDP0205 report the copies.
    void add_copies(const CopyList& list) {
        if (exact::is_degenerate(corners_of(sound_.mesh, list[0]))) return;
        counts_.self_intersecting_pairs += list.size() * (list.size() - 1) / 2;
        result_.any = true;
        result_.self_crossing[component_of(list[0])] = true;
    }

    ComponentMeetings finish(bool is_complete) {
        result_.is_complete = is_complete;
        counts_.crossing_pairs = crossing_.pairs;
        counts_.touching_pairs = touching_.pairs;
        counts_.coplanar_overlap_pairs = flat_.pairs;
        for (PairsOfRule* found : {&crossing_, &touching_, &flat_}) list(*found);
        list_overlapping();
        return std::move(result_);
    }

private:
    [[nodiscard]] std::uint32_t component_of(std::uint32_t triangle) const {
        return components_.of_vertex[sound_.mesh.triangles[triangle].vertex[0]];
    }

    void mark_nested(std::uint32_t inner, std::uint32_t outer) {
        if (nested_.empty()) return;
        const auto at = std::lower_bound(nested_.begin(), nested_.end(), std::pair(inner, outer),
                                         [](const Nested& pair, const auto& wanted) {
                                             return std::pair(pair.inner, pair.outer) < wanted;
                                         });
        if (at == nested_.end() || at->inner != inner || at->outer != outer) return;
        result_.overlapping[static_cast<std::size_t>(at - nested_.begin())] = true;
    }

    void count(const TriangleMeeting& meeting, std::uint64_t pairs) {
        PairsOfRule* const rule = rule_of(meeting.meeting);
        if (rule == nullptr) return;
        rule->pairs += pairs;
        rule->first.add(meeting);
    }

    PairsOfRule* rule_of(Meeting meeting) {
        switch (meeting) {
            case Meeting::crossing:
            case Meeting::corner_crossing:
                return &crossing_;
            case Meeting::touching:
            case Meeting::edge_crossing:
                return &touching_;
            case Meeting::coplanar_overlap:
            case Meeting::fold:
                return &flat_;
            case Meeting::flat_touching:
            case Meeting::edge_overlap:
            case Meeting::duplicate:
                break;
        }
        return nullptr;
    }

    void list(PairsOfRule& found) {
        const std::vector<TriangleMeeting> pairs =
            first_pairs(found.first.take(), copies_, findings_.max_places());
        for (const TriangleMeeting& pair : pairs) {
            const bool flat = found.rule == Rule::coplanar_overlap;
            const double measure = flat ? shared_vertices(sound_.mesh, pair) : 0;
            findings_.add(found.rule, [&] { return place_of(sound_, pair, measure); });
        }
        findings_.count_more(found.rule, found.pairs - pairs.size());
        if (!result_.is_complete) findings_.mark_lower_bound(found.rule);
    }

    void list_overlapping() {
        std::vector<ComponentPair> overlapping = pairs_.take();
        counts_.overlapping_components = overlapping.size();
        findings_.add_sorted(
            Rule::overlapping_components, overlapping,
            [](const auto& x, const auto& y) {
                return std::tie(x.first_triangle, x.second_triangle) <
                       std::tie(y.first_triangle, y.second_triangle);
            },
            [this](const ComponentPair& pair) {
                return place_of(sound_,
                                {pair.first_triangle, pair.second_triangle, Meeting::crossing},
                                static_cast<double>(pair.meetings));
            });
        if (result_.is_complete && pairs_.is_complete()) return;
        findings_.mark_lower_bound(Rule::overlapping_components);
    }

    const Copies& copies_;
    const SoundMesh& sound_;
    const ComponentNumbers& components_;
    const std::vector<Nested>& nested_;
    FindingList& findings_;
    DefectCounts& counts_;
    PairsOfRule crossing_;
    PairsOfRule touching_;
    PairsOfRule flat_;
    ComponentPairs pairs_;
    ComponentMeetings result_;
};

}  // namespace

ComponentMeetings list_meetings(const MeetingGrounds& grounds, const SearchOptions& options,
                                FindingList& findings, DefectCounts& counts) {
    MeetingLister lister(grounds, findings, counts);
    const bool is_complete = search_distinct_meetings(
        grounds.sound.mesh, grounds.copies, options, [&](std::span<const TriangleMeeting> some) {
            for (const TriangleMeeting& meeting : some) lister.add(meeting);
        });
    grounds.copies.for_each([&lister](const CopyList& list) { lister.add_copies(list); });
    return lister.finish(is_complete);
}

}  // namespace cdprep::mesh
