// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/meetings.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "mesh/common_point.h"

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
    const auto corners = [&sound](std::uint32_t triangle) {
        const auto& v = sound.mesh.triangles[triangle].vertex;
        const std::vector<Double3>& p = sound.mesh.positions;
        return Corners{p[v[0]], p[v[1]], p[v[2]]};
    };
    return {{sound.source_triangle[meeting.a], sound.source_triangle[meeting.b]},
            {},
            common_point(corners(meeting.a), corners(meeting.b)),
            measure};
}

class MeetingLister {
public:
    MeetingLister(const SoundMesh& sound, const ComponentNumbers& components, FindingList& findings,
                  DefectCounts& counts)
        : sound_(sound), components_(components), findings_(findings), counts_(counts) {
        result_.self_crossing.resize(components.count);
    }

    void add(const TriangleMeeting& meeting) {
        ++counts_.self_intersecting_pairs;
        result_.any = true;
        list(meeting);
        const std::uint32_t a = component_of(meeting.a);
        const std::uint32_t b = component_of(meeting.b);
        if (a == b) result_.self_crossing[a] = true;
        const bool overlap = meeting.meeting == Meeting::crossing ||
                             meeting.meeting == Meeting::edge_crossing ||
                             meeting.meeting == Meeting::coplanar_overlap;
        if (a == b || !overlap) return;
        const auto [lower, upper] = std::minmax(a, b);
        ++pairs_
              .try_emplace({lower, upper},
                           ComponentMeetings::Pair{lower, upper, meeting.a, meeting.b, 0})
              .first->second.meetings;
    }

    ComponentMeetings finish() {
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
        return std::move(result_);
    }

private:
    [[nodiscard]] std::uint32_t component_of(std::uint32_t triangle) const {
        return components_.of_vertex[sound_.mesh.triangles[triangle].vertex[0]];
    }

    void list(const TriangleMeeting& meeting) {
        switch (meeting.meeting) {
            case Meeting::crossing:
            case Meeting::corner_crossing:
                ++counts_.crossing_pairs;
                return add_place(Rule::crossing_triangles, meeting, 0);
            case Meeting::touching:
            case Meeting::edge_crossing:
                ++counts_.touching_pairs;
                return add_place(Rule::touching_triangles, meeting, 0);
            case Meeting::coplanar_overlap:
            case Meeting::fold:
                ++counts_.coplanar_overlap_pairs;
                return add_place(Rule::coplanar_overlap, meeting,
                                 shared_vertices(sound_.mesh, meeting));
            case Meeting::flat_touching:
            case Meeting::edge_overlap:
            case Meeting::duplicate:  // CDP0204 and 0205 tell of them
                return;
        }
    }

    void add_place(Rule rule, const TriangleMeeting& meeting, double measure) {
        findings_.add(rule, [&] { return place_of(sound_, meeting, measure); });
    }

    const SoundMesh& sound_;
    const ComponentNumbers& components_;
    FindingList& findings_;
    DefectCounts& counts_;
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

ComponentMeetings list_meetings(std::span<const TriangleMeeting> meetings, const SoundMesh& sound,
                                const ComponentNumbers& components, FindingList& findings,
                                DefectCounts& counts) {
    MeetingLister lister(sound, components, findings, counts);
    for (const TriangleMeeting& meeting : meetings) lister.add(meeting);
    return lister.finish();
}

}  // namespace cdprep::mesh
