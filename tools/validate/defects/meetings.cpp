// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/meetings.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "cdprep/exact/triangles.h"
#include "crossings/triangle_meeting.h"
#include "validate/defects/common_point.h"

namespace cdprep::mesh {
namespace {

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
