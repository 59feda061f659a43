// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/meetings.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "mesh/common_point.h"
#include "triangle_contact.h"

namespace cdprep::mesh {
namespace {

int shared_vertices(const Mesh& mesh, const TriangleMeeting& meeting) {
    const auto& a = mesh.triangles[meeting.a].vertex;
    const auto& b = mesh.triangles[meeting.b].vertex;
    return static_cast<int>(std::count_if(a.begin(), a.end(), [&b](std::uint32_t vertex) {
        return std::find(b.begin(), b.end(), vertex) != b.end();
    }));
}

Corners corners_of(const Mesh& mesh, std::uint32_t triangle) {
    const auto& v = mesh.triangles[triangle].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

Place place_of(const SoundMesh& sound, const TriangleMeeting& meeting, double measure) {
    return {{sound.source_triangle[meeting.a], sound.source_triangle[meeting.b]},
            {},
            common_point(corners_of(sound.mesh, meeting.a), corners_of(sound.mesh, meeting.b)),
            measure};
}

/// What is found of a rule about pairs.
struct PairsOfRule {
    Rule rule;
    std::uint64_t pairs = 0;
    std::vector<TriangleMeeting> first;  ///< distinct ones, as many as places are kept
};

class MeetingLister {
public:
    MeetingLister(const Copies& copies, const SoundMesh& sound, const ComponentNumbers& components,
                  FindingList& findings, DefectCounts& counts)
        : copies_(copies),
          sound_(sound),
          components_(components),
          findings_(findings),
          counts_(counts) {
        result_.self_crossing.resize(components.count);
    }

    /// Meetings of distinct triangles, by (a, b).
    void add(const TriangleMeeting& meeting) {
        const std::uint64_t pairs = copies_.of(meeting.a).size() * copies_.of(meeting.b).size();
        counts_.self_intersecting_pairs += pairs;
        result_.any = true;
        count(meeting, pairs);
        const std::uint32_t a = component_of(meeting.a);
        const std::uint32_t b = component_of(meeting.b);
        if (a == b) result_.self_crossing[a] = true;
        const bool overlap = meeting.meeting == Meeting::crossing ||
                             meeting.meeting == Meeting::edge_crossing ||
                             meeting.meeting == Meeting::coplanar_overlap;
        if (a == b || !overlap) return;
        const auto [lower, upper] = std::minmax(a, b);
        pairs_
            .try_emplace({lower, upper},
                         ComponentMeetings::Pair{lower, upper, meeting.a, meeting.b, 0})
            .first->second.meetings += pairs;
    }

    /// A triangle with its copies: CDP0204 and 0205 tell of them.
    void add_copies(const CopyList& list) {
        if (is_degenerate(corners_of(sound_.mesh, list[0]))) return;
        counts_.self_intersecting_pairs += list.size() * (list.size() - 1) / 2;
        result_.any = true;
        result_.self_crossing[component_of(list[0])] = true;
    }

    ComponentMeetings finish() {
        counts_.crossing_pairs = crossing_.pairs;
        counts_.touching_pairs = touching_.pairs;
        counts_.coplanar_overlap_pairs = flat_.pairs;
        for (const PairsOfRule* found : {&crossing_, &touching_, &flat_}) list(*found);
        list_overlapping();
        return std::move(result_);
    }

private:
    [[nodiscard]] std::uint32_t component_of(std::uint32_t triangle) const {
        return components_.of_vertex[sound_.mesh.triangles[triangle].vertex[0]];
    }

    void count(const TriangleMeeting& meeting, std::uint64_t pairs) {
        PairsOfRule* const rule = rule_of(meeting.meeting);
        if (rule == nullptr) return;
        rule->pairs += pairs;
        if (rule->first.size() < findings_.max_places()) rule->first.push_back(meeting);
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

    void list(const PairsOfRule& found) {
        const std::vector<TriangleMeeting> pairs =
            first_pairs(found.first, copies_, findings_.max_places());
        for (const TriangleMeeting& pair : pairs) {
            const bool flat = found.rule == Rule::coplanar_overlap;
            const double measure = flat ? shared_vertices(sound_.mesh, pair) : 0;
            findings_.add(found.rule, [&] { return place_of(sound_, pair, measure); });
        }
        findings_.count_more(found.rule, found.pairs - pairs.size());
    }

    void list_overlapping() {
        for (const auto& [key, pair] : pairs_) result_.overlapping.push_back(pair);
        counts_.overlapping_components = result_.overlapping.size();
        std::vector<ComponentMeetings::Pair> by_triangle = result_.overlapping;
        findings_.add_sorted(
            Rule::overlapping_components, by_triangle,
            [](const auto& x, const auto& y) {
                return std::tie(x.first_triangle, x.second_triangle) <
                       std::tie(y.first_triangle, y.second_triangle);
            },
            [this](const ComponentMeetings::Pair& pair) {
                return place_of(sound_,
                                {pair.first_triangle, pair.second_triangle, Meeting::crossing},
                                static_cast<double>(pair.meetings));
            });
    }

    const Copies& copies_;
    const SoundMesh& sound_;
    const ComponentNumbers& components_;
    FindingList& findings_;
    DefectCounts& counts_;
    PairsOfRule crossing_{Rule::crossing_triangles, 0, {}};
    PairsOfRule touching_{Rule::touching_triangles, 0, {}};
    PairsOfRule flat_{Rule::coplanar_overlap, 0, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, ComponentMeetings::Pair> pairs_;
    ComponentMeetings result_;
};

}  // namespace

bool ComponentMeetings::overlap(std::uint32_t a, std::uint32_t b) const {
    const auto key = std::minmax(a, b);
    return std::binary_search(
        overlapping.begin(), overlapping.end(), Pair{key.first, key.second, 0, 0, 0},
        [](const Pair& x, const Pair& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
}

ComponentMeetings list_meetings(std::span<const TriangleMeeting> distinct, const Copies& copies,
                                const SoundMesh& sound, const ComponentNumbers& components,
                                FindingList& findings, DefectCounts& counts) {
    MeetingLister lister(copies, sound, components, findings, counts);
    for (const TriangleMeeting& meeting : distinct) lister.add(meeting);
    copies.for_each([&lister](const CopyList& list) { lister.add_copies(list); });
    return lister.finish();
}

}  // namespace cdprep::mesh
