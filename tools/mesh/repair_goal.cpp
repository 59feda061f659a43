// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/repair_goal.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "mesh/copies.h"
#include "mesh/edge_flaws.h"
#include "mesh/sound_mesh.h"
#include "mesh/stars.h"

namespace cdprep::mesh {
namespace {

/// "3 edges have more than two triangles", each that is above 0, with commas.
class Flaws {
public:
    void add(std::uint64_t count, const char* one, const char* several) {
        if (count == 0) return;
        if (!text_.empty()) text_ += ", ";
        text_ += std::to_string(count) + " " + (count == 1 ? one : several);
    }
    [[nodiscard]] const std::string& text() const {
        return text_;
    }

private:
    std::string text_;
};

}  // namespace

SelfCrossing find_self_crossing(const TriangleSoup& soup, const SearchOptions& options) {
    FindingList findings(0);
    DefectCounts counts;
    const SoundMesh sound = find_sound_mesh(soup, findings, counts);
    const Copies copies(find_edge_flaws(collect_stars(sound.mesh)).repeated);
    SelfCrossing crossing;
    constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
    std::pair<std::uint32_t, std::uint32_t> lowest{kMost, kMost};
    crossing.is_complete = search_distinct_meetings(
        sound.mesh, copies, options, [&](std::span<const TriangleMeeting> some) {
            for (const TriangleMeeting& pair : some) {
                crossing.pairs += copies.of(pair.a).size() * copies.of(pair.b).size();
                lowest = std::min(lowest, {pair.a, pair.b});
            }
        });
    copies.for_each([&](const CopyList& list) {
        crossing.pairs += list.size() * (list.size() - 1) / 2;
        lowest = std::min(lowest, {list[0], list[1]});
    });
    if (crossing.pairs > 0) {
        crossing.first = sound.source_triangle[lowest.first];
        crossing.second = sound.source_triangle[lowest.second];
    }
    return crossing;
}

std::string missed_goal(std::string_view preset, const StoredVerdict& after,
                        const std::optional<SelfCrossing>& crossing) {
    const std::string missed = "not " + std::string(preset) + ": ";
    if (after.verdict.triangle_count == 0) return missed + "there are no triangles";
    Flaws flaws;
    flaws.add(after.non_manifold_edges, "edge has more than two triangles",
              "edges have more than two triangles");
    flaws.add(after.non_manifold_vertices, "vertex has several fans", "vertices have several fans");
    flaws.add(after.duplicate_triangles, "triangle is a copy", "triangles are copies");
    flaws.add(after.repeated_corners, "triangle repeats a corner", "triangles repeat a corner");
    flaws.add(after.inconsistent_edges, "edge has triangles wound differently",
              "edges have triangles wound differently");
    if (preset != "safe") {
        flaws.add(after.boundary_edges, "edge is still open", "edges are still open");
    }
    if (preset == "solid" && crossing) {
        flaws.add(crossing->pairs, "pair of triangles still crosses or touches",
                  "pairs of triangles still cross or touch");
    }
    if (flaws.text().empty()) return "";
    std::string sentence = missed + flaws.text();
    if (preset == "solid" && crossing && crossing->pairs > 0) {
        sentence += "; first " + std::to_string(crossing->first) + " and " +
                    std::to_string(crossing->second);
    }
    return sentence;
}

}  // namespace cdprep::mesh
